// Planes through a volume: the voxels that a plane shows, the plane's orientation on the screen, and the positions of its
// samples in the scene.
//
// A plane is { name, width, height, depth, origin, across, down, through, between, pitch, edges }: a grid of samples in the
// indices of the volume's voxels (http_channel.js, slice()), the lengths between samples along a row and between rows in
// the scene, and the letters at its left, right, upper and lower edge. The axial, coronal and sagittal planes follow the
// grid's axes, so that each sample is a voxel. The oblique plane is parallel to the picture.

import { placed, unplaced } from "./boxes.js";
import { axes } from "./camera.js";
import { add, cross, dot, length, scale, subtract } from "./vector.js";

const LARGEST = 1024; // the most samples along a side of an oblique plane
const MOST_LAYERS = 1023;
const OPPOSITE = { L: "R", R: "L", A: "P", P: "A", S: "I", I: "S" };

// The directions that run across and down on the screen, by the plane's name: letters of a body, in the orientation that
// radiologists use, or signed axes.
const ANATOMICAL = { axial: ["L", "P"], coronal: ["L", "I"], sagittal: ["P", "I"] };
const OF_AXES = { axial: ["+x", "-y"], coronal: ["+x", "-z"], sagittal: ["+y", "-z"] };
export const PLANES = ["axial", "coronal", "sagittal"];

export const isAnatomical = (grid) => ["RAS", "LPS", "LAS"].includes(grid?.space);

// Returns the title of a plane of a volume.
export function planeTitle(name, grid) {
  if (name === "oblique") return "Oblique";
  return isAnatomical(grid) ? name[0].toUpperCase() + name.slice(1) : { axial: "xy", coronal: "xz", sagittal: "yz" }[name];
}

// ---- places ----

// A grid is { dimensions, origin, axes, space } as in start.json. transform: places the grid's volume in the
// scene.
export const pointAt = (grid, transform, index) =>
  placed(grid.axes.reduce((point, step, a) => add(point, scale(step, index[a])), grid.origin), transform);

// Returns the grid indices of a point of the scene, which need not be integers.
export function indexAt(grid, transform, point) {
  const from = subtract(unplaced(point, transform), grid.origin), [a, b, c] = grid.axes, volume = dot(a, cross(b, c));
  return [dot(from, cross(b, c)) / volume, dot(from, cross(c, a)) / volume, dot(from, cross(a, b)) / volume];
}

export const voxelAt = (grid, transform, point) => indexAt(grid, transform, point).map((x) => Math.floor(x + 0.5));
export const holds = (grid, index) => index.every((x, a) => x >= -0.5 && x < grid.dimensions[a] - 0.5);

// Returns a point of the volume's file as a text in anatomical directions, "R 12.1 A 3.0 S 40.5".
export function anatomical(grid, point) {
  return point.map((x, k) => {
    const letter = grid.space[k];
    return `${x < 0 ? OPPOSITE[letter] : letter} ${Math.abs(x).toFixed(1)}`;
  }).join(" ");
}

// ---- planes along the grid's axes ----

// Returns, for each axis of the world, the grid axis whose direction is nearest to it.
function axisOfWorld(grid) {
  const left = new Set([0, 1, 2]), found = [];
  const pairs = [0, 1, 2].flatMap((a) => [0, 1, 2].map((w) => ({ a, w, share: Math.abs(grid.axes[a][w]) / length(grid.axes[a]) })));
  for (const { a, w } of pairs.sort((one, other) => other.share - one.share))
    if (left.has(a) && found[w] === undefined) { found[w] = a; left.delete(a); }
  return found;
}

// Returns a direction's grid axis and sign, { axis, sign }.
function directionOf(grid, name) {
  const letters = isAnatomical(grid) ? grid.space : "xyz", sought = name.at(-1);
  const w = [...letters].findIndex((letter) => letter === sought || OPPOSITE[letter] === sought), axis = axisOfWorld(grid)[w];
  const along = name[0] === "-" || OPPOSITE[letters[w]] === sought ? -1 : 1;
  return { axis, sign: along * Math.sign(grid.axes[axis][w]) };
}

const step = (grid, transform, along) => length(subtract(placed(along, transform), placed([0, 0, 0], transform)));
const unit = (axis, sign = 1) => [0, 1, 2].map((a) => (a === axis ? sign : 0));

// Returns the number of layers that fill a thickness. The number is odd, so that the middle layer is
// the plane itself.
function layersOf(thickness, pitch) {
  const layers = Math.min(Math.max(Math.round(thickness / pitch), 1), MOST_LAYERS);
  return layers % 2 === 1 ? layers : layers + 1;
}

function gridPlane(name, { grid, transform, cursor, thickness }) {
  const [acrossName, downName] = (isAnatomical(grid) ? ANATOMICAL : OF_AXES)[name];
  const across = directionOf(grid, acrossName), down = directionOf(grid, downName), third = 3 - across.axis - down.axis;
  const at = voxelAt(grid, transform, cursor), pitches = grid.axes.map((along) => step(grid, transform, along));
  const depth = layersOf(thickness, pitches[third]), origin = [0, 0, 0];
  for (const { axis, sign } of [across, down]) origin[axis] = sign > 0 ? 0 : grid.dimensions[axis] - 1;
  origin[third] = Math.min(Math.max(at[third], 0), grid.dimensions[third] - 1) - (depth - 1) / 2;
  const ends = (word) => (isAnatomical(grid) ? [OPPOSITE[word], word] : word[0] === "+" ? ["", word[1]] : [word[1], ""]);
  const [left, right] = ends(acrossName), [upper, lower] = ends(downName);
  return {
    name, width: grid.dimensions[across.axis], height: grid.dimensions[down.axis], depth, origin,
    across: unit(across.axis, across.sign), down: unit(down.axis, down.sign), through: unit(third), between: "nearest",
    pitch: [pitches[across.axis], pitches[down.axis], pitches[third]], edges: [left, right, upper, lower],
  };
}

// ---- the plane through the crosshair that is parallel to the picture ----

function obliquePlane({ grid, transform, cursor, thickness, camera }) {
  const { right, up, towards } = axes(camera), finest = Math.min(...grid.axes.map((along) => step(grid, transform, along)));
  const corners = Array.from({ length: 8 }, (_, n) => pointAt(grid, transform, [0, 1, 2].map((a) => ((n >> a) & 1 ? grid.dimensions[a] - 1 : 0))));
  const spread = (axis) => {
    const along = corners.map((corner) => dot(subtract(corner, cursor), axis));
    return [Math.min(...along), Math.max(...along)];
  };
  const [left, rightmost] = spread(right), [lowest, highest] = spread(up);
  const pitch = Math.max(finest, Math.max(rightmost - left, highest - lowest) / LARGEST), depth = layersOf(thickness, pitch);
  const first = add(cursor, add(add(scale(right, left), scale(up, highest)), scale(towards, (-(depth - 1) / 2) * pitch)));
  const index = (point) => indexAt(grid, transform, point), origin = index(first);
  const along = (direction) => subtract(index(add(first, scale(direction, pitch))), origin);
  return {
    name: "oblique", width: Math.max(1, Math.ceil((rightmost - left) / pitch) + 1), height: Math.max(1, Math.ceil((highest - lowest) / pitch) + 1), depth, origin,
    across: along(right), down: along(scale(up, -1)), through: along(towards), between: "linear", pitch: [pitch, pitch, pitch], edges: ["", "", "", ""],
  };
}

// name: one of PLANES, or "oblique". cursor: a point of the scene through which the plane goes. thickness: a
// length of the scene. camera: the oblique plane is parallel to its picture.
export const planeOf = (name, about) => (name === "oblique" ? obliquePlane(about) : gridPlane(name, about));

// Returns a plane with the same samples, in the indices of another grid.
export function planeIn(plane, from, to) {
  const moved = (index) => indexAt(to.grid, to.transform, pointAt(from.grid, from.transform, index));
  const origin = moved(plane.origin), along = (direction) => subtract(moved(add(plane.origin, direction)), origin);
  return { ...plane, origin, across: along(plane.across), down: along(plane.down), through: along(plane.through), between: "nearest" };
}

// Returns [column, row, layer] of a point of the scene, which need not be integers. The middle
// layer is 0.
export function sampleAt(plane, { grid, transform }, point) {
  const from = subtract(indexAt(grid, transform, point), plane.origin), { across: a, down: b, through: c } = plane, volume = dot(a, cross(b, c));
  return [dot(from, cross(b, c)) / volume, dot(from, cross(c, a)) / volume, dot(from, cross(a, b)) / volume - (plane.depth - 1) / 2];
}

// Returns the point of the scene at a column and a row, `layers` layers away from the middle layer.
export function samplePoint(plane, { grid, transform }, column, row, layers = 0) {
  const middle = (plane.depth - 1) / 2 + layers;
  const index = [0, 1, 2].map((k) => plane.origin[k] + column * plane.across[k] + row * plane.down[k] + middle * plane.through[k]);
  return pointAt(grid, transform, index);
}
