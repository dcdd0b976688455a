// A transfer function as the scene has it, { unit_distance, opacity: [[value, opacity], ...], color: [[value, r, g,
// b], ...] }, and the changes that its editor makes. Every function returns a new one.

const byValue = (a, b) => a[0] - b[0];
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

// Two rows at one value make a step. A third row at this value would have no meaning, and the scene's reader
// refuses the function.
const isReadable = (rows) => rows.every((row, n) => n < 2 || row[0] !== rows[n - 2][0]);
const nearest = (rows, value) => rows.reduce((best, row, n) => (Math.abs(row[0] - value) < Math.abs(rows[best][0] - value) ? n : best), 0);

// isProjection(): whether a scene is a maximum projection, which shows no surfaces and uses
// transfer functions of one number. isPlane(): whether a volume's transfer function takes two
// numbers, so that it has boxes and polygons instead of points.
export const isProjection = (scene) => scene.render?.compositing === "maximum";
export const isPlane = (volume) => volume?.transfer_function?.second !== undefined;

// Moves an opacity point between its neighbours. Opacity points at the same value, as at a step, keep their
// order. The first and the last point may be moved to the ends of `range`, or may stay beyond the ends if
// they lie there already.
export function movePoint(tf, index, value, opacity, range) {
  const before = tf.opacity[index - 1]?.[0] ?? Math.min(range[0], tf.opacity[index][0]);
  const after = tf.opacity[index + 1]?.[0] ?? Math.max(range[1], tf.opacity[index][0]);
  const point = [clamp(value, before, after), clamp(opacity, 0, 1)];
  const points = tf.opacity.map((p, n) => (n === index ? point : p));
  return isReadable(points) ? { ...tf, opacity: points } : tf;
}

// Returns { tf, index }: the function with a new point, and the point's index.
export function addPoint(tf, value, opacity) {
  const point = [value, clamp(opacity, 0, 1)];
  const points = [...tf.opacity, point].sort(byValue);
  if (!isReadable(points)) return { tf, index: nearest(tf.opacity, value) };
  return { tf: { ...tf, opacity: points }, index: points.indexOf(point) };
}

export function removePoint(tf, index) {
  return tf.opacity.length > 1 ? { ...tf, opacity: tf.opacity.filter((_, n) => n !== index) } : tf;
}

export function moveStop(tf, index, value) {
  const low = index > 0 ? tf.color[index - 1][0] : -Infinity;
  const high = index < tf.color.length - 1 ? tf.color[index + 1][0] : Infinity;
  const color = tf.color.map((c, n) => (n === index ? [clamp(value, low, high), ...c.slice(1)] : c));
  return isReadable(color) ? { ...tf, color } : tf;
}

export function recolorStop(tf, index, color) {
  return { ...tf, color: tf.color.map((c, n) => (n === index ? [c[0], ...color] : c)) };
}

export function addStop(tf, value) {
  const stop = [value, ...colorAt(tf, value)];
  const color = [...tf.color, stop].sort(byValue);
  if (!isReadable(color)) return { tf, index: nearest(tf.color, value) };
  return { tf: { ...tf, color }, index: color.indexOf(stop) };
}

export function removeStop(tf, index) {
  return tf.color.length > 1 ? { ...tf, color: tf.color.filter((_, n) => n !== index) } : tf;
}

// Returns the function with a colormap's colours. rows: the colormap's rows for values from 0 to 1,
// which are stretched over a range.
export function withColormap(tf, rows, [low, high]) {
  return { ...tf, color: rows.map(([at, ...rgb]) => [low + at * (high - low), ...rgb]) };
}

// Returns the name of the colormap whose colours a function has, over any range; "": no colormap
// has these colours.
export function colormapOf(tf, colormaps) {
  const [low, high] = [tf.color[0]?.[0], tf.color.at(-1)?.[0]], isNear = (a, b) => Math.abs(a - b) < 1e-9;
  const has = (rows) => rows.length === tf.color.length && rows.every(([at, ...rgb], n) =>
    Math.abs(low + ((at - rows[0][0]) / (rows.at(-1)[0] - rows[0][0])) * (high - low) - tf.color[n][0]) <= 1e-6 * (high - low) && rgb.every((c, k) => isNear(c, tf.color[n][k + 1])));
  return Object.keys(colormaps).find((name) => has(colormaps[name])) ?? "";
}

// Returns the function with the same colours and opacities over another range.
export function stretched(tf, [from, to], [low, high]) {
  const moved = ([value, ...rest]) => [low + ((value - from) / (to - from)) * (high - low), ...rest];
  return { ...tf, opacity: tf.opacity.map(moved), color: tf.color.map(moved) };
}

// Returns the range from the least to the greatest value of all opacity points and colours.
export function rangeOf(tf) {
  const values = [...tf.opacity, ...tf.color].map((p) => p[0]);
  return [Math.min(...values), Math.max(...values)];
}

// Interpolates rows [value, number, ...] at a value: linearly between rows, and constant beyond the first
// and the last row.
export function interpolate(rows, value) {
  if (rows.length === 0) return [];
  if (value <= rows[0][0]) return rows[0].slice(1);
  for (let n = 1; n < rows.length; n++) {
    if (value > rows[n][0]) continue;
    const [a, b] = [rows[n - 1], rows[n]], t = b[0] > a[0] ? (value - a[0]) / (b[0] - a[0]) : 1;
    return a.slice(1).map((x, k) => x + t * (b[k + 1] - x));
  }
  return rows[rows.length - 1].slice(1);
}

export const colorAt = (tf, value) => interpolate(tf.color, value);
export const opacityAt = (tf, value) => interpolate(tf.opacity, value)[0] ?? 0;
