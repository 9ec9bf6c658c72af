// Colours as [red, green, blue], sRGB 0 .. 1.

const VIRIDIS = ['#440154', '#482878', '#3e4a89', '#31688e', '#26828e', '#1f9e89', '#35b779', '#6ece58', '#b5de2b', '#fde725'];
const GAPS = ['#8c0a26', '#d6604d', '#f6c7a6', '#f7f0d8', '#a9cfe4', '#4393c3', '#082d70'];
export const NONE = fromHex('#a6a8ac');

export function fromHex(hex) {
  return [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16) / 255);
}

export function css([r, g, b]) {
  return `rgb(${[r, g, b].map((c) => Math.round(255 * c)).join(' ')})`;
}

function along(stops, share) {
  const at = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const first = Math.min(Math.floor(at), stops.length - 2);
  const [a, b] = [fromHex(stops[first]), fromHex(stops[first + 1])];
  return a.map((c, k) => c + (at - first) * (b[k] - c));
}

/** Even steps in lightness, share 0 .. 1; null gives grey. */
export function evenColour(share) {
  return share === null || !Number.isFinite(share) ? NONE : along(VIRIDIS, share);
}

/** -1 = the surfaces overlap (red), 0 = they touch (pale), 1 = apart (blue); null gives grey. */
export function gapColour(share) {
  return share === null ? NONE : along(GAPS, (share + 1) / 2);
}

/** A CSS gradient of one of the scales, for legends. */
export function gradient(colour, low, high) {
  const stops = Array.from({length: 11}, (_, k) => css(colour(low + (k / 10) * (high - low))));
  return `linear-gradient(to right, ${stops.join(', ')})`;
}
