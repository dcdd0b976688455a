// The sky of a scene: light from all directions. Its kinds, and its axes as src/scene/sky.c has them.

import { cross, dot, normalize, rotate, scale, subtract } from "./vector.js";

const ALONG_X = 0.99; // the cosine from which on `up` is too near to x to measure angles from there

// The settings with which a sky of a kind begins, beside the settings of all kinds.
export const COLORS = {
  uniform: { color: [1, 1, 1] },
  gradient: { zenith: [0.8, 0.9, 1], horizon: [1, 1, 1], ground: [0.3, 0.27, 0.24] },
};
export const STRENGTH = 0.5; // strength of a sky that is added: beside lights, a full sky would be too bright

// Whether the sky depends on the direction of up.
export const hasUp = (sky) => sky !== undefined && (sky.type !== "uniform" || sky.hemisphere === true);

// Unit axes: up, and on the horizon towards the image's middle column and a quarter to the right of it.
export function skyAxes(sky) {
  const up = normalize(sky.up ?? [0, 0, 1]), from = Math.abs(up[0]) < ALONG_X ? [1, 0, 0] : [0, 1, 0];
  const right = normalize(subtract(from, scale(up, dot(from, up)))), middle = cross(up, right);
  const turn = (axis) => rotate(axis, up, ((sky.rotation_deg ?? 0) * Math.PI) / 180);
  return { up, right: turn(right), middle: turn(middle) };
}
