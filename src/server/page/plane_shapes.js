// Boxes and polygons of a transfer function of two numbers: functions that find the part of a shape under
// the pointer, and that change shapes. Coordinates are [x, y], either in pixels of the canvas or in the
// function's two numbers.

const AXES = ["value", "second"];
export const isPolygon = (shape) => shape.vertices !== undefined;
export const apexOf = ({ vertices, apex }) => apex ?? [0, 1].map((axis) => vertices.reduce((sum, vertex) => sum + vertex[axis], 0) / vertices.length);

const cross = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

// Returns whether all points of a polygon's border can be reached from the apex by straight lines
// inside the polygon.
export function apexSees(polygon) {
  const apex = apexOf(polygon), turns = polygon.vertices.map((vertex, n, all) => cross(apex, vertex, all[(n + 1) % all.length]));
  return turns.every((turn) => turn > 0) || turns.every((turn) => turn < 0);
}

function isInside(vertices, at) {
  let inside = false;
  vertices.forEach((a, n) => {
    const b = vertices[(n + 1) % vertices.length];
    if (a[1] > at[1] !== b[1] > at[1] && at[0] < a[0] + ((b[0] - a[0]) * (at[1] - a[1])) / (b[1] - a[1])) inside = !inside;
  });
  return inside;
}

// Returns the index of the first vertex of the polygon's side that is within reach of a place; -1:
// no side is within reach.
function sideAt(vertices, at, reach) {
  return vertices.findIndex((a, n) => {
    const b = vertices[(n + 1) % vertices.length], length = distance(a, b) || 1;
    const along = ((at[0] - a[0]) * (b[0] - a[0]) + (at[1] - a[1]) * (b[1] - a[1])) / length;
    return along >= 0 && along <= length && Math.abs(cross(a, b, at)) / length <= reach;
  });
}

// Returns the part of a shape at a place. The part of a box is { ends }: for each axis, the end that is
// grabbed, 0 or 1; null: neither end. The part of a polygon is { vertex }, { apex }, { side }, or {} for
// the inside. Null: the shape does not lie at this place.
export function partAt(shape, at, reach) {
  if (!isPolygon(shape)) {
    const pairs = AXES.map((key) => shape[key]);
    if (!pairs.every((pair, axis) => at[axis] > Math.min(...pair) - reach && at[axis] < Math.max(...pair) + reach)) return null;
    return { ends: pairs.map((pair, axis) => {
      const far = pair.map((pixel) => Math.abs(pixel - at[axis]));
      return Math.min(...far) > reach ? null : far[0] <= far[1] ? 0 : 1;
    }) };
  }
  const vertex = shape.vertices.findIndex((one) => distance(one, at) <= reach), side = sideAt(shape.vertices, at, reach / 2);
  if (vertex >= 0) return { vertex };
  if (distance(apexOf(shape), at) <= reach) return { apex: true };
  if (side >= 0) return { side };
  return isInside(shape.vertices, at) ? {} : null;
}

// Returns the settings of a shape after its part was moved by `by`. The ends of a box stay at least
// `least` apart. A polygon's apex stays at a point from which straight lines inside the polygon reach the
// whole border.
export function moved(shape, part, by, least) {
  const shifted = (place) => place.map((number, axis) => number + by[axis]);
  if (isPolygon(shape)) {
    if (part.vertex === undefined && !part.apex) return { vertices: shape.vertices.map(shifted), apex: shifted(apexOf(shape)) };
    const changed = part.apex ? { apex: shifted(apexOf(shape)) } : { vertices: shape.vertices.map((one, n) => (n === part.vertex ? shifted(one) : one)) };
    return apexSees({ ...shape, ...changed }) ? changed : {};
  }
  const whole = part.ends.every((end) => end === null);
  return Object.fromEntries(AXES.map((key, axis) => {
    const [low, high] = shape[key];
    if (whole) return [key, [low + by[axis], high + by[axis]]];
    if (part.ends[axis] === 0) return [key, [Math.min(low + by[axis], high - least[axis]), high]];
    return [key, part.ends[axis] === 1 ? [low, Math.max(high + by[axis], low + least[axis])] : [low, high]];
  }));
}

// Returns a polygon's vertices with one more vertex after vertex n: at the place `at`, or in the middle of
// the side.
export function withVertex({ vertices }, n, at) {
  const next = vertices[(n + 1) % vertices.length];
  return [...vertices.slice(0, n + 1), at ?? vertices[n].map((number, axis) => (number + next[axis]) / 2), ...vertices.slice(n + 1)];
}

// Returns a polygon's vertices without vertex n. Null: the polygon has only three vertices, or the apex
// would not see the whole border any more.
export function withoutVertex(polygon, n) {
  const vertices = polygon.vertices.filter((_, index) => index !== n);
  return vertices.length >= 3 && apexSees({ ...polygon, vertices }) ? vertices : null;
}
