// The grid of frames: only the tiles that can be seen are there, however many frames pass the filters.

const GRID_SIZES = { small: 110, medium: 170, large: 300 };
const GAP = 10;
const CAPTION = 26;
const grid = { size: 'medium', sort: 'index', order: [], element: null, tiles: new Map(), columns: 1, width: 0 };

const SORTS = {
  index: ['frame', null],
  time: ['slowest first', (frame) => -secondsOf(frame)],
  objects: ['most objects first', (frame) => -(frames.first_object[frame + 1] - frames.first_object[frame])],
  hidden: ['least visible object first', (frame) => {
    let least = 2000;
    for (let i = frames.first_object[frame]; i < frames.first_object[frame + 1]; ++i) {
      if (objects.category[i] > 0 && isSeen(i)) least = Math.min(least, objects.visible_permille[i]);
    }
    return least;
  }],
  dark: ['darkest first', (frame) => frames.luma[frame]],
};

function sortSelection() {
  const key = SORTS[grid.sort][1];
  if (!key) { grid.order = selection; return; }
  const keys = new Map();
  for (const frame of selection) {
    const value = key(frame);
    keys.set(frame, Number.isNaN(value) ? Infinity : value);
  }
  grid.order = Uint32Array.from(selection).sort((a, b) => keys.get(a) - keys.get(b) || a - b);
}

function layOutGrid() {
  const { element } = grid;
  if (!element?.isConnected) return;
  const inside = element.clientWidth;
  const wanted = Math.min(GRID_SIZES[grid.size], inside);
  grid.columns = Math.max(grid.size === 'small' ? 3 : grid.size === 'medium' ? 2 : 1, Math.floor((inside + GAP) / (wanted + GAP)));
  grid.width = Math.floor((inside - GAP * (grid.columns - 1)) / grid.columns);
  grid.rowHeight = Math.round((grid.width * campaign.height) / campaign.width) + CAPTION + GAP;
  element.style.height = `${Math.ceil(grid.order.length / grid.columns) * grid.rowHeight}px`;
  for (const tile of grid.tiles.values()) tile.remove();
  grid.tiles.clear();
  showTiles();
}

function showTiles() {
  const { element } = grid;
  if (!element?.isConnected || !grid.rowHeight) return;
  const top = -element.getBoundingClientRect().top;
  const first = Math.max(0, Math.floor(top / grid.rowHeight) - 1) * grid.columns;
  const end = Math.min(grid.order.length, (Math.ceil((top + innerHeight) / grid.rowHeight) + 1) * grid.columns);
  for (const [at, tile] of grid.tiles) {
    if ((at < first || at >= end) && tile !== document.activeElement) { tile.remove(); grid.tiles.delete(at); }
  }
  for (let at = first; at < end; ++at) {
    if (grid.tiles.has(at)) continue;
    const tile = frameTile(grid.order[at], grid.width);
    tile.style.position = 'absolute';
    tile.style.left = `${(at % grid.columns) * (grid.width + GAP)}px`;
    tile.style.top = `${Math.floor(at / grid.columns) * grid.rowHeight}px`;
    tile.dataset.at = at;
    grid.tiles.set(at, tile);
    // In order, so that the Tab key goes through them as eyes do.
    let after = null;
    for (const other of element.children) if (Number(other.dataset.at) > at) { after = other; break; }
    element.insertBefore(tile, after);
  }
}

function focusTile(at) {
  const target = Math.max(0, Math.min(grid.order.length - 1, at));
  const y = grid.element.getBoundingClientRect().top + Math.floor(target / grid.columns) * grid.rowHeight;
  if (y < 120 || y + grid.rowHeight > innerHeight) scrollBy(0, y - innerHeight / 2 + grid.rowHeight / 2);
  showTiles();
  grid.tiles.get(target)?.focus({ preventScroll: true });
}

function gridKeys(event) {
  const at = Number(event.target.closest?.('.tile')?.dataset.at);
  if (Number.isNaN(at)) return;
  const steps = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: grid.columns, ArrowUp: -grid.columns };
  const to = event.key === 'Home' ? 0 : event.key === 'End' ? grid.order.length - 1 : at + (steps[event.key] ?? 0);
  if (to === at) return;
  event.preventDefault();
  focusTile(to);
}

function renewGrid() {
  sortSelection();
  const told = document.getElementById('selection-count');
  if (told) told.textContent = selectionText();
  const nothing = document.getElementById('nothing-passes');
  if (nothing) nothing.hidden = selection.length > 0;
  layOutGrid();
}

function selectionText() {
  return isFiltered() ? `${count(selection.length)} of ${plural(frames.count, 'frame')}` : plural(frames.count, 'frame');
}

function framesView() {
  if (summary.frames === 0) return [emptyState('This campaign has no frames', 'Its config asks for none.')];
  grid.element = el('div', { class: 'grid', role: 'group', 'aria-label': 'Frames' });
  grid.element.addEventListener('keydown', gridKeys);
  const choice = (label, key, options) => {
    const select = el('select', { 'aria-label': label }, Object.entries(options).map(([value, text]) => el('option', { value, selected: grid[key] === value }, text)));
    select.addEventListener('change', () => { grid[key] = select.value; renewGrid(); });
    return el('label', {}, el('span', { class: 'sr' }, `${label} `), select);
  };
  const sorts = Object.fromEntries(Object.entries(SORTS).filter(([key]) => key !== 'dark' || campaign.has_pictures).map(([key, [text]]) => [key, key === 'index' ? 'in order' : text]));
  const reset = el('button', { type: 'button', onclick: () => { filter = noFilter(); applyFilter(); renewPanel(); } }, 'Remove all filters');
  const nothing = el('div', { id: 'nothing-passes', class: 'empty', hidden: true }, el('p', { class: 'empty-title' }, 'No frame passes all filters'), el('p', {}, reset));
  const sampled = summary.shown < summary.frames ? el('p', { class: 'banner' }, `This page shows ${count(summary.shown)} of ${count(summary.frames)} frames, evenly spread.`) : null;
  requestAnimationFrame(renewGrid);
  return [el('div', { class: 'with-panel' }, filterPanel(), el('div', {},
    sampled,
    el('div', { class: 'toolbar' }, el('p', { id: 'selection-count', role: 'status', class: 'count' }, selectionText()), overlayControls(),
      el('div', { class: 'controls' }, choice('Size', 'size', { small: 'small', medium: 'medium', large: 'large' }), choice('Order', 'sort', sorts))),
    nothing, grid.element))];
}

let tilesAsked = false;
addEventListener('scroll', () => {
  if (tilesAsked) return;
  tilesAsked = true;
  requestAnimationFrame(() => { tilesAsked = false; showTiles(); });
}, { passive: true });
addEventListener('resize', () => requestAnimationFrame(layOutGrid));
