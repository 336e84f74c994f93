// One frame: its picture, objects, draws, attempts, hashes, and the command that makes it again.

let shownFrame = -1;
let highlighted = -1; // an object of it, by its place in the frame

function neighbour(step) {
  const inSelection = selected[shownFrame] === 1;
  if (!inSelection) {
    const to = shownFrame + step;
    return to >= 0 && to < frames.count ? to : -1;
  }
  const at = grid.order.length === selection.length ? Array.prototype.indexOf.call(grid.order, shownFrame) : -1;
  const order = at >= 0 ? grid.order : selection;
  const to = (at >= 0 ? at : Array.prototype.indexOf.call(selection, shownFrame)) + step;
  return to >= 0 && to < order.length ? order[to] : -1;
}

const linkTo = (frame) => (frame < 0 ? null : `#frame/${frames.index[frame]}`);

function objectsTable(frame, repaint) {
  const first = frames.first_object[frame];
  const end = frames.first_object[frame + 1];
  if (end === first) return emptyState('No objects', 'Nothing in this frame has an id.');
  const share = (values, i) => (values[i] === UNKNOWN ? '–' : percent(values[i] / 1000));
  const rows = [];
  for (let i = first; i < end; ++i) {
    const k = i - first;
    const mark = el('button', { type: 'button', class: 'swatch-button', 'aria-label': `Show object ${objects.id[i]} in the picture`, 'aria-pressed': 'false' },
      el('span', { class: 'swatch', style: { background: objectColor(i, frame) } }));
    mark.addEventListener('click', () => {
      highlighted = highlighted === k ? -1 : k;
      for (const each of document.querySelectorAll('.swatch-button')) each.setAttribute('aria-pressed', String(each === mark && highlighted >= 0));
      repaint();
    });
    rows.push({
      attributes: { class: isSeen(i) ? null : 'unseen', onmouseenter: () => repaint(k), onmouseleave: () => repaint() },
      cells: [mark, String(objects.id[i]), el('span', { title: `asset ${data.assets[objects.asset[i]]}` }, named(data.names[objects.name[i]])), objects.category[i] === 0 ? el('span', { class: 'note' }, named(`${data.assets[objects.asset[i]]}, distractor`)) : named(categories[objects.category[i] - 1]),
        count(objects.area_px[i]), share(objects.visible_permille, i), share(objects.truncation_permille, i), number(objects.distance_m[i]),
        isSeen(i) ? `${objects.x[i]}, ${objects.y[i]}, ${objects.width[i]} × ${objects.height[i]}` : 'not seen'],
    });
  }
  return table([{ title: '' }, { title: 'Id', numeric: true }, { title: 'Object' }, { title: 'Class' }, { title: 'Seen, px', numeric: true }, { title: 'Visible', numeric: true },
    { title: 'Cut off', numeric: true }, { title: 'Far, m', numeric: true }, { title: 'Box x, y, size, px', numeric: true }], rows, { label: 'Objects of this frame' });
}

async function drawsTable(frame) {
  const rows = [];
  for (const variable of data.draws.variables) {
    const values = await valuesOf(variable);
    const list = [];
    for (let i = values.first(frame); i < values.end(frame); ++i) list.push(variable.names ? variable.names[values.values[i]] : number(values.values[i], 6));
    if (list.length > 0) rows.push([named(variable.name), named(list.join(', ')), unitOf(variable.name)]);
  }
  if (rows.length === 0) return emptyState('No draws are known', data.draws.left_out || 'The frame is not finished, or its config has changed since.');
  return table([{ title: 'Draw' }, { title: 'Value' }, { title: 'Unit' }], rows, { label: 'Draws of this frame' });
}

function attemptsTable(attempts) {
  if (attempts.length === 0) return emptyState('No attempts yet', 'Nobody has begun this frame.');
  return table([{ title: 'Attempt', numeric: true }, { title: 'Outcome' }, { title: 'By' }, { title: 'Build', numeric: true }, { title: 'Render', numeric: true }, { title: 'Finish', numeric: true }, { title: 'Message' }],
    attempts.map((each) => [String(each.attempt), each.outcome, each.worker < 0 ? 'found on this machine' : `worker ${each.worker}`, duration(each.build_s), duration(each.render_s), duration(each.finish_s),
      each.message ? el('pre', { class: 'message' }, each.message) : '–']), { label: 'Attempts at this frame' });
}

const hashRow = (label, hash) => (hash ? el('div', { class: 'hash' }, el('span', {}, label), copyButton(hash, label), el('code', {}, hash)) : null);

function identity(frame, details) {
  const index = frames.index[frame];
  const folder = `frames/${String(Math.floor(index / 1000)).padStart(3, '0')}/${String(index).padStart(6, '0')}`;
  const again = `seedframe resume ${quoted(campaign.folder)} --frame ${index}`;
  const file = (name) => (data.beside ? el('a', { href: `${folder}/${name}` }, name) : el('code', {}, name));
  const files = frames.state[frame] !== DONE ? null : el('p', {}, 'In ', el('code', {}, `${campaign.folder}/${folder}`), ': ', campaign.has_pictures ? [file(campaign.picture), ', '] : null, file('instances.png'), ', ', file('labels.json'), '.');
  return el('section', { class: 'card' }, el('h3', {}, 'Made again by'), el('div', { class: 'hash' }, el('code', {}, again), copyButton(again, 'the command')),
    el('p', { class: 'note' }, `“seedframe explain ${campaign.folder} ${index}” tells where each number comes from.`), files,
    hashRow('frame id', details?.id), hashRow('pixel hash', details?.pixel_hash));
}

function frameNotFound(index) {
  return [emptyState(`There is no frame ${index} on this page`, summary.shown < summary.frames ? 'It shows a sample of a large campaign.' : `The campaign has ${plural(summary.frames, 'frame')}.`), el('p', {}, el('a', { href: '#frames' }, 'All frames'))];
}

function frameView(index) {
  const frame = placeOf(index);
  if (frame < 0) return frameNotFound(index);
  shownFrame = frame;
  highlighted = -1;
  const done = frames.state[frame] === DONE;
  const canvas = el('canvas', { class: 'large', role: 'img', 'aria-label': done ? `Frame ${index}, ${objectsText(frame)}` : `Frame ${index}, ${STATES[frames.state[frame]]}` });
  const ratio = campaign.height / campaign.width;
  canvas.width = Math.max(720, Math.min(1280, campaign.width));
  canvas.height = Math.round(canvas.width * ratio);
  const repaint = (only) => paintFrame(canvas, frame, only ?? highlighted).catch(() => {});
  canvas.repaint = () => repaint();
  if (done) repaint();
  const details = el('div', {});
  const left = el('div', {});
  const right = el('div', {});
  const rest = el('div', { class: 'frame-rest' }, left, right);
  partOf(frame).then((part) => {
    const own = part.frames[frame % data.parts.cells];
    if (part.missing) details.append(el('p', { class: 'banner' }, `The folder “${data.parts.folder}” is not beside this page: pictures and attempts are in it.`));
    if (own?.damage) details.append(el('div', { class: 'banner bad' }, el('p', {}, 'The frame’s files are not as they were written; “resume” makes it again.'), el('pre', { class: 'message' }, own.damage)));
    if (data.live && frames.state[frame] > DONE) details.append(el('p', {}, el('button', { type: 'button', onclick: () => command(`retry/${index}`) }, 'Make this frame again')));
    if (own?.error) details.append(el('div', { class: 'banner bad' }, el('p', {}, 'The last attempt failed.'), el('pre', { class: 'message' }, own.error)));
    left.append(identity(frame, own), el('section', { class: 'card' }, el('h3', {}, 'Attempts and timings'), attemptsTable(own?.attempts ?? [])));
  });
  drawsTable(frame).then((draws) => right.append(el('section', { class: 'card' }, el('h3', {}, 'Draws'), draws)));
  const step = (to, text, label) => el('a', { class: 'button', href: linkTo(to), 'aria-label': label, 'aria-disabled': to < 0 ? 'true' : null }, text);
  const picture = done ? canvas : el('div', { class: 'no-picture large', style: { 'aspect-ratio': `${campaign.width} / ${campaign.height}` } }, el('span', { class: 'state-mark', 'aria-hidden': 'true' }, frames.state[frame] < DONE ? '…' : '×'), STATES[frames.state[frame]]);
  return [
    el('div', { class: 'toolbar frame-bar' }, el('a', { href: '#frames' }, '← Frames'), el('h2', {}, `Frame ${index}`), el('p', { class: 'note' }, `scene ${frames.scene[frame]} · ${STATES[frames.state[frame]]}${done ? ` · ${objectsText(frame)} · ${duration(secondsOf(frame))}` : ''}`),
      el('div', { class: 'controls' }, step(neighbour(-1), '← Previous', 'Previous frame'), step(neighbour(1), 'Next →', 'Next frame'))),
    details,
    el('div', { class: 'frame-top' }, el('div', {}, picture, done ? overlayControls() : null),
      el('section', { class: 'card' }, el('h3', {}, 'Objects'), objectsTable(frame, repaint))),
    rest,
  ];
}

function frameKeys(event) {
  if (event.key === 'Escape') { location.hash = '#frames'; return; }
  const step = { ArrowLeft: -1, k: -1, ArrowRight: 1, j: 1 }[event.key];
  if (!step) return;
  const to = neighbour(step);
  if (to >= 0) { event.preventDefault(); location.hash = linkTo(to); }
}
