// Boxes of volumes: the box of a volume's voxels in its file's coordinates, clipped or not, and the
// corners of a box in the scene's world.

import { add, rotate, normalize, scale, subtract } from "./vector.js";

// Returns the box { min, max } of a volume of start.json. The box reaches half a voxel beyond the
// centres of the outermost voxels.
export function worldBox({ origin, axes, dimensions }) {
  const box = { min: [...origin], max: [...origin] };
  for (let row = 0; row < 3; row++)
    for (let axis = 0; axis < 3; axis++) {
      const step = axes[axis][row], ends = [-0.5 * step, (dimensions[axis] - 0.5) * step];
      box.min[row] += Math.min(...ends);
      box.max[row] += Math.max(...ends);
    }
  return box;
}

// Maps a point from a volume's file to the scene: the point is scaled, turned and moved.
export function placed(point, transform = {}) {
  const factor = transform.scale ?? 1, { axis = [0, 0, 1], angle_deg: angle = 0 } = transform.rotate ?? {};
  const scaled = point.map((x, k) => x * (Array.isArray(factor) ? factor[k] : factor));
  return add(rotate(scaled, normalize(axis), (angle * Math.PI) / 180), transform.translate ?? [0, 0, 0]);
}

// Maps a point from the scene to the volume's file: the inverse of placed().
export function unplaced(point, transform = {}) {
  const factor = transform.scale ?? 1, { axis = [0, 0, 1], angle_deg: angle = 0 } = transform.rotate ?? {};
  const turned = rotate(subtract(point, transform.translate ?? [0, 0, 0]), normalize(axis), (-angle * Math.PI) / 180);
  return turned.map((x, k) => x / (Array.isArray(factor) ? factor[k] : factor));
}

// Returns the eight corners of a box. Bit k of a corner's index is 1 if the corner has the greatest
// coordinate along axis k.
export const corners = ({ min, max }) =>
  Array.from({ length: 8 }, (_, n) => [0, 1, 2].map((k) => ((n >> k) & 1 ? max[k] : min[k])));

export const edges = [0, 1, 2].flatMap((k) =>
  Array.from({ length: 8 }, (_, n) => n).filter((n) => !((n >> k) & 1)).map((n) => [n, n | (1 << k)]));

export const middle = ({ min, max }) => scale(add(min, max), 0.5);
