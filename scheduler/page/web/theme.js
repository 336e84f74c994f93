// Light and dark; colours that people with any colour vision tell apart (Okabe and Ito, and Tol).

const CLASS_COLORS = ['#E69F00', '#56B4E9', '#009E73', '#F0E442', '#0072B2', '#D55E00', '#CC79A7', '#999933',
  '#882255', '#44AA99', '#DDCC77', '#AA4499'];
const DISTRACTOR_COLOR = '#8a8f98';

const classColor = (category) => (category === 0 ? DISTRACTOR_COLOR
  : CLASS_COLORS[(category - 1) % CLASS_COLORS.length]);
// From hidden to whole: dark blue over teal to yellow, in even steps of lightness (after viridis).
const SHARE_COLORS = ['#440154', '#414487', '#2a788e', '#22a884', '#7ad151', '#fde725'];
const shareColor = (share) => SHARE_COLORS[Math.min(5, Math.floor(6 * Math.max(0, share)))];

const rgbOf = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

const systemDark = matchMedia('(prefers-color-scheme: dark)');
let chosenTheme = null;
try { chosenTheme = localStorage.getItem('seedframe-theme'); } catch { /* none is kept */ }

const isDark = () => (chosenTheme ? chosenTheme === 'dark' : systemDark.matches);
const themeListeners = new Set();

function applyTheme() {
  document.documentElement.dataset.theme = isDark() ? 'dark' : 'light';
  const style = getComputedStyle(document.documentElement);
  const color = (name) => style.getPropertyValue(name).trim();
  if (globalThis.Chart) {
    Chart.defaults.color = color('--muted');
    Chart.defaults.borderColor = color('--line');
    Chart.defaults.font.family = style.fontFamily;
    Chart.defaults.font.size = 12;
    Chart.defaults.animation = false;
    Chart.defaults.maintainAspectRatio = false;
  }
  theme.all = color('--bar');
  theme.selection = color('--accent');
  theme.expected = color('--expected');
  theme.ink = color('--ink');
  theme.muted = color('--muted');
  theme.surface = color('--surface');
  theme.line = color('--line');
  for (const listener of themeListeners) listener();
}
const theme = {};

function toggleTheme() {
  chosenTheme = isDark() ? 'light' : 'dark';
  try { localStorage.setItem('seedframe-theme', chosenTheme); } catch { /* it holds for this visit */ }
  applyTheme();
}
systemDark.addEventListener('change', applyTheme);
