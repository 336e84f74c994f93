// Charts by Chart.js: each with its axes named, its number of values told, and the selection over all.

const liveCharts = new Set();

function destroyCharts() {
  for (const chart of liveCharts) chart.destroy();
  liveCharts.clear();
}

// The last charts of views that are no longer on the page.
function dropDetachedCharts() {
  for (const chart of liveCharts) {
    if (!chart.canvas?.isConnected) { chart.destroy(); liveCharts.delete(chart); }
  }
}

function figure(title, note, label, height, config) {
  const canvas = el('canvas', { role: 'img', 'aria-label': label });
  const box = el('div', { class: 'plot', style: { height: `${height}px` } }, canvas);
  const holder = el('section', { class: 'card' }, el('h3', {}, title), el('p', { class: 'note' }, note), box);
  whenVisible(box, () => {
    if (canvas.isConnected) liveCharts.add(new Chart(canvas, config()));
  });
  return holder;
}

// Charts that nobody has scrolled to are not made.
const awaited = new Map();
const visibility = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    if (!entry.isIntersecting) continue;
    visibility.unobserve(entry.target);
    const make = awaited.get(entry.target);
    awaited.delete(entry.target);
    if (make) make();
  }
}, { rootMargin: '300px' });
function whenVisible(element, make) {
  awaited.set(element, make);
  visibility.observe(element);
}

const axis = (title, more = {}) => ({
  title: { display: Boolean(title), text: title }, grid: { color: theme.line }, ticks: { maxRotation: 0 }, ...more,
});
const countAxis = (title) => axis(title, { beginAtZero: true, ticks: { precision: 0, maxTicksLimit: 6 } });

const legend = (shown) => ({
  display: shown, position: 'top', align: 'end', labels: { boxWidth: 14, boxHeight: 8, usePointStyle: true },
});

// Bars of all, over them those of the selection, and where it is known what was to be expected.
function barConfig({ labels, all, some, expected, x, y, horizontal = false, tooltip, title, colors, gapless = false }) {
  const bar = (label, values, color, order) => ({
    label, data: values, pointStyle: 'rect', backgroundColor: color, order, grouped: false, categoryPercentage: gapless ? 1 : 0.86,
    barPercentage: gapless ? 0.96 : 0.9,
  });
  const datasets = [bar('all frames', all, some ? theme.all : colors ?? theme.selection, 3)];
  if (some) datasets.push(bar('selection', some, theme.selection, 2));
  if (expected) {
    datasets.push({
      type: 'line', label: 'intended', data: expected, borderColor: theme.expected, backgroundColor: theme.expected,
      borderWidth: 2, pointRadius: gapless ? 0 : 5, pointStyle: gapless ? 'line' : 'rectRot', stepped: gapless ? 'middle' : false,
      showLine: gapless, order: 1,
    });
  }
  const value = horizontal ? 'x' : 'y';
  return {
    type: 'bar',
    data: { labels, datasets },
    options: {
      indexAxis: horizontal ? 'y' : 'x',
      scales: {
        [value]: countAxis(y),
        [horizontal ? 'y' : 'x']: axis(x, { grid: { display: false }, ticks: { maxRotation: 0, autoSkip: !horizontal, autoSkipPadding: 12 } }),
      },
      plugins: {
        legend: legend(datasets.length > 1),
        tooltip: { callbacks: { title: title ?? ((items) => items[0].label), label: (item) => tooltip?.(item) ?? `${item.dataset.label}: ${number(item.parsed[value], 4)}` } },
      },
    },
  };
}

// About n bins between round numbers.
function bins(least, most, n) {
  const span = most - least || 1;
  const rough = span / n;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 2.5, 5, 10].find((each) => each * power >= rough * 0.999);
  const first = Math.floor(least / step + 1e-9) * step;
  const edges = [];
  for (let i = 0; i === 0 || edges.at(-1) < most - 1e-9 * span; ++i) edges.push(first + i * step);
  return edges.length > 1 ? edges : [first, first + step];
}
// A bin is called by where it begins.
const binLabels = (edges) => edges.slice(0, -1).map((edge) => number(Math.abs(edge) < 1e-9 * Math.abs(edges.at(-1)) ? 0 : edge, 4));
const binTitle = (edges, unit) => (items) => `${number(edges[items[0].dataIndex], 4)} – ${number(edges[items[0].dataIndex + 1], 4)} ${unit}`;
function binOf(edges, x) {
  const last = edges.length - 2;
  if (!(x >= edges[0] && x <= edges[last + 1])) return -1;
  const guess = Math.min(last, Math.floor(((x - edges[0]) / (edges[last + 1] - edges[0])) * (last + 1)));
  if (x < edges[guess]) return guess - 1;
  return guess < last && x >= edges[guess + 1] ? guess + 1 : guess;
}

// `each` calls back with (value, is it in the selection).
function countedBins(edges, each) {
  const all = new Array(edges.length - 1).fill(0);
  const some = new Array(edges.length - 1).fill(0);
  each((x, inSelection) => {
    const bin = binOf(edges, x);
    if (bin < 0) return;
    all[bin] += 1;
    if (inSelection) some[bin] += 1;
  });
  return { all, some };
}

function histogramFigure({ title, note, edges, each, x, y = 'objects', centred = false }) {
  const { all, some } = countedBins(edges, each);
  const n = all.reduce((sum, value) => sum + value, 0);
  const m = some.reduce((sum, value) => sum + value, 0);
  const told = isFiltered() ? `${count(m)} of ${count(n)} ${y}` : `${count(n)} ${y}`;
  if (n === 0) return card(title, note, emptyState('Nothing to count', 'No finished frame has a value for this.'));
  return figure(title, `${told}${note ? ` · ${note}` : ''}`, `${title}: histogram of ${told}`, 220, () => barConfig({
    labels: binLabels(centred ? edges.map((edge, i) => (edge + (edges[i + 1] ?? edge)) / 2) : edges), all, some: isFiltered() ? some : null, x, y, gapless: true, title: centred ? undefined : binTitle(edges, x.split(', ')[1] ?? ''),
  }));
}

// A grid of squares, each as dark as its number.
function heatFigure({ title, note, columns, rows, values, x, y }) {
  const most = values.reduce((a, b) => Math.max(a, b), 0);
  if (most === 0) return card(title, note, emptyState('Nothing to show', 'No object of the selection is seen.'));
  const points = [];
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      points.push({ x: column + 0.5, y: row + 0.5, v: values[row * columns + column] });
    }
  }
  const color = (v) => {
    const steps = isDark() ? HEAT_DARK : HEAT_LIGHT;
    const at = Math.sqrt(v / most) * (steps.length - 1);
    const low = rgbOf(steps[Math.floor(at)]);
    const high = rgbOf(steps[Math.ceil(at)]);
    return `rgb(${low.map((c, i) => Math.round(c + (high[i] - c) * (at % 1))).join(' ')})`;
  };
  const holder = figure(title, note, `${title}: from 0 to ${number(most)} objects a cell`, 240, () => ({
    type: 'scatter',
    data: {
      datasets: [{
        data: points,
        pointStyle: 'rect',
        // A square's radius is half of its diagonal.
        pointRadius: (context) => {
          const area = context.chart.chartArea;
          return area ? Math.max((area.right - area.left) / columns, (area.bottom - area.top) / rows) * Math.SQRT1_2 + 0.5 : 1;
        },
        pointHoverRadius: (context) => {
          const area = context.chart.chartArea;
          return area ? (area.right - area.left) / columns * Math.SQRT1_2 : 1;
        },
        clip: 0,
        borderWidth: 0,
        hoverBorderWidth: 0,
        backgroundColor: (context) => color(context.raw?.v ?? 0),
      }],
    },
    options: {
      scales: {
        x: axis(x, { min: 0, max: columns, grid: { display: false }, ticks: { stepSize: columns / 4, callback: (v) => count(Math.round((v / columns) * campaign.width)) } }),
        y: axis(y, { min: 0, max: rows, reverse: true, grid: { display: false }, ticks: { stepSize: rows / 4, callback: (v) => count(Math.round((v / rows) * campaign.height)) } }),
      },
      plugins: { legend: legend(false), tooltip: { callbacks: { label: (item) => `${number(item.raw.v, 3)} objects cover it` } } },
    },
  }));
  const box = holder.querySelector('.plot');
  box.style.height = '';
  box.style.aspectRatio = `${columns} / ${rows * 1.12}`;
  return holder;
}
const HEAT_LIGHT = ['#f2f5f8', '#c6dbef', '#6baed6', '#2171b5', '#08306b'];
const HEAT_DARK = ['#1b2129', '#173f5f', '#20639b', '#56a3d9', '#d6ecff'];
