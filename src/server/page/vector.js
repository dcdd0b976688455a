// Vectors of three numbers, and rotations.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a) => Math.hypot(a[0], a[1], a[2]);
export const cross = (a, b) => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];

export function normalize(a) {
  const size = length(a);
  return size > 0 ? scale(a, 1 / size) : [0, 0, 1];
}

// Returns the vector a, turned about a unit axis by an angle, counter-clockwise as seen from the
// axis's tip (Rodrigues' formula).
export function rotate(a, axis, angle) {
  const cosine = Math.cos(angle), sine = Math.sin(angle);
  return add(add(scale(a, cosine), scale(cross(axis, a), sine)), scale(axis, dot(axis, a) * (1 - cosine)));
}

// Returns the turn { axis, angle } that takes three perpendicular unit vectors to three others. The turn follows from the
// quaternion of the turn's matrix.
export function turnOfFrames(from, to) {
  const entry = (row, column) => from.reduce((sum, axis, n) => sum + to[n][row] * axis[column], 0);
  const w = Math.sqrt(Math.max(0, 1 + entry(0, 0) + entry(1, 1) + entry(2, 2))) / 2;
  let axis = [entry(2, 1) - entry(1, 2), entry(0, 2) - entry(2, 0), entry(1, 0) - entry(0, 1)];
  // The quaternion's axis vanishes for no turn and for half a turn; the axis then follows from the
  // matrix's diagonal.
  if (length(axis) < 1e-9) axis = [0, 1, 2].map((k) => Math.sqrt(Math.max(0, (1 + entry(k, k)) / 2)));
  return { axis: normalize(axis), angle: 2 * Math.acos(Math.min(w, 1)) };
}

// Returns the shortest turn that takes the unit vector `from` to the unit vector `to`, as a
// function of vectors.
export function turnBetween(from, to) {
  let axis = cross(from, to);
  const angle = Math.atan2(length(axis), dot(from, to));
  if (length(axis) < 1e-12) axis = Math.abs(from[0]) < 0.9 ? cross(from, [1, 0, 0]) : cross(from, [0, 1, 0]);
  axis = normalize(axis);
  return (a) => rotate(a, axis, angle);
}

// Returns a vector whose components are 0 where they are only rounding errors of lengths near
// `size`, for numbers that people read.
export const withoutErrors = (a, size) => a.map((x) => (Math.abs(x) < 1e-9 * size ? 0 : x));
