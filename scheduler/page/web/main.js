// The views of the page, chosen by what follows # in its address.

const VIEWS = { overview: ['Overview', overviewView], frames: ['Frames', framesView], variables: ['Variables', variablesView], run: ['Run', runView] };
let view = '';
let kept = { y: 0 }; // where the grid was left

function header() {
  const complete = summary.frames > 0 && summary.done === summary.frames;
  const state = summary.active ? 'running' : complete ? 'complete' : summary.done === 0 ? 'no frames yet' : 'incomplete';
  const links = Object.entries(VIEWS).map(([key, [title]]) => el('a', { href: `#${key}`, 'data-view': key }, title));
  const themes = el('button', { type: 'button', class: 'quiet', onclick: toggleTheme, 'aria-label': 'Light or dark' }, el('span', { 'aria-hidden': 'true' }, '◐'));
  document.getElementById('top').replaceChildren(
    el('div', { class: 'bar' }, el('h1', {}, named(campaign.name || campaign.folder), data.live ? null : el('span', { class: `tag ${complete ? 'good' : summary.failed + summary.quarantined > 0 ? 'bad' : ''}` }, state)), el('nav', { 'aria-label': 'Views' }, links), themes),
    el('div', { id: 'live', hidden: true }),
    el('div', { id: 'chips', hidden: true, role: 'group', 'aria-label': 'Filters that are set' }));
}

function show() {
  const [name, argument] = location.hash.slice(1).split('/');
  const key = name === 'frame' ? 'frame' : VIEWS[name] ? name : 'overview';
  if (view === 'frames') kept.y = scrollY;
  const before = view;
  view = key;
  for (const link of document.querySelectorAll('nav a')) {
    const here = link.dataset.view === key || (key === 'frame' && link.dataset.view === 'frames');
    if (here) link.setAttribute('aria-current', 'page'); else link.removeAttribute('aria-current');
  }
  render(argument);
  const title = key === 'frame' ? `Frame ${argument}` : VIEWS[key][0];
  document.title = `${title} · ${campaign.name || campaign.folder}`;
  if (before !== '' && before !== key) document.getElementById('content').focus({ preventScroll: true });
  if (before !== '' && before !== key && key !== 'frames') scrollTo(0, 0);
  if (key === 'frames' && before === 'frame') requestAnimationFrame(() => { scrollTo(0, kept.y); requestAnimationFrame(showTiles); });
}

function render(argument = location.hash.split('/')[1]) {
  const content = view === 'frame' ? frameView(Number(argument)) : VIEWS[view][1]();
  document.getElementById('content').replaceChildren(...content.filter(Boolean));
  document.getElementById('content').dataset.view = view;
  dropDetachedCharts();
}

function keys(event) {
  if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(event.target.tagName)) return;
  const overlay = { b: 'boxes', m: 'masks', n: 'names' }[event.key];
  if (overlay) { setOverlay({ [overlay]: !overlays[overlay] }); return; }
  const at = Object.keys(VIEWS)[Number(event.key) - 1];
  if (at) { location.hash = `#${at}`; return; }
  if (view === 'frame') frameKeys(event);
}

function repaintPictures() {
  for (const element of document.querySelectorAll('.tile, canvas.large')) element.repaint?.();
  for (const control of document.querySelectorAll('.controls[aria-label=Overlays]')) {
    if (!control.contains(document.activeElement)) control.replaceWith(overlayControls());
    else for (const [i, key] of ['boxes', 'masks', 'names'].entries()) control.children[i].setAttribute('aria-pressed', String(overlays[key]));
  }
}

async function start() {
  await Promise.all([unpackColumns(data.frames, frames), unpackColumns(data.objects, objects)]);
  if (!campaign.has_pictures) overlays.boxes = false;
  applyTheme();
  header();
  await applyFilter();
  overlayListeners.add(repaintPictures);
  themeListeners.add(() => render());
  selectionListeners.add(() => { chipsBar(); if (view === 'frames') renewGrid(); else render(); });
  addEventListener('hashchange', show);
  addEventListener('keydown', keys);
  show();
  document.documentElement.dataset.ready = 'true';
  startLive();
}

start().catch((error) => {
  document.getElementById('content').replaceChildren(emptyState('This page cannot show its data', String(error?.message ?? error)));
  throw error;
});
