// The form of all filters.

function rangeField(title, key, unit, hint) {
  const field = (side, name) => {
    const input = el('input', {
      type: 'number', step: 'any', inputmode: 'decimal', 'aria-label': `${title}, ${name}${unit ? `, ${unit}` : ''}`,
      value: filter[key][side] ?? '', placeholder: name,
    });
    input.addEventListener('change', () => {
      const range = [...filter[key]];
      range[side] = input.value === '' ? null : Number(input.value);
      changeFilter({ [key]: range });
    });
    return input;
  };
  return el('fieldset', {}, el('legend', {}, title, unit ? el('span', { class: 'note' }, ` ${unit}`) : null),
    el('div', { class: 'range' }, field(0, 'least'), el('span', { 'aria-hidden': 'true' }, '–'), field(1, 'most')),
    hint ? el('p', { class: 'note' }, hint) : null);
}

function checkList(title, entries, key) {
  return el('fieldset', {}, el('legend', {}, title), el('div', { class: 'checks' }, entries.map(({ value, text, note, color }) => {
    const input = el('input', { type: 'checkbox', checked: filter[key].includes(value) });
    input.addEventListener('change', () => {
      changeFilter({ [key]: input.checked ? [...filter[key], value] : filter[key].filter((each) => each !== value) });
    });
    return el('label', { class: 'check' }, input, color ? el('span', { class: 'swatch', style: { background: color } }) : null, named(text), el('span', { class: 'note' }, note));
  })));
}

function flag(text, key) {
  const input = el('input', { type: 'checkbox', checked: filter[key] });
  input.addEventListener('change', () => changeFilter({ [key]: input.checked }));
  return el('label', { class: 'check' }, input, text);
}

function setDraw(d, change) {
  return changeFilter({ draws: filter.draws.map((draw, i) => (i === d ? { ...draw, ...change } : draw)) });
}

function drawField(draw, d) {
  const variable = data.draws.variables[draw.variable];
  const unit = unitOf(variable.name);
  const remove = el('button', {
    type: 'button', class: 'quiet', 'aria-label': `Remove the filter of ${variable.name}`,
    onclick: () => { changeFilter({ draws: filter.draws.filter((_, i) => i !== d) }); renewPanel(); },
  }, '×');
  let body;
  if (draw.names) {
    body = el('div', { class: 'checks' }, variable.names.map((name, n) => {
      const input = el('input', { type: 'checkbox', checked: draw.names.includes(n) });
      input.addEventListener('change', () => {
        const names = filter.draws[d].names;
        setDraw(d, { names: input.checked ? [...names, n] : names.filter((each) => each !== n) });
      });
      return el('label', { class: 'check' }, input, named(name));
    }));
  } else {
    const field = (side, name) => {
      const input = el('input', { type: 'number', step: 'any', 'aria-label': `${variable.name}, ${name}`, placeholder: name, value: draw.range[side] ?? '' });
      input.addEventListener('change', () => {
        const range = [...filter.draws[d].range];
        range[side] = input.value === '' ? null : Number(input.value);
        setDraw(d, { range });
      });
      return input;
    };
    body = el('div', { class: 'range' }, field(0, 'least'), el('span', { 'aria-hidden': 'true' }, '–'), field(1, 'most'));
  }
  return el('div', { class: 'draw-filter', role: 'group', 'aria-label': variable.name }, el('p', {}, named(variable.name), unit ? el('span', { class: 'note' }, ` ${unit}`) : null, remove), body);
}

function drawsFieldset() {
  const { variables } = data.draws;
  if (variables.length === 0) return null;
  const select = el('select', { 'aria-label': 'Add a filter of a drawn variable' }, el('option', { value: '' }, 'Add a variable…'),
    variables.map((variable, v) => el('option', { value: String(v) }, variable.name)));
  select.addEventListener('change', () => {
    if (select.value === '') return;
    const variable = Number(select.value);
    const draw = variables[variable].names ? { variable, names: variables[variable].names.map((_, n) => n) } : { variable, range: [null, null] };
    changeFilter({ draws: [...filter.draws, draw] });
    renewPanel();
  });
  return el('fieldset', {}, el('legend', {}, 'Draws'), filter.draws.map(drawField), select,
    el('p', { class: 'note' }, 'Of copies, one must pass.'));
}

function classEntries() {
  const counts = new Array(categories.length + 1).fill(0);
  for (let i = 0; i < objects.count; ++i) if (isSeen(i)) counts[objects.category[i]] += 1;
  const entries = categories.map((text, k) => ({ value: k + 1, text, note: count(counts[k + 1]), color: classColor(k + 1) }));
  if (counts[0] > 0) entries.push({ value: 0, text: 'distractors', note: count(counts[0]), color: classColor(0) });
  return entries;
}

function stateEntries() {
  const counts = new Array(STATES.length).fill(0);
  for (let i = 0; i < frames.count; ++i) counts[frames.state[i]] += 1;
  return STATES.map((text, value) => ({ value, text, note: count(counts[value]) })).filter(({ value }) => counts[value] > 0);
}

function panelFields() {
  const states = stateEntries();
  return [
    filter.list ? el('p', { class: 'banner' }, `Only: ${filter.list.label}`) : null,
    el('p', { class: 'panel-head' }, 'Frames with an object that is'),
    categories.length > 0 ? checkList('Of class', classEntries(), 'classes') : null,
    rangeField('Box side', 'size', 'px', '√ of the box’s area'),
    rangeField('Visible', 'visible', '%', 'of its silhouette'),
    flag('also objects that are not seen', 'hidden'),
    el('p', { class: 'panel-head' }, 'and that are'),
    rangeField('Frame', 'frame', ''),
    rangeField('Scene', 'scene', ''),
    states.length > 1 ? checkList('State', states, 'states') : null,
    rangeField('Time', 'seconds', 's'),
    flag('made in more than one attempt', 'retried'),
    drawsFieldset(),
    el('button', { type: 'button', onclick: () => { filter = noFilter(); applyFilter(); renewPanel(); } }, 'Remove all filters'),
  ];
}

function renewPanel() {
  const fields = document.getElementById('filter-fields');
  if (fields) fields.replaceChildren(...panelFields().filter(Boolean));
}

function filterPanel() {
  const wide = matchMedia('(min-width: 1000px)').matches;
  return el('details', { class: 'panel', open: wide }, el('summary', {}, 'Filters'), el('form', { id: 'filter-fields', onsubmit: (event) => event.preventDefault() }, panelFields()));
}

// The filters that are set, on every view.
function chipsBar() {
  const bar = document.getElementById('chips');
  if (!bar) return;
  const chips = filterChips();
  bar.hidden = chips.length === 0;
  bar.replaceChildren(el('span', { class: 'note' }, selectionText()), ...chips.map(({ text, change }) => el('button', {
    type: 'button', class: 'chip', title: 'Remove this filter', onclick: () => { changeFilter(change); renewPanel(); },
  }, named(text), el('span', { 'aria-hidden': 'true' }, ' ×'), el('span', { class: 'sr' }, ', remove'))));
}
