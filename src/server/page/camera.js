// The camera of a scene: functions that turn, pan, zoom and roll the camera, and that project points of the
// world onto the screen. Every function takes the camera of the scene's JSON. A function that moves the
// camera returns a new camera.

import { add, cross, dot, length, normalize, rotate, scale, subtract } from "./vector.js";

const LARGEST_STEP = 1.5; // greatest change of the distance by one zoom, as a factor
const FARTHEST = 5e4; // greatest distance of the eye from its target, in units of its least distance: some thousand times the size of the scene's matter

// Returns the camera's unit axes: right, up, and towards the viewer.
export function axes(camera) {
  const towards = normalize(subtract(camera.position, camera.target));
  let right = cross(camera.up, towards);
  if (length(right) < 1e-9) right = cross(Math.abs(towards[1]) < 0.9 ? [0, 1, 0] : [1, 0, 0], towards);
  right = normalize(right);
  return { right, up: cross(towards, right), towards };
}

export const distance = (camera) => length(subtract(camera.position, camera.target));

// Returns the height of the picture at the target, in units of the world.
export function worldHeight(camera) {
  if (camera.type === "orthographic") return camera.height;
  return 2 * distance(camera) * Math.tan((camera.fovy_deg * Math.PI) / 360);
}

// Turns the camera as VTK's trackball does: the eye moves about the target by two angles, to the right
// and up, and the camera's up vector turns with the eye.
export function turn(camera, azimuth, elevation) {
  const { right, up } = axes(camera);
  const arm = subtract(camera.position, camera.target);
  const about = (a) => rotate(rotate(a, up, azimuth), rotate(right, up, azimuth), -elevation);
  return { ...camera, position: add(camera.target, about(arm)), up: normalize(about(up)) };
}

export function roll(camera, angle) {
  const { up, towards } = axes(camera);
  return { ...camera, up: normalize(rotate(up, towards, angle)) };
}

// Pans by fractions of the picture's height. With positive numbers the picture moves right and up.
export function pan(camera, right, up) {
  const frame = axes(camera), height = worldHeight(camera);
  const move = add(scale(frame.right, -right * height), scale(frame.up, -up * height));
  return { ...camera, position: add(camera.position, move), target: add(camera.target, move) };
}

// Zooms; with factor > 1 the eye comes nearer. The point of the target's plane under the cursor keeps its place in
// the picture. cursor: [right, up] from the picture's middle, in fractions of the picture's height. If the eye is
// at the distance `nearest` from the target, zooming in moves the eye and the target forwards together. At the
// distance FARTHEST, zooming out leaves the eye where it is.
export function zoom(camera, factor, cursor = [0, 0], nearest = 0) {
  const step = Math.min(Math.max(factor, 1 / LARGEST_STEP), LARGEST_STEP);
  const part = 1 - 1 / step;
  if (step < 1 && nearest > 0 && worldHeight(camera) > FARTHEST * nearest) return camera;
  const moved = pan(camera, -cursor[0] * part, -cursor[1] * part);
  const arm = subtract(moved.position, moved.target);
  if (camera.type === "orthographic") return { ...moved, height: camera.height / step };
  const ahead = scale(arm, -part), position = add(moved.position, ahead);
  return { ...moved, position, ...(step > 1 && length(arm) / step < nearest ? { target: add(moved.target, ahead) } : {}) };
}

// Makes the camera look along an axis of the world, from the axis's positive or negative end. The target
// and the distance stay as they are.
export function lookAlong(camera, axis, sign) {
  const towards = [0, 0, 0];
  towards[axis] = sign;
  const up = axis === 2 ? [0, 1, 0] : [0, 0, 1];
  return { ...camera, position: add(camera.target, scale(towards, distance(camera))), up };
}

// The camera for a picture of another shape, { width, height }. The contents of the largest square in
// the middle of the old picture fill the largest square in the middle of the new picture.
export function reshaped(camera, from, to) {
  const share = ({ width, height }) => Math.min(1, width / height);
  const factor = share(from) / share(to);
  if (factor === 1) return camera;
  if (camera.type === "orthographic") return { ...camera, height: camera.height * factor };
  return { ...camera, position: add(camera.target, scale(subtract(camera.position, camera.target), factor)) };
}

// Returns a camera at `eye` that looks in `direction`, with the fraction `part` of the picture's
// height in view.
export function along(camera, eye, direction, part) {
  const moved = { ...camera, position: eye, target: add(eye, scale(direction, distance(camera))) };
  if (camera.type === "orthographic") return { ...moved, height: camera.height * part };
  return { ...moved, fovy_deg: (360 / Math.PI) * Math.atan(Math.tan((camera.fovy_deg * Math.PI) / 360) * part) };
}

// Returns the camera with the projection `type`. The height of the picture at the target stays the
// same.
export function withType(camera, type) {
  const { position, target, up } = camera, height = worldHeight(camera);
  if (type === camera.type) return camera;
  if (type === "orthographic") return { type, position, target, up, height };
  const fovy = 30, arm = height / (2 * Math.tan((fovy * Math.PI) / 360));
  const { towards } = axes(camera);
  return { type, position: add(target, scale(towards, arm)), target, up, fovy_deg: fovy };
}

// Returns a function that maps points of the world to [x, y] in a picture of this size. The function
// returns null for points behind the eye.
export function projector(camera, width, height) {
  const frame = axes(camera), tall = worldHeight(camera), far = distance(camera);
  return (point) => {
    const from = subtract(point, camera.target);
    const depth = far - dot(from, frame.towards);
    if (camera.type !== "orthographic" && depth <= far * 1e-3) return null;
    const size = camera.type === "orthographic" ? tall : (tall * depth) / far;
    return [width / 2 + (dot(from, frame.right) / size) * height, height / 2 - (dot(from, frame.up) / size) * height];
  };
}
