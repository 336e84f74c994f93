// Which frames are shown: those that pass every filter. Filters of objects must hold for one and the same object.

const noFilter = () => ({
  classes: [], size: [null, null], visible: [null, null], hidden: false, scene: [null, null], frame: [null, null],
  states: [], seconds: [null, null], retried: false, draws: [], list: null,
});
let filter = noFilter();
let selection = new Uint32Array(0); // places of frames
let selected = new Uint8Array(0); // by place
const selectionListeners = new Set();

const isSet = (range) => range[0] !== null || range[1] !== null;
const within = (x, range) => (range[0] === null || x >= range[0]) && (range[1] === null || x <= range[1]);

const looksAtObjects = (f) => f.classes.length > 0 || isSet(f.size) || isSet(f.visible) || f.hidden;

function objectPasses(f, i) {
  if (!f.hidden && !isSeen(i)) return false;
  if (f.classes.length > 0 && !f.classes.includes(objects.category[i])) return false;
  if (isSet(f.size) && !within(sideOf(i), f.size)) return false;
  if (isSet(f.visible)) {
    if (objects.visible_permille[i] === UNKNOWN) return false;
    if (!within(objects.visible_permille[i] / 10, f.visible)) return false;
  }
  return true;
}

function drawPasses(draw, values, frame) {
  for (let i = values.first(frame); i < values.end(frame); ++i) {
    if (draw.names ? draw.names.includes(values.values[i]) : within(values.values[i], draw.range)) return true;
  }
  return false;
}

function framePasses(f, frame, values) {
  if (f.list && !f.list.places.has(frame)) return false;
  if (isSet(f.scene) && !within(frames.scene[frame], f.scene)) return false;
  if (isSet(f.frame) && !within(frames.index[frame], f.frame)) return false;
  if (f.states.length > 0 && !f.states.includes(frames.state[frame])) return false;
  if (isSet(f.seconds) && !within(secondsOf(frame), f.seconds)) return false;
  if (f.retried && frames.attempts[frame] < 2) return false;
  for (let d = 0; d < f.draws.length; ++d) {
    if (!drawPasses(f.draws[d], values[d], frame)) return false;
  }
  if (!looksAtObjects(f)) return true;
  for (let i = frames.first_object[frame]; i < frames.first_object[frame + 1]; ++i) {
    if (objectPasses(f, i)) return true;
  }
  return false;
}

let filterRun = 0;

async function applyFilter() {
  const run = ++filterRun;
  const f = filter;
  const values = await Promise.all(f.draws.map((draw) => valuesOf(data.draws.variables[draw.variable])));
  if (run !== filterRun) return; // a newer one is under way
  const passing = new Uint8Array(frames.count);
  let n = 0;
  for (let frame = 0; frame < frames.count; ++frame) {
    passing[frame] = framePasses(f, frame, values) ? 1 : 0;
    n += passing[frame];
  }
  const places = new Uint32Array(n);
  for (let frame = 0, at = 0; frame < frames.count; ++frame) if (passing[frame]) places[at++] = frame;
  selected = passing;
  selection = places;
  for (const listener of selectionListeners) listener();
}

function changeFilter(change) {
  filter = { ...filter, ...change };
  return applyFilter();
}

const isFiltered = () => selection.length !== frames.count || filterChips().length > 0;

function rangeText(range, unit = '') {
  const space = unit && unit !== '°' ? ' ' : '';
  if (range[0] === null) return `≤ ${number(range[1], 5)}${space}${unit}`;
  if (range[1] === null) return `≥ ${number(range[0], 5)}${space}${unit}`;
  return `${number(range[0], 5)} – ${number(range[1], 5)}${space}${unit}`;
}

// What is set, each with what takes it away.
function filterChips() {
  const chips = [];
  const add = (text, change) => chips.push({ text, change });
  if (filter.list) add(filter.list.label, { list: null });
  if (filter.classes.length > 0) {
    add(filter.classes.map((k) => (k === 0 ? 'distractors' : categories[k - 1])).join(' or '), { classes: [] });
  }
  if (isSet(filter.size)) add(`box side ${rangeText(filter.size, 'px')}`, { size: [null, null] });
  if (isSet(filter.visible)) add(`visible ${rangeText(filter.visible, '%')}`, { visible: [null, null] });
  if (filter.hidden) add('also objects that are not seen', { hidden: false });
  if (isSet(filter.scene)) add(`scene ${rangeText(filter.scene)}`, { scene: [null, null] });
  if (isSet(filter.frame)) add(`frame ${rangeText(filter.frame)}`, { frame: [null, null] });
  if (filter.states.length > 0) add(filter.states.map((s) => STATES[s]).join(' or '), { states: [] });
  if (isSet(filter.seconds)) add(`time ${rangeText(filter.seconds, 's')}`, { seconds: [null, null] });
  if (filter.retried) add('more than one attempt', { retried: false });
  filter.draws.forEach((draw, d) => {
    const variable = data.draws.variables[draw.variable];
    const text = draw.names ? draw.names.map((n) => variable.names[n]).join(' or ')
      : rangeText(draw.range, unitOf(variable.name));
    add(`${variable.name}: ${text}`, { draws: filter.draws.filter((_, i) => i !== d) });
  });
  return chips;
}

function showList(label, indices) {
  const places = new Set(indices.map(placeOf).filter((place) => place >= 0));
  filter = { ...noFilter(), list: { label, places } };
  return applyFilter();
}
