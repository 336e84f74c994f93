// Elements and texts. Whatever a campaign says becomes text, never markup.

function el(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === 'class') element.className = value;
    else if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else if (name === 'style') for (const [property, setting] of Object.entries(value)) element.style.setProperty(property, setting);
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

// A name of the campaign: kept apart from the text around it, whatever direction it is written in.
const named = (text) => el('bdi', {}, text);

const whole = new Intl.NumberFormat('en-GB');
const count = (n) => whole.format(n);
function number(x, digits = 3) {
  if (!Number.isFinite(x)) return '–';
  if (x === 0) return '0';
  const size = Math.abs(x);
  if (size >= 1e6 || size < 1e-4) return x.toExponential(digits - 1);
  if (size >= 10 ** digits) return whole.format(Math.round(x));
  return String(Number(x.toPrecision(digits)));
}
function percent(share) {
  const value = 100 * share;
  if (value > 0 && value < 0.05) return '< 0.1 %';
  return value > 0 && value < 9.95 ? `${value.toFixed(1)} %` : `${Math.round(value)} %`;
}
function duration(seconds) {
  if (!Number.isFinite(seconds)) return '–';
  if (seconds < 1) return `${number(1000 * seconds, 3)} ms`;
  if (seconds < 120) return `${number(seconds)} s`;
  if (seconds < 7200) return `${number(seconds / 60)} min`;
  return `${number(seconds / 3600)} h`;
}
const plural = (n, one, many = `${one}s`) => `${count(n)} ${n === 1 ? one : many}`;

// By how a name ends: what its numbers are.
function unitOf(name) {
  const stem = name.replace(/\[\d+\]$/, '').replace(/\.(\d+)$/, '');
  const endings = [['_deg', '°'], ['_mm', 'mm'], ['_px', 'px'], ['_m', 'm'], ['_s', 's'], ['.kelvin', 'K'],
    ['.power', 'W'], ['.lumens', 'lm'], ['.position', 'm'], ['.scatter.x', 'm'], ['.scatter.y', 'm'], ['.target', 'm']];
  const found = endings.find(([ending]) => stem.endsWith(ending));
  return found ? found[1] : '';
}

function copyButton(text, label) {
  const button = el('button', { class: 'quiet', type: 'button', 'aria-label': `Copy ${label}` }, 'Copy');
  button.addEventListener('click', async () => {
    try {
      await navigator.clipboard.writeText(text);
      button.textContent = 'Copied';
    } catch { // not allowed: the text can be selected
      button.textContent = 'Select it';
    }
    setTimeout(() => { button.textContent = 'Copy'; }, 1500);
  });
  return button;
}

function table(columns, rows, attributes = {}) {
  const cell = (tag, value, column) => el(tag, {
    class: column.numeric ? 'numeric' : null,
    scope: tag === 'th' ? 'col' : null,
  }, value);
  return el('div', { class: 'scrolls', tabindex: '0', role: 'region', 'aria-label': attributes.label ?? 'Table' },
    el('table', {},
      el('thead', {}, el('tr', {}, columns.map((column) => cell('th', column.title, column)))),
      el('tbody', {}, rows.map((row) => el('tr', { ...(row.attributes ?? {}) },
        (row.cells ?? row).map((value, i) => cell('td', value, columns[i])))))));
}

const card = (title, note, ...content) => el('section', { class: 'card' },
  el('h3', {}, title), note ? el('p', { class: 'note' }, note) : null, ...content);

function emptyState(title, text) {
  return el('div', { class: 'empty' }, el('p', { class: 'empty-title' }, title), el('p', {}, text));
}

const quoted = (text) => (/^[\w./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`);
