// What a page of `seedframe serve` shows on top: how far the campaign is now, and what can be done about it.

const live = { state: null, timer: 0, failed: 0, said: '' };
const FAST_MS = 2000;
const SLOW_MS = 15000;

const megabytes = (bytes) => (bytes > 0 ? `${count(Math.round(bytes / 1e6))} MB` : '–');

async function command(what) {
  live.said = '';
  try {
    const answer = await fetch(what, { method: 'POST', headers: { 'X-Seedframe': '1' } });
    const told = await answer.json();
    live.said = answer.ok ? { pause: 'Finishes the frames under way, then stops.', resume: 'Starting.' }[what] ?? 'Starting.' : told.error;
  } catch {
    live.said = 'The server does not answer.';
  }
  poll();
}

function stateText(state) {
  if (live.failed > 0) return ['The server does not answer: this is how it was', 'bad'];
  if (state.at_work) return ['At work', 'good'];
  if (state.starting) return ['Starting', ''];
  if (state.died) return [`The scheduler died with ${plural(state.running, 'frame')} under way; resume takes them up`, 'bad'];
  if (state.done === state.frames) return ['Complete', 'good'];
  if (state.failed + state.quarantined > 0 && state.pending === 0) return [`Ended with ${plural(state.failed + state.quarantined, 'failure')}`, 'bad'];
  return ['Paused', ''];
}

function workersTable(state) {
  if (state.workers.length === 0) return null;
  const shown = state.workers.slice(0, 32);
  return table([{ title: 'Worker', numeric: true }, { title: 'Frame', numeric: true }, { title: 'Since', numeric: true }, { title: 'Memory', numeric: true }],
    shown.map((each) => [String(each.worker), String(each.frame), duration(each.seconds), megabytes(each.memory_bytes)]), { label: 'Workers' });
}

function newestStrip(state) {
  if (state.newest.length === 0) return null;
  return el('div', { class: 'newest' }, state.newest.slice(0, 8).map((frame) => {
    const image = el('img', { src: `thumbnail/${frame}`, alt: `Frame ${frame}`, width: '128', height: String(Math.round((128 * campaign.height) / campaign.width)) });
    return placeOf(frame) >= 0 && frames.state[placeOf(frame)] === DONE ? el('a', { href: `#frame/${frame}` }, image) : image;
  }));
}

function liveButtons(state) {
  const button = (text, what) => el('button', { type: 'button', onclick: () => command(what) }, text);
  const idle = !state.at_work && !state.starting;
  const unfinished = state.pending + state.running;
  return el('span', { class: 'controls' }, state.at_work ? button('Pause', 'pause') : null, idle && unfinished > 0 ? button('Resume', 'resume') : null,
    idle && unfinished === 0 && state.failed > 0 ? button('Retry failed frames', 'resume') : null);
}

function newFrames(state) {
  const more = state.done - summary.done;
  if (more === 0) return null;
  return el('button', { type: 'button', class: 'chip', onclick: () => location.reload() }, more > 0 ? `${plural(more, 'frame')} more than on this page: show` : 'This page is older than the campaign: show it anew');
}

function showLive() {
  const { state } = live;
  const place = document.getElementById('live');
  if (!state || !place) return;
  const [text, kind] = stateText(state);
  const facts = [`${count(state.done)} of ${plural(state.frames, 'frame')}`, state.failed + state.quarantined > 0 ? `${count(state.failed + state.quarantined)} failed` : null,
    state.rate_per_s > 0 ? (state.rate_per_s >= 1 ? `${number(state.rate_per_s)} frames/s` : `${number(60 * state.rate_per_s)} frames/min`) : null,
    state.eta_s === null ? null : `${duration(state.eta_s)} to go`, state.scheduler_bytes > 0 ? `scheduler ${megabytes(state.scheduler_bytes)}` : null].filter(Boolean);
  const others = data.live.others.length > 0 ? el('nav', { 'aria-label': 'Other campaigns' }, data.live.others.map(({ name, href }) => el('a', { href }, named(name)))) : null;
  const open = place.querySelector('details')?.open ?? false;
  const more = el('details', { open }, el('summary', {}, `Workers (${state.workers.length}) and newest frames`), newestStrip(state), workersTable(state));
  const focus = document.activeElement?.closest('#live') ? document.activeElement.textContent : null;
  place.hidden = false;
  place.replaceChildren(el('div', { class: 'live-line' }, el('span', { class: `tag ${kind}`, role: 'status' }, text), el('progress', { max: Math.max(1, state.frames), value: state.done, 'aria-label': 'Frames done' }),
    el('span', { id: 'live-facts' }, facts.join(' · ')), liveButtons(state), newFrames(state), others),
  ...[live.said, state.last_words].filter(Boolean).map((words) => el('pre', { class: 'banner' }, words)), more);
  if (focus) [...place.querySelectorAll('button, summary')].find((each) => each.textContent === focus)?.focus();
}

async function poll() {
  clearTimeout(live.timer);
  if (document.hidden) return; // it goes on when somebody looks
  try {
    const answer = await fetch('live', { cache: 'no-store' });
    if (!answer.ok) throw new Error(String(answer.status));
    live.state = await answer.json();
    live.failed = 0;
  } catch {
    live.failed += 1;
  }
  showLive();
  const busy = live.state?.at_work || live.state?.starting;
  live.timer = setTimeout(poll, busy && live.failed === 0 ? FAST_MS : SLOW_MS);
}

function startLive() {
  if (!data.live) return;
  document.addEventListener('visibilitychange', poll);
  poll();
}
