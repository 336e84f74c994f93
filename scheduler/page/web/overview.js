// The campaign at a glance, its health, and what is in the dataset.

function stat(label, value, note, attributes = {}) {
  return el('div', { class: `stat ${attributes.class ?? ''}` }, el('dt', {}, label),
    el('dd', {}, el('span', { class: 'value' }, value), note ? el('span', { class: 'stat-note' }, note) : null));
}

function stateNote() {
  const some = ['failed', 'quarantined', 'pending', 'running'].filter((state) => summary[state] > 0)
    .map((state) => `${count(summary[state])} ${state}`);
  return some.length > 0 ? some.join(', ') : 'complete';
}

function glance() {
  const failures = summary.failed + summary.quarantined;
  let damaged = 0;
  for (let i = 0; i < frames.count; ++i) damaged += frames.state[i] === DAMAGED ? 1 : 0;
  let seen = 0;
  for (let i = 0; i < objects.count; ++i) seen += objects.category[i] > 0 && isSeen(i) ? 1 : 0;
  const hash = summary.dataset_hash;
  const mean = summary.mean_seconds;
  const each = mean ? (mean.render_s ?? mean.render) + mean.build || mean.finish : NaN;
  const provenance = campaign.provenances.at(-1);
  const audit = data.audit;
  return el('dl', { class: 'glance' },
    stat('Frames', `${count(summary.done)} / ${count(summary.frames)}`, stateNote()),
    stat('Failures', count(failures + damaged), damaged > 0 ? `${count(damaged)} damaged on disk` : failures > 0 ? 'see “Run”' : 'none',
      { class: failures + damaged > 0 ? 'bad' : '' }),
    stat('Labelled objects', count(seen), `seen, of ${plural(categories.length, 'class', 'classes')}`),
    stat(campaign.has_pictures ? 'Time of workers' : 'Time of threads', duration(summary.worker_s),
      Number.isFinite(each) ? `${duration(each)} a frame` : null),
    stat('Pictures', `${campaign.width} × ${campaign.height}`, campaign.has_pictures ? 'pixels' : 'pixels, labels only'),
    stat('Audit', audit ? audit.grade : 'not audited', audit ? `${count(audit.sampled ?? 0)} frames again` : 'seedframe audit',
      { class: audit && audit.grade !== 'identical' && audit.grade !== 'rounding' ? 'bad' : '' }),
    stat('Dataset hash', hash ? el('code', { title: hash }, hash.slice(0, 12)) : '–',
      hash ? copyButton(hash, 'the dataset hash') : 'known when it is complete'),
    stat('Seedframe', provenance?.seedframe ?? '–',
      provenance?.blender ? `Blender ${provenance.blender}` : campaign.has_pictures ? null : 'no Blender'));
}

const MARKS = { good: '✓', note: 'i', warning: '!' };
const MARK_WORDS = { good: 'Good', note: 'Note', warning: 'Warning' };

function healthItem(finding) {
  const show = finding.frames?.length > 0 && finding.level !== 'good'
    ? el('button', { class: 'quiet', type: 'button', onclick: () => { showList(finding.title, finding.frames); location.hash = '#frames'; } },
      'Show frames') : null;
  return el('li', { class: `finding ${finding.level}` },
    el('span', { class: 'mark', 'aria-hidden': 'true' }, MARKS[finding.level]),
    el('div', {}, el('p', { class: 'finding-title' }, el('span', { class: 'sr' }, `${MARK_WORDS[finding.level]}: `), named(finding.title)),
      el('p', { class: 'note' }, named(finding.text))), show);
}

function healthCard() {
  const order = { warning: 0, note: 1, good: 2 };
  const findings = [...data.health];
  for (const state of ['failed', 'quarantined']) {
    if (summary[state] > 0) {
      findings.push({ level: 'warning', title: `${plural(summary[state], 'frame')} ${state}`, text: 'The dataset is not complete. “Run” has their last words.' });
    }
  }
  if (summary.pending > 0) {
    findings.push({ level: 'note', title: `${plural(summary.pending, 'frame')} not made yet`, text: `“seedframe resume ${campaign.folder}” goes on.` });
  }
  for (const text of summary.mixed) {
    findings.push({ level: 'warning', title: 'Frames were made with different programs', text: `Some with ${text}: their pixels are not comparable.` });
  }
  findings.sort((a, b) => order[a.level] - order[b.level]);
  if (findings.length === 0) {
    return el('section', { class: 'card health' }, el('h2', {}, 'Health'), emptyState('No finished frames yet', 'What a dataset’s health check warns of is told once there are some.'));
  }
  const warnings = findings.filter((finding) => finding.level === 'warning').length;
  return el('section', { class: 'card health' }, el('h2', {}, 'Health'),
    el('p', { class: 'note' }, warnings === 0 ? `${plural(findings.length, 'check')}, no warnings` : `${plural(warnings, 'warning')} in ${plural(findings.length, 'check')}`),
    el('ul', { class: 'findings' }, findings.map(healthItem)));
}

function eachObject(visit) {
  for (let frame = 0; frame < frames.count; ++frame) {
    for (let i = frames.first_object[frame]; i < frames.first_object[frame + 1]; ++i) {
      if (objects.category[i] > 0 && isSeen(i)) visit(i, frame, selected[frame] === 1);
    }
  }
}

function classFigure() {
  const n = categories.length + 1;
  const all = new Array(n).fill(0);
  const some = new Array(n).fill(0);
  const inFrames = Array.from({ length: n }, () => 0);
  const last = new Int32Array(n).fill(-1);
  eachObject((i, frame, inSelection) => {
    const k = objects.category[i];
    all[k] += 1;
    if (inSelection) some[k] += 1;
    if (last[k] !== frame) { inFrames[k] += 1; last[k] = frame; }
  });
  const order = categories.map((_, k) => k + 1).sort((a, b) => all[b] - all[a] || a - b);
  const shown = order.slice(0, 60);
  const more = order.length > shown.length ? `, the ${shown.length} most frequent of ${order.length}` : '';
  return figure('Objects of each class', `seen objects${more}`, `Objects of each class: ${shown.slice(0, 12).map((k) => `${categories[k - 1]} ${all[k]}`).join(', ')}`,
    Math.max(180, 22 * shown.length + 70), () => barConfig({
      labels: shown.map((k) => (categories[k - 1].length > 24 ? `${categories[k - 1].slice(0, 23)}…` : categories[k - 1])),
      all: shown.map((k) => all[k]), some: isFiltered() ? shown.map((k) => some[k]) : null, y: 'objects', horizontal: true, colors: shown.map(classColor),
      tooltip: (item) => `${item.dataset.label}: ${count(item.parsed.x)} objects, in ${count(inFrames[shown[item.dataIndex]])} frames`,
    }));
}

function datasetFigures() {
  let side = 1;
  let far = 0;
  let near = Infinity;
  let most = 0;
  const perFrame = new Uint32Array(frames.count);
  eachObject((i, frame) => {
    side = Math.max(side, sideOf(i));
    if (objects.distance_m[i] > far) far = objects.distance_m[i];
    if (objects.distance_m[i] < near) near = objects.distance_m[i];
    perFrame[frame] += 1;
    most = Math.max(most, perFrame[frame]);
  });
  const of = (value) => (put) => eachObject((i, frame, inSelection) => put(value(i), inSelection));
  const known = (values) => (i) => (values[i] === UNKNOWN ? NaN : values[i] / 10);
  const done = (put) => {
    for (let frame = 0; frame < frames.count; ++frame) if (frames.state[frame] === DONE) put(perFrame[frame], selected[frame] === 1);
  };
  const logAspect = (i) => Math.log2(objects.width[i] / objects.height[i]);
  return [
    histogramFigure({ title: 'Size of boxes', note: 'side of a square of the same area', edges: bins(0, side, 32), each: of(sideOf), x: 'side, px' }),
    histogramFigure({ title: 'Shape of boxes', note: '0: square, 1: twice as wide as high', edges: Array.from({ length: 25 }, (_, i) => (i - 12) / 4 - 0.125), each: of(logAspect), x: 'log₂ (width / height)', centred: true }),
    histogramFigure({ title: 'Visible share', note: 'of the whole silhouette', edges: bins(0, 100, 25), each: of(known(objects.visible_permille)), x: 'visible, %' }),
    histogramFigure({ title: 'Cut by the image’s edge', note: 'share of the silhouette outside', edges: bins(0, 100, 25), each: of(known(objects.truncation_permille)), x: 'outside, %' }),
    histogramFigure({ title: 'Distance from the camera', note: 'of the object’s origin', edges: bins(Number.isFinite(near) ? near : 0, far > near ? far : near + 1, 32), each: of((i) => objects.distance_m[i]), x: 'distance, m' }),
    histogramFigure({ title: 'Objects in a frame', edges: most <= 40 ? Array.from({ length: most + 2 }, (_, i) => i - 0.5) : bins(0, most, 40).map((edge) => edge - 0.5), each: done, x: 'seen objects', y: 'frames', centred: true }),
  ];
}

function boxHeatFigure() {
  const columns = 32;
  const rows = Math.max(4, Math.round((columns * campaign.height) / campaign.width));
  const values = new Float64Array(columns * rows);
  let n = 0;
  eachObject((i, frame, inSelection) => {
    if (!inSelection) return;
    n += 1;
    const left = Math.floor((objects.x[i] / campaign.width) * columns);
    const right = Math.min(columns - 1, Math.floor(((objects.x[i] + objects.width[i] - 1) / campaign.width) * columns));
    const top = Math.floor((objects.y[i] / campaign.height) * rows);
    const bottom = Math.min(rows - 1, Math.floor(((objects.y[i] + objects.height[i] - 1) / campaign.height) * rows));
    for (let y = top; y <= bottom; ++y) for (let x = left; x <= right; ++x) values[y * columns + x] += 1;
  });
  return heatFigure({ title: 'Where boxes lie', note: `${count(n)} boxes; darker or brighter: more of them`, columns, rows, values, x: 'x, px', y: 'y, px' });
}

// In how many frames of the selection two classes are seen together.
function cooccurrenceCard() {
  const most = 24;
  const n = Math.min(categories.length, most);
  if (n < 2) return null;
  const together = Array.from({ length: n }, () => new Array(n).fill(0));
  for (const frame of selection) {
    const seen = new Set();
    for (let i = frames.first_object[frame]; i < frames.first_object[frame + 1]; ++i) {
      if (objects.category[i] > 0 && objects.category[i] <= n && isSeen(i)) seen.add(objects.category[i] - 1);
    }
    for (const a of seen) for (const b of seen) together[a][b] += 1;
  }
  const highest = Math.max(1, ...together.flat());
  const cell = (a, b) => {
    const share = together[a][b] / highest;
    const deep = share > 0.55;
    // Neither dark nor light letters can be read on what lies between.
    const opacity = deep ? 0.86 + 0.3 * (share - 0.55) : 0.9 * share;
    return el('td', { class: 'heat', title: `${categories[a]} and ${categories[b]}: ${plural(together[a][b], 'frame')}`, style: { '--opacity': opacity.toFixed(3) }, 'data-deep': deep }, count(together[a][b]));
  };
  const grid = el('div', { class: 'scrolls', tabindex: '0', role: 'region', 'aria-label': 'Classes seen together' },
    el('table', { class: 'matrix' }, el('thead', {}, el('tr', {}, el('td'), categories.slice(0, n).map((name) => el('th', { scope: 'col' }, el('span', {}, named(name)))))),
      el('tbody', {}, together.map((row, a) => el('tr', {}, el('th', { scope: 'row' }, named(categories[a])), row.map((_, b) => cell(a, b)))))));
  return el('section', { class: n > 8 ? 'card wide' : 'card' }, el('h3', {}, 'Classes seen together'),
    el('p', { class: 'note' }, `frames of ${count(selection.length)} in which both are seen${categories.length > n ? `; the first ${n} classes` : ''}`), grid);
}

function filmstrip() {
  const done = Array.from(selection).filter((frame) => frames.state[frame] === DONE);
  const inside = Math.min(1456, innerWidth - (innerWidth > 640 ? 44 : 24));
  const n = Math.min(Math.max(2, Math.round(inside / 176)), done.length);
  if (n === 0) return null;
  const width = Math.min(240, Math.floor((inside - 8 * (n - 1)) / n));
  const some = Array.from({ length: n }, (_, i) => done[Math.floor((i * done.length) / n)]);
  return el('section', { class: 'strip', 'aria-label': 'Some frames' }, some.map((frame) => frameTile(frame, width)));
}

function overviewView() {
  if (summary.frames === 0) return [glance(), emptyState('This campaign has no frames', 'Its config asks for none.')];
  const figures = objects.count > 0
    ? el('div', { class: 'cards' }, classFigure(), ...datasetFigures(), boxHeatFigure(), cooccurrenceCard())
    : emptyState('No labels to count yet', 'Charts of the dataset appear with the first finished frame.');
  return [glance(), filmstrip(), healthCard(), el('h2', {}, 'In the dataset'), figures];
}
