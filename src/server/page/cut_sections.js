// Draws where cuts and clip boxes cut a slice. The part of the slice that is removed is dimmed, and a line follows the border of that
// part.
//
// A plane's samples lie in the space of a cut by an affine map, so that the section of a half space, a box or a sphere with the plane is a
// convex polygon in columns and rows.

import { unplaced } from "./boxes.js";
import { samplePoint } from "./sections.js";
import { add, dot, scale, subtract } from "./vector.js";

const CORNERS = 128; // number of corners of the polygon that stands for the section of a sphere
const DIM = "#000000b0", LINE = "#ff7a66";
const WIDTH = 2; // pixels of the line, which lies on the side that is left

// Returns the cuts of volume v of a scene, [{ cut, transform }]. transform: the volume's transform if the cut is given
// in the coordinates of the volume's file.
export function cutsOf(scene, v) {
  const { clip, cuts = [], transform } = scene.volumes[v];
  return [
    ...(clip ? [{ cut: { type: "box", ...clip, keep: "inside" }, transform }] : []),
    ...cuts.map((cut) => ({ cut, transform: cut.world ? {} : transform })),
    ...(scene.cuts ?? []).map((cut) => ({ cut, transform: {} })),
  ];
}

// Returns the part of a convex polygon in which from + across * column + down * row is at most 0.
function clipped(polygon, [from, across, down]) {
  const height = ([column, row]) => from + across * column + down * row;
  return polygon.flatMap((corner, n) => {
    const next = polygon[(n + 1) % polygon.length], [a, b] = [height(corner), height(next)];
    const crossing = a <= 0 !== b <= 0 ? [corner.map((x, k) => x + (a / (a - b)) * (next[k] - x))] : [];
    return [...(a <= 0 ? [corner] : []), ...crossing];
  });
}

// Returns the ellipse in which a sphere meets the plane, in columns and rows. Derived: with p = from + across x + down y,
// the nearest point to the centre solves the normal equations of the metric G = [across, down]^T [across, down], and
// around it (x, y) G (x, y)^T = radius^2 - height^2, with Cholesky's factor of G.
function ellipse({ center, radius }, { from, across, down }) {
  const [a, b, c] = [dot(across, across), dot(across, down), dot(down, down)], away = subtract(from, center), whole = a * c - b * b;
  const [p, q] = [-dot(across, away), -dot(down, away)], x = (c * p - b * q) / whole, y = (a * q - b * p) / whole;
  const lowest = add(away, add(scale(across, x), scale(down, y))), left = radius * radius - dot(lowest, lowest);
  if (!(left > 0)) return [];
  const size = Math.sqrt(left), first = Math.sqrt(a), second = Math.sqrt(whole / a);
  return Array.from({ length: CORNERS }, (_, n) => {
    const angle = (2 * Math.PI * n) / CORNERS, v = (size * Math.sin(angle)) / second;
    return [x + (size * Math.cos(angle) - (b / first) * v) / first, y + v];
  });
}

// Returns the part of a rectangle of the plane that lies inside a cut. The second argument { from, across, down } maps
// columns and rows to the cut's space.
function insideOf(cut, { from, across, down }, rectangle) {
  const half = (normal, level) => [dot(from, normal) - level, dot(across, normal), dot(down, normal)];
  if (cut.type === "sphere") return ellipse(cut, { from, across, down });
  // The inside of a plane is the side to which its normal points.
  if (cut.type === "plane") return clipped(rectangle, half(scale(cut.normal, -1), -dot(cut.point, cut.normal)));
  return [0, 1, 2].reduce((polygon, k) => {
    const normal = [0, 1, 2].map((n) => (n === k ? 1 : 0));
    return clipped(clipped(polygon, half(normal, cut.max[k])), half(scale(normal, -1), -cut.min[k]));
  }, rectangle);
}

// Returns the sections of cuts with a plane, [{ inside, keepsInside }]. inside: a polygon in columns and rows, which may reach beyond the
// plane's samples. cuts: the result of cutsOf(). source: { grid, transform } of the volume that the plane's samples are taken from.
export function sectionsOf(cuts, plane, source) {
  const { width, height } = plane, rectangle = [[-width, -height], [2 * width, -height], [2 * width, 2 * height], [-width, 2 * height]];
  return cuts.map(({ cut, transform }) => {
    const at = (column, row) => unplaced(samplePoint(plane, source, column, row), transform), from = at(0, 0);
    return { inside: insideOf(cut, { from, across: subtract(at(1, 0), from), down: subtract(at(0, 1), from) }, rectangle), keepsInside: cut.keep === "inside" };
  });
}

// Draws the sections over the picture of a plane. context: the drawing context of the plane's canvas. fit: { x, y, left, top } as in
// slice_view.js. frame: [left, top, width, height] of the plane's samples. fit and frame are in pixels of the canvas.
export function drawSections(context, sections, fit, frame, density) {
  if (sections.length === 0) return;
  const { width, height } = context.canvas, [removed, lines] = [0, 1].map(() => Object.assign(document.createElement("canvas"), { width, height }).getContext("2d"));
  const trace = (to, polygon) => {
    polygon.forEach(([column, row], n) => to[n > 0 ? "lineTo" : "moveTo"](fit.left + column * fit.x, fit.top + row * fit.y));
    if (polygon.length > 0) to.closePath();
  };
  lines.strokeStyle = LINE;
  lines.lineWidth = 2 * WIDTH * density;
  for (const { inside, keepsInside } of sections) {
    removed.beginPath();
    if (keepsInside) removed.rect(0, 0, width, height);
    trace(removed, inside);
    removed.fill("evenodd");
    lines.beginPath();
    trace(lines, inside);
    lines.stroke();
  }
  // The parts of the lines that lie inside a removed part are erased.
  lines.globalCompositeOperation = "destination-out";
  lines.drawImage(removed.canvas, 0, 0);
  removed.globalCompositeOperation = "source-in";
  removed.fillStyle = DIM;
  removed.fillRect(0, 0, width, height);
  context.save();
  context.beginPath();
  context.rect(...frame);
  context.clip();
  context.drawImage(removed.canvas, 0, 0);
  context.drawImage(lines.canvas, 0, 0);
  context.restore();
}
