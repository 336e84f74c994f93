// A frame on a canvas: its picture, and over it masks, boxes and names.

const overlays = { masks: false, boxes: true, names: false, colorBy: 'class' };
const overlayListeners = new Set();
function setOverlay(change) {
  Object.assign(overlays, change);
  for (const listener of overlayListeners) listener();
}

function objectColor(object, frame) {
  if (overlays.colorBy === 'object') return CLASS_COLORS[(object - frames.first_object[frame]) % CLASS_COLORS.length];
  if (overlays.colorBy === 'visible') {
    return objects.visible_permille[object] === UNKNOWN ? DISTRACTOR_COLOR : shareColor(objects.visible_permille[object] / 1000);
  }
  return classColor(objects.category[object]);
}

function paintMask(context, part, frame, box, alpha, only) {
  const { width, height } = data.parts;
  const mask = maskOf(part, frame);
  const first = frames.first_object[frame];
  const n = Math.min(255, frames.first_object[frame + 1] - first);
  const colors = Array.from({ length: n }, (_, k) => rgbOf(objectColor(first + k, frame)));
  const image = new ImageData(width, height);
  for (let i = 0; i < mask.length; ++i) {
    const k = mask[i] - 1;
    if (k < 0 || k >= n || (only >= 0 && k !== only)) continue;
    const edge = mask[i - 1] !== mask[i] || mask[i + 1] !== mask[i] || mask[i - width] !== mask[i] || mask[i + width] !== mask[i];
    image.data.set(colors[k], 4 * i);
    image.data[4 * i + 3] = edge ? 255 : alpha;
  }
  const layer = new OffscreenCanvas(width, height);
  layer.getContext('2d').putImageData(image, 0, 0);
  context.imageSmoothingEnabled = false;
  context.drawImage(layer, ...box);
  context.imageSmoothingEnabled = true;
}

function paintBoxes(context, frame, scale, only) {
  const first = frames.first_object[frame];
  const width = context.canvas.width;
  const line = Math.max(1, Math.min(2.5, width / 220));
  context.font = `${Math.max(10, Math.min(15, width / 34))}px system-ui, sans-serif`;
  context.textBaseline = 'top';
  for (let i = first; i < frames.first_object[frame + 1]; ++i) {
    if (!isSeen(i) || (only >= 0 ? i - first !== only : objects.category[i] === 0)) continue;
    const [x, y, w, h] = [objects.x[i], objects.y[i], objects.width[i], objects.height[i]].map((v) => v * scale);
    if (overlays.boxes || only >= 0) {
      context.lineWidth = line + 1.5;
      context.strokeStyle = 'rgba(0,0,0,.55)';
      context.strokeRect(x, y, w, h);
      context.lineWidth = line;
      context.strokeStyle = objectColor(i, frame);
      context.strokeRect(x, y, w, h);
    }
    if (overlays.names || only >= 0) {
      const text = objects.category[i] === 0 ? 'distractor' : categories[objects.category[i] - 1].slice(0, 40);
      const size = context.measureText(text);
      const left = Math.max(0, Math.min(x, width - size.width - 6));
      const height = parseFloat(context.font) + 4;
      const top = y - height >= 0 ? y - height : y;
      context.fillStyle = 'rgba(0,0,0,.72)';
      context.fillRect(left, top, size.width + 6, height);
      context.fillStyle = '#fff';
      context.fillText(text, left + 3, top + 2);
    }
  }
}

// `only`: an object of the frame that alone is marked; -1: all. Resolves to whether there is a picture.
async function paintFrame(canvas, frame, only = -1) {
  const context = canvas.getContext('2d');
  const { width, height, cells, columns } = data.parts;
  const part = await partOf(frame);
  const box = [0, 0, canvas.width, canvas.height];
  context.fillStyle = '#1b222c';
  context.fillRect(...box);
  if (part.missing || frames.state[frame] !== DONE) return false;
  if (part.sprite) {
    const cell = frame % cells;
    context.imageSmoothingEnabled = canvas.width < 4 * width;
    context.drawImage(part.sprite, (cell % columns) * width, Math.floor(cell / columns) * height, width, height, ...box);
  }
  if (overlays.masks || !part.sprite || only >= 0) {
    paintMask(context, part, frame, box, part.sprite ? 120 : only >= 0 ? 255 : 215, part.sprite ? only : -1);
  }
  if (overlays.boxes || overlays.names || only >= 0) paintBoxes(context, frame, canvas.width / campaign.width, only);
  return true;
}

function objectsText(frame) {
  let seen = 0;
  for (let i = frames.first_object[frame]; i < frames.first_object[frame + 1]; ++i) {
    if (objects.category[i] > 0 && isSeen(i)) seen += 1;
  }
  return plural(seen, 'object');
}

// A link to the frame, with its picture at so many CSS pixels of width.
function frameTile(frame, width) {
  const index = frames.index[frame];
  const state = frames.state[frame];
  const height = Math.round((width * campaign.height) / campaign.width);
  const label = state === DONE ? `Frame ${index}, scene ${frames.scene[frame]}, ${objectsText(frame)}` : `Frame ${index}, ${STATES[state]}`;
  const tile = el('a', { class: `tile ${STATES[state]}`, href: `#frame/${index}`, 'aria-label': label, 'data-frame': frame, style: { width: `${width}px` } });
  const caption = el('span', { class: 'caption' }, el('span', {}, `#${index}`), el('span', { class: 'note' }, state === DONE ? objectsText(frame) : STATES[state]));
  if (state === DONE) {
    const scale = Math.min(2, devicePixelRatio || 1);
    const canvas = el('canvas', { width: Math.max(1, Math.round(width * scale)), height: Math.max(1, Math.round(height * scale)), style: { width: `${width}px`, height: `${height}px` } });
    const paint = () => { if (canvas.isConnected || !tile.shown) paintFrame(canvas, frame).catch(() => {}); tile.shown = true; };
    tile.repaint = paint;
    paint();
    tile.append(canvas);
  } else {
    const words = { failed: 'failed', quarantined: 'quarantined', damaged: 'damaged on disk', pending: 'not made yet', running: 'being made' };
    tile.append(el('span', { class: 'no-picture', style: { height: `${height}px` } }, el('span', { class: 'state-mark', 'aria-hidden': 'true' }, state === 0 || state === 1 ? '…' : '×'), words[STATES[state]]));
  }
  tile.append(caption);
  return tile;
}

function overlayControls() {
  const toggle = (key, text, letter) => {
    const button = el('button', { type: 'button', class: 'toggle', 'aria-pressed': String(overlays[key]), title: `${text} (${letter})` }, text);
    button.addEventListener('click', () => setOverlay({ [key]: !overlays[key] }));
    return button;
  };
  const colors = el('select', { 'aria-label': 'Colours' },
    [['class', 'by class'], ['object', 'by object'], ['visible', 'by visible share']].map(([value, text]) => el('option', { value, selected: overlays.colorBy === value }, text)));
  colors.addEventListener('change', () => setOverlay({ colorBy: colors.value }));
  return el('div', { class: 'controls', role: 'group', 'aria-label': 'Overlays' }, toggle('boxes', 'Boxes', 'b'), toggle('masks', 'Masks', 'm'), toggle('names', 'Names', 'n'),
    el('label', {}, el('span', { class: 'sr' }, 'Colours '), colors));
}
