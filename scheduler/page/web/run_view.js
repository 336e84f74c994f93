// How the frames were made: time, errors, failures, the audit, exports, provenance.

function timeFigures() {
  let most = 0;
  let n = 0;
  let total = { build: 0, render: 0, finish: 0 };
  for (let frame = 0; frame < frames.count; ++frame) {
    const seconds = secondsOf(frame);
    if (!Number.isFinite(seconds)) continue;
    n += 1;
    most = Math.max(most, seconds);
    total = { build: total.build + frames.build_s[frame], render: total.render + frames.render_s[frame], finish: total.finish + frames.finish_s[frame] };
  }
  if (n === 0) return [card('Time of a frame', null, emptyState('No frame is finished yet', 'Timings come with the first.'))];
  const each = (put) => {
    for (let frame = 0; frame < frames.count; ++frame) {
      const seconds = secondsOf(frame);
      if (Number.isFinite(seconds)) put(seconds, selected[frame] === 1);
    }
  };
  const scale = most < 1 ? 1000 : 1;
  const unit = most < 1 ? 'ms' : 's';
  const phases = [['build the scene', total.build / n], ['render', total.render / n], ['check, label, write', total.finish / n]].filter(([, seconds]) => seconds > 0);
  return [
    histogramFigure({ title: 'Time of a frame', note: campaign.has_pictures ? 'of a worker' : 'of a thread', edges: bins(0, most * scale * 1.0001, 32), each: (put) => each((seconds, some) => put(seconds * scale, some)), x: `time, ${unit}`, y: 'frames' }),
    figure('Where the time goes', `mean of ${plural(n, 'frame')}; finishing runs beside the workers`, phases.map(([name, seconds]) => `${name} ${duration(seconds)}`).join(', '), 60 + 40 * phases.length, () => barConfig({
      labels: phases.map(([name]) => name), all: phases.map(([, seconds]) => seconds * scale), x: '', y: `time, ${unit}`, horizontal: true, tooltip: (item) => duration(item.parsed.x / scale),
    })),
  ];
}

function errorFigure() {
  const known = data.errors;
  if (!known) return null;
  const measure = known.promise?.measure ?? 'rmse8';
  const points = known.frames.map(({ frame, errors }) => ({ frame, place: placeOf(frame), y: errors[measure] }))
    .filter(({ place, y }) => place >= 0 && y !== null && y !== undefined).map((point) => ({ ...point, x: secondsOf(point.place) })).filter(({ x }) => Number.isFinite(x));
  const promise = known.promise;
  const words = promise ? `${number(100 * promise.share)} % of frames within ${measure} ${number(promise.max_error)} are promised` : null;
  if (points.length === 0) return card('Error against time', words, emptyState('Not measured yet', `“seedframe verify-error ${campaign.folder}” measures a sample.`));
  const kept = promise?.kept === undefined ? '' : promise.kept ? ': kept' : ': broken';
  return figure('Error against time', `${plural(points.length, 'measured frame')}${words ? ` · ${words}${kept}` : ''}`, `Error against time of ${points.length} frames`, 260, () => ({
    data: {
      datasets: [
        { type: 'scatter', label: 'measured frames', data: points, backgroundColor: theme.selection, pointRadius: 4 },
        ...(promise ? [{ type: 'line', label: 'promised', data: [{ x: 0, y: promise.max_error }, { x: Math.max(...points.map(({ x }) => x)) * 1.05, y: promise.max_error }], borderColor: theme.expected, borderWidth: 2, pointRadius: 0, borderDash: [6, 4] }] : []),
      ],
    },
    options: {
      scales: { x: { type: 'linear', beginAtZero: true, ...axis('time of a worker, s') }, y: { ...axis(`error, ${measure}`), beginAtZero: true } },
      plugins: { legend: legend(true), tooltip: { callbacks: { label: (item) => (item.raw.frame === undefined ? '' : `frame ${item.raw.frame}: ${number(item.raw.y)} in ${duration(item.raw.x)}`) } } },
      onClick: (_, found) => { const point = found.map(({ index, datasetIndex }) => (datasetIndex === 0 ? points[index] : null)).find(Boolean); if (point) location.hash = `#frame/${point.frame}`; },
    },
  }));
}

function leftOutCard() {
  if (data.left_out.length === 0) return null;
  return card('Left out', 'because nobody needs it; no pixel or label that is kept changes by it', table([{ title: 'What' }, { title: 'Why' }, { title: 'Frames', numeric: true }],
    data.left_out.map((each) => [named(each.what), named(each.why), count(each.frames)]), { label: 'Left out' }));
}

function webpImage(base64, alt, attributes = {}) {
  return el('img', { src: `data:image/webp;base64,${base64}`, alt, loading: 'lazy', ...attributes });
}

const frameLink = (index) => (placeOf(index) >= 0 ? el('a', { href: `#frame/${index}` }, `Frame ${index}`) : `Frame ${index}`);

function failuresCard() {
  const { failures } = data;
  const damaged = [];
  for (let frame = 0; frame < frames.count; ++frame) if (frames.state[frame] === DAMAGED) damaged.push(frames.index[frame]);
  if (failures.count + damaged.length + failures.attempts.length === 0) return card('Failures', null, el('p', { class: 'good-text' }, '✓ No attempt failed.'));
  const told = failures.frames.map((each) => el('details', { class: 'failure' }, el('summary', {}, `Frame ${each.frame}`, el('span', { class: 'tag bad' }, each.state), el('span', { class: 'note' }, ` ${plural(each.attempts, 'attempt')}${each.crashes > 0 ? `, ${plural(each.crashes, 'crash', 'crashes')}` : ''}`)),
    el('p', {}, frameLink(each.frame)), el('pre', { class: 'message' }, each.error || 'Nothing is known.'), each.log ? [el('h4', {}, 'The end of its log'), el('pre', { class: 'log', tabindex: '0' }, each.log)] : null,
    each.rejected ? el('figure', {}, webpImage(each.rejected, `Where frame ${each.frame} differs from its twin`), el('figcaption', { class: 'note' }, 'Where it differs from its twin: grey at edges, white inside.')) : null));
  const more = failures.count > failures.frames.length ? el('p', { class: 'note' }, `The first ${count(failures.frames.length)} of ${count(failures.count)}.`) : null;
  const recovered = failures.attempts.length === 0 ? null : el('details', {}, el('summary', {}, `Attempts that failed: the last ${count(failures.attempts.length)}`), table([{ title: 'Frame' }, { title: 'Attempt', numeric: true }, { title: 'Outcome' }, { title: 'Message' }],
    failures.attempts.map((each) => [frameLink(each.frame), String(each.attempt), each.outcome, el('pre', { class: 'message' }, each.message)]), { label: 'Attempts that failed' }));
  return card('Failures', failures.count > 0 ? plural(failures.count, 'frame') : 'every frame came out in the end', damaged.length > 0 ? el('p', { class: 'banner bad' }, `Damaged on disk: ${plural(damaged.length, 'frame')}, `, damaged.slice(0, 20).flatMap((index, i) => [i > 0 ? ', ' : '', frameLink(index)]), damaged.length > 20 ? ', …' : '') : null, told, more, recovered);
}

function auditCard() {
  const { audit } = data;
  if (!audit) return card('Audit', null, emptyState('Not audited', `“seedframe audit ${campaign.folder}” renders a sample again and tells whether it comes out as it did.`));
  const grades = Object.entries(audit.grades ?? {}).filter(([, n]) => n > 0).map(([grade, n]) => `${count(n)} ${grade}`).join(', ');
  const pictures = (audit.frames ?? []).filter((each) => each.picture);
  const differing = (audit.frames ?? []).filter((each) => each.grade !== 'identical');
  const problems = audit.files?.problems ?? [];
  return card('Audit', `${plural(audit.sampled ?? 0, 'frame')} made again: ${grades || 'none'}; ${plural(audit.files?.frames ?? 0, 'frame')} read`,
    el('p', {}, 'Grade: ', el('strong', {}, audit.grade)),
    problems.length > 0 ? el('ul', {}, problems.slice(0, 20).map((each) => el('li', {}, frameLink(each.frame), ': ', named(each.text)))) : null,
    differing.length > 0 ? table([{ title: 'Frame' }, { title: 'Grade' }, { title: 'Cause' }], differing.map((each) => [frameLink(each.frame), each.grade, named(each.cause ? `${each.cause.kind}: ${each.cause.text}` : each.error ?? '–')]), { label: 'Frames that differ' }) : null,
    pictures.length > 0 ? el('div', { class: 'differences' }, pictures.map((each) => el('figure', {}, webpImage(each.picture, `Difference of frame ${each.frame}`), el('figcaption', { class: 'note' }, `frame ${each.frame}, ${each.grade}: grey is what is stored, colour how far the new one is from it`)))) : null);
}

function exportsCard() {
  if (data.exports.length === 0) return null;
  return card('Exports', null, table([{ title: 'Format' }, { title: 'Folder' }, { title: 'Parts' }], data.exports.map((each) => [named(each.format ?? '–'), el('code', {}, each.folder),
    each.error ? each.error : each.splits.map((split) => `${split.name} ${plural(split.frames, 'frame')} of ${plural(split.scenes, 'scene')}`).join(' · ')]), { label: 'Exports' }));
}

function provenanceCard() {
  const rows = campaign.provenances.flatMap((provenance, i) => Object.entries(provenance ?? {}).map(([key, value]) => [campaign.provenances.length > 1 ? String(i + 1) : '', key, el('code', {}, typeof value === 'object' ? Object.entries(value).map(([k, v]) => `${k} ${v}`).join(', ') : String(value))]));
  return card('Provenance', `${plural(campaign.provenances.length, 'kind')} of attempts; seed ${campaign.seed}`,
    rows.length > 0 ? table([{ title: '#' }, { title: 'What' }, { title: 'Value' }], rows, { label: 'Provenance' }) : emptyState('Nothing is known yet', 'It is noted when the first frame is made.'),
    campaign.config ? el('details', {}, el('summary', {}, 'campaign.yaml'), el('pre', { class: 'log', tabindex: '0' }, campaign.config)) : null);
}

function runView() {
  return [el('div', { class: 'cards' }, ...timeFigures(), errorFigure()), failuresCard(), auditCard(), leftOutCard(), exportsCard(), provenanceCard(), aboutCard()];
}

function aboutCard() {
  return el('details', { class: 'card' }, el('summary', {}, 'About this page'), el('p', {}, 'Made by “seedframe report”. It loads nothing from a network. Charts are drawn by Chart.js:'), el('pre', { class: 'log', tabindex: '0' }, data.chart_license));
}
