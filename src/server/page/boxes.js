// Boxes of volumes: the boxes of their voxels' cells in the world of their files, clipped or not, and the
// boxes' corners in the scene's world.

import { add, rotate, normalize, scale, subtract } from "./vector.js";

// { min, max } of a volume of start.json, half a voxel around its voxels' centres.
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

// A point of a volume's file in the scene: scaled, turned, moved.
export function placed(point, transform = {}) {
  const factor = transform.scale ?? 1, { axis = [0, 0, 1], angle_deg: angle = 0 } = transform.rotate ?? {};
  const scaled = point.map((x, k) => x * (Array.isArray(factor) ? factor[k] : factor));
  return add(rotate(scaled, normalize(axis), (angle * Math.PI) / 180), transform.translate ?? [0, 0, 0]);
}

// The opposite: a point of the scene in the volume's file.
export function unplaced(point, transform = {}) {
  const factor = transform.scale ?? 1, { axis = [0, 0, 1], angle_deg: angle = 0 } = transform.rotate ?? {};
  const turned = rotate(subtract(point, transform.translate ?? [0, 0, 0]), normalize(axis), (-angle * Math.PI) / 180);
  return turned.map((x, k) => x / (Array.isArray(factor) ? factor[k] : factor));
}

// The eight corners. Bit k of a corner's number says whether it has the least or the greatest coordinate of
// axis k.
export const corners = ({ min, max }) =>
  Array.from({ length: 8 }, (_, n) => [0, 1, 2].map((k) => ((n >> k) & 1 ? max[k] : min[k])));

export const edges = [0, 1, 2].flatMap((k) =>
  Array.from({ length: 8 }, (_, n) => n).filter((n) => !((n >> k) & 1)).map((n) => [n, n | (1 << k)]));

export const middle = ({ min, max }) => scale(add(min, max), 0.5);
