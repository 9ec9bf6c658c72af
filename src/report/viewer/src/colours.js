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

/** Quiet colours that neighbours in the list can be told apart by: hue by the golden angle, lightness in three steps. */
export function listColour(index) {
  const hue = (35 + 137.508 * index) % 360;
  return fromLch(0.72 - 0.08 * (index % 3), 0.075, hue);
}

/** OKLCH (Ottosson 2020) to sRGB, cut to the gamut. */
function fromLch(lightness, chroma, hueDeg) {
  const a = chroma * Math.cos((hueDeg * Math.PI) / 180);
  const b = chroma * Math.sin((hueDeg * Math.PI) / 180);
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ].map((c) => {
    const cut = Math.min(Math.max(c, 0), 1);
    return cut <= 0.0031308 ? 12.92 * cut : 1.055 * cut ** (1 / 2.4) - 0.055;
  });
}

/** A CSS gradient of one of the scales, for legends. */
export function gradient(colour, low, high) {
  const stops = Array.from({length: 11}, (_, k) => css(colour(low + (k / 10) * (high - low))));
  return `linear-gradient(to right, ${stops.join(', ')})`;
}
