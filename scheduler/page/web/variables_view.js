// Every drawn variable: what came out, over what was intended.

async function countDraws(variable) {
  const values = await valuesOf(variable);
  const n = (variable.names ?? variable.numbers)?.length ?? variable.edges.length - 1;
  const all = new Array(n).fill(0);
  const some = new Array(n).fill(0);
  const place = variable.numbers ? new Map(variable.numbers.map((x, i) => [Math.fround(x), i])) : null;
  const binAt = (x) => (variable.names ? x : place ? place.get(x) ?? -1 : binOf(variable.edges, Math.min(Math.max(x, variable.edges[0]), variable.edges.at(-1))));
  let lastScene = -1;
  for (let frame = 0; frame < frames.count; ++frame) {
    const first = values.first(frame);
    const end = values.end(frame);
    if (first === end) continue;
    // What is drawn once a scene counts once.
    if (variable.level === 'scene' && frames.scene[frame] === lastScene) continue;
    if (variable.level === 'campaign' && lastScene >= 0) break;
    lastScene = frames.scene[frame];
    for (let i = first; i < end; ++i) {
      const bin = binAt(values.values[i]);
      if (bin < 0) continue;
      all[bin] += 1;
      if (selected[frame]) some[bin] += 1;
    }
  }
  return { all, some };
}

const sum = (values) => values.reduce((a, b) => a + b, 0);

function drawFigure(variable) {
  const unit = unitOf(variable.name);
  const canvas = el('canvas', { role: 'img', 'aria-label': `${variable.name}: histogram of its draws` });
  const note = el('p', { class: 'note' }, variable.law ? named(variable.law) : 'no law is known');
  const box = el('div', { class: 'plot', style: { height: '190px' } }, canvas);
  const holder = el('section', { class: 'card' }, el('h3', { class: 'variable' }, named(variable.name)), note, box);
  whenVisible(box, async () => {
    const { all, some } = await countDraws(variable);
    if (!canvas.isConnected) return;
    const n = isFiltered() ? sum(some) : sum(all);
    const known = variable.expected.every((share) => share !== null);
    const each = { scene: ' (once a scene)', campaign: ' (once)' }[variable.level] ?? '';
    note.textContent = `${variable.law ?? 'no law is known'} · ${plural(sum(all), 'draw')}${each}`;
    canvas.setAttribute('aria-label', `${variable.name}: histogram of ${plural(n, 'draw')}${known ? ', over the intended density' : ''}`);
    const labels = variable.names ?? (variable.numbers ? variable.numbers.map((x) => number(x, 4)) : binLabels(variable.edges));
    liveCharts.add(new Chart(canvas, barConfig({
      labels: labels.map((text) => (text.length > 22 ? `${text.slice(0, 21)}…` : text)), all, some: isFiltered() ? some : null,
      expected: known ? variable.expected.map((share) => share * n) : null, x: unit, y: 'draws', gapless: Boolean(variable.edges), title: variable.edges ? binTitle(variable.edges, unit) : undefined,
    })));
  });
  return holder;
}

function constraintsCard() {
  if (data.constraints.length === 0) return null;
  return card('Constraints', 'how often a drawn frame met each; a frame is drawn again until it meets all',
    table([{ title: 'Constraint' }, { title: 'Met', numeric: true }, { title: 'Of draws', numeric: true }, { title: 'Acceptance', numeric: true }, { title: '' }],
      data.constraints.map((each) => {
        const share = each.checked > 0 ? each.met / each.checked : 0;
        return [named(each.name), count(each.met), count(each.checked), each.checked > 0 ? percent(share) : '–', el('meter', { min: 0, max: 1, value: share, 'aria-label': `Acceptance of ${each.name}` })];
      }), { label: 'Constraints' }));
}

function variablesView() {
  const { variables } = data.draws;
  if (variables.length === 0) {
    return [emptyState('No draws are known', data.draws.left_out ? `The config cannot be expanded here: ${data.draws.left_out}` : 'They appear with the first finished frame.'), constraintsCard()];
  }
  const holder = el('div', { class: 'cards' });
  const told = el('p', { class: 'count', role: 'status' });
  const search = el('input', { type: 'search', placeholder: 'Find a variable…', 'aria-label': 'Find a variable' });
  const show = () => {
    const words = search.value.toLowerCase().split(/\s+/);
    const found = variables.filter((variable) => words.every((word) => variable.name.toLowerCase().includes(word)));
    told.textContent = `${count(found.length)} of ${plural(variables.length, 'variable')}`;
    holder.replaceChildren(...found.map(drawFigure));
    dropDetachedCharts();
  };
  search.addEventListener('input', show);
  show();
  return [el('div', { class: 'toolbar' }, told, search, el('p', { class: 'note' }, data.draws.frames < summary.done ? `Known of ${count(data.draws.frames)} frames: for the others the config asks for something else today.` : 'Bars: what was drawn. Line or diamonds: what the config asks for.')),
    constraintsCard(), holder];
}
