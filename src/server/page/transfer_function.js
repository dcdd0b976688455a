// A transfer function as the scene has it, { unit_distance, opacity: [[value, opacity], ...], color: [[value, r, g,
// b], ...] }, and the changes that its editor makes. Every function returns a new one.

const byValue = (a, b) => a[0] - b[0];
const clamp = (x, low, high) => Math.min(Math.max(x, low), high);

// Two rows at one value make a step. A third row there would mean nothing, and the scene's reader refuses it.
const isReadable = (rows) => rows.every((row, n) => n < 2 || row[0] !== rows[n - 2][0]);
const nearest = (rows, value) => rows.reduce((best, row, n) => (Math.abs(row[0] - value) < Math.abs(rows[best][0] - value) ? n : best), 0);

// Whether a volume's function takes two numbers, so that it has boxes instead of points.
// Whether a scene is a maximum projection, which shows no surfaces and goes by one number.
export const isProjection = (scene) => scene.render?.compositing === "maximum";
export const isPlane = (volume) => volume?.transfer_function?.second !== undefined;

// Opacity points at one value, as at a step, keep their order. The first and the last point may go as far as
// `range`, or stay beyond it where their neighbours are.
export function movePoint(tf, index, value, opacity, range) {
  const before = tf.opacity[index - 1]?.[0] ?? Math.min(range[0], tf.opacity[index][0]);
  const after = tf.opacity[index + 1]?.[0] ?? Math.max(range[1], tf.opacity[index][0]);
  const point = [clamp(value, before, after), clamp(opacity, 0, 1)];
  const points = tf.opacity.map((p, n) => (n === index ? point : p));
  return isReadable(points) ? { ...tf, opacity: points } : tf;
}

// { tf, index }: the function with a new point, and the point's index.
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

// The named colormap's rows of values from 0 to 1, stretched over a range.
export function withColormap(tf, rows, [low, high]) {
  return { ...tf, color: rows.map(([at, ...rgb]) => [low + at * (high - low), ...rgb]) };
}

// The name of the colormap whose colours a function has, over any range; "": none.
export function colormapOf(tf, colormaps) {
  const [low, high] = [tf.color[0]?.[0], tf.color.at(-1)?.[0]], isNear = (a, b) => Math.abs(a - b) < 1e-9;
  const has = (rows) => rows.length === tf.color.length && rows.every(([at, ...rgb], n) =>
    Math.abs(low + ((at - rows[0][0]) / (rows.at(-1)[0] - rows[0][0])) * (high - low) - tf.color[n][0]) <= 1e-6 * (high - low) && rgb.every((c, k) => isNear(c, tf.color[n][k + 1])));
  return Object.keys(colormaps).find((name) => has(colormaps[name])) ?? "";
}

// The same colours and opacities over another range.
export function stretched(tf, [from, to], [low, high]) {
  const moved = ([value, ...rest]) => [low + ((value - from) / (to - from)) * (high - low), ...rest];
  return { ...tf, opacity: tf.opacity.map(moved), color: tf.color.map(moved) };
}

// The range from the first to the last value at which a point or a colour stands.
export function rangeOf(tf) {
  const values = [...tf.opacity, ...tf.color].map((p) => p[0]);
  return [Math.min(...values), Math.max(...values)];
}

// The row at a value, of rows [value, number, ...], which are piecewise linear and constant beyond the ends.
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
