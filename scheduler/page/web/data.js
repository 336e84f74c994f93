// The page's data: columns as typed arrays, and the parts that hold thumbnails.

const data = JSON.parse(document.getElementById('data').textContent);
const campaign = data.campaign;
const summary = data.summary;
const categories = campaign.categories;
const STATES = ['pending', 'running', 'done', 'failed', 'quarantined', 'damaged'];
const DONE = 2;
const DAMAGED = 5;
const UNKNOWN = 65535;
const frames = {};
const objects = {};

const ARRAYS = {
  uint8: Uint8Array, uint16: Uint16Array, uint32: Uint32Array, int32: Int32Array, float32: Float32Array,
};

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflated(base64) {
  const stream = new Blob([bytesOf(base64)]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
}

async function unpackColumn(column) {
  return column.count === 0 ? new ARRAYS[column.type](0) : new ARRAYS[column.type](await inflated(column.data));
}

async function unpackColumns(packed, into) {
  const names = Object.keys(packed).filter((name) => name !== 'count');
  const columns = await Promise.all(names.map((name) => unpackColumn(packed[name])));
  names.forEach((name, i) => { into[name] = columns[i]; });
  into.count = packed.count;
}

// Values of a drawn variable: `of(frame)` gives the range of its values in `values`.
async function valuesOf(variable) {
  if (!variable.loaded) {
    variable.loaded = Promise.all([
      unpackColumn(variable.values),
      variable.offsets ? unpackColumn(variable.offsets) : null,
    ]).then(([values, offsets]) => ({
      values,
      first: (frame) => (offsets ? offsets[frame] : frame),
      end: (frame) => (offsets ? offsets[frame + 1] : frame + 1),
    }));
  }
  return variable.loaded;
}

// The frame's place by its index in the campaign, or -1.
function placeOf(index) {
  let low = 0;
  let high = frames.count - 1;
  while (low <= high) {
    const middle = (low + high) >> 1;
    if (frames.index[middle] === index) return middle;
    if (frames.index[middle] < index) low = middle + 1; else high = middle - 1;
  }
  return -1;
}

const secondsOf = (frame) => (frames.worker[frame] < 0 || frames.render_s[frame] === 0
  ? frames.build_s[frame] + frames.render_s[frame] + frames.finish_s[frame]
  : frames.build_s[frame] + frames.render_s[frame]);
const isSeen = (object) => objects.area_px[object] > 0;
const sideOf = (object) => Math.sqrt(objects.width[object] * objects.height[object]);

// ---- parts

const parts = new Map(); // number → promise, the least recently used first
const arrived = new Map(); // of a folder beside the page: number → what is told when it is there
const MOST_PARTS = 24;

globalThis.seedframePart = (number, content) => { arrived.get(number)?.(content); };

function fetchPart(number) {
  if (!data.parts.folder) {
    const look = () => document.getElementById(`part-${number}`);
    if (look()) return Promise.resolve(JSON.parse(look().textContent));
    return new Promise((resolve) => { // the page is still being read
      document.addEventListener('DOMContentLoaded', () => resolve(look() ? JSON.parse(look().textContent) : null));
    });
  }
  return new Promise((resolve) => {
    const script = document.createElement('script');
    arrived.set(number, resolve);
    script.onerror = () => resolve(null);
    script.src = `${encodeURIComponent(data.parts.folder)}/part-${number}.js`;
    document.head.append(script);
  });
}

async function preparePart(number) {
  const content = await fetchPart(number);
  if (!content) return { missing: true, frames: [] };
  const [masks, sprite] = await Promise.all([
    inflated(content.masks),
    content.sprite ? createImageBitmap(new Blob([bytesOf(content.sprite)], { type: 'image/webp' })) : null,
  ]);
  return { masks: new Uint8Array(masks), sprite, frames: content.frames };
}

function partOf(frame) {
  const number = Math.floor(frame / data.parts.cells);
  const known = parts.get(number) ?? preparePart(number);
  parts.delete(number);
  parts.set(number, known);
  if (parts.size > MOST_PARTS) parts.delete(parts.keys().next().value);
  return known;
}

// The frame's mask at the size of a thumbnail: 0, or 1 + the object's place in the frame.
function maskOf(part, frame) {
  const { width, height, cells } = data.parts;
  const size = width * height;
  const first = (frame % cells) * size;
  const mask = part.masks.slice(first, first + size);
  for (let i = width; i < size; ++i) mask[i] ^= mask[i - width];
  return mask;
}
