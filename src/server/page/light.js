// A light of the scene: functions that return and change a light's direction as the camera sees it, and a
// light's apparent size.
//
// A light's positions and directions are in world coordinates or, with "frame": "camera", in the camera's axes
// about the camera's target. A light of any type is moved by a turn about the target. A light's size is an
// angle in degrees, as seen from the target.

import { axes } from "./camera.js";
import { add, dot, length, normalize, scale, subtract, turnBetween } from "./vector.js";

const radians = Math.PI / 180;
export const LARGEST_SIZE = 60; // degrees
const SWEEP = 120 * radians;

const isInCamera = (light) => light.frame === "camera";
const pivot = (light, camera) => (isInCamera(light) ? [0, 0, 0] : camera.target);

function center(light) {
  if (light.type !== "polygon") return light.position;
  return scale(light.vertices.reduce(add), 1 / light.vertices.length);
}

function toCamera(vector, camera) {
  const { right, up, towards } = axes(camera);
  return [dot(vector, right), dot(vector, up), dot(vector, towards)];
}

function toWorld(vector, camera) {
  const { right, up, towards } = axes(camera);
  return add(add(scale(right, vector[0]), scale(up, vector[1])), scale(towards, vector[2]));
}

// Returns the vector from the target to the light, in the axes that the light uses. The vector need
// not have unit length.
function arm(light, camera) {
  return light.type === "directional" ? scale(light.direction, -1) : subtract(center(light), pivot(light, camera));
}

// Returns the unit direction from the target to the light, as components to the right, up, and towards
// the viewer.
export function directionOf(light, camera) {
  const towards = normalize(arm(light, camera));
  return isInCamera(light) ? towards : toCamera(towards, camera);
}

// Returns the light, moved to another direction, which is given in the camera's axes.
export function withDirection(light, camera, direction) {
  const wanted = isInCamera(light) ? normalize(direction) : toWorld(normalize(direction), camera);
  const turn = turnBetween(normalize(arm(light, camera)), wanted), about = pivot(light, camera);
  const point = (p) => add(about, turn(subtract(p, about)));
  const moved = { ...light };
  for (const key of ["direction", "normal", "edge1", "edge2"]) if (light[key]) moved[key] = turn(light[key]);
  if (light.position) moved.position = point(light.position);
  if (light.vertices) moved.vertices = light.vertices.map(point);
  return moved;
}

// Turns a direction, in directionOf()'s components, to the right by dx steps and up by dy steps.
// degrees: the size of a step.
export function steppedDirection([right, up, towards], dx, dy, degrees) {
  const azimuth = Math.atan2(right, towards) + dx * degrees * radians;
  const elevation = Math.min(Math.max(Math.asin(Math.min(Math.max(up, -1), 1)) + dy * degrees * radians, -1.55), 1.55);
  return [Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation), Math.cos(elevation) * Math.cos(azimuth)];
}

// Returns the scene with its first shadow-casting light on its way from the left behind to its place. part:
// the fraction of the way, from 0 to 1.
export function sweptLight(scene, part) {
  const index = scene.lights.findIndex((light) => light.shadows !== "off");
  if (index < 0) return scene;
  const { camera } = scene, [right, up, towards] = directionOf(scene.lights[index], camera), left = SWEEP * (1 - part) ** 3;
  const turned = [right * Math.cos(left) - towards * Math.sin(left), up, towards * Math.cos(left) + right * Math.sin(left)];
  return { ...scene, lights: scene.lights.map((light, l) => (l === index ? withDirection(light, camera, turned) : light)) };
}

// Returns half of the light's width.
function reach(light) {
  if (light.type === "rect") return Math.max(length(light.edge1), length(light.edge2)) / 2;
  if (light.type === "polygon") return Math.max(...light.vertices.map((v) => length(subtract(v, center(light)))));
  return light.radius ?? 0;
}

// Returns the light's width in degrees, as seen from the target.
export function sizeOf(light, camera) {
  if (light.type === "directional") return light.angular_diameter_deg ?? 0;
  return (2 * Math.atan2(reach(light), length(arm(light, camera)))) / radians;
}

export function withSize(light, camera, degrees) {
  const size = Math.min(Math.max(degrees, 0), LARGEST_SIZE);
  if (light.type === "directional") return { ...light, angular_diameter_deg: size };
  const radius = length(arm(light, camera)) * Math.tan((size * radians) / 2), before = reach(light);
  if ("radius" in light || light.type === "point" || light.type === "spot") return { ...light, radius };
  const factor = Math.max(radius, before * 1e-3) / before;
  if (light.type === "rect")
    return { ...light, edge1: scale(light.edge1, factor), edge2: scale(light.edge2, factor) };
  const middle = center(light);
  return { ...light, vertices: light.vertices.map((v) => add(middle, scale(subtract(v, middle), factor))) };
}

// Returns the light with its coordinates in the other axes, the camera's or the world's. The light
// keeps its present position and brightness.
export function withOtherFrame(light, camera) {
  const was = isInCamera(light), turn = (v) => (was ? toWorld(v, camera) : toCamera(v, camera));
  const point = (p) => (was ? add(camera.target, turn(p)) : turn(subtract(p, camera.target)));
  const { frame: _, ...changed } = light;
  for (const key of ["direction", "normal", "edge1", "edge2"]) if (light[key]) changed[key] = turn(light[key]);
  if (light.position) changed.position = point(light.position);
  if (light.vertices) changed.vertices = light.vertices.map(point);
  return was ? changed : { ...changed, frame: "camera" };
}

// Makes a new directional light that shines from the upper right.
export const newLight = () => ({
  type: "directional", frame: "camera", direction: normalize([-0.6, -0.6, -0.5]),
  angular_diameter_deg: 7, color: [1, 1, 1], intensity: 0.8,
});

// Returns the paths of the settings of a light that say where the light is.
export const placesOf = (light, index) => ["direction", "normal", "edge1", "edge2", "position"].filter((key) => light[key]).map((key) => `lights.${index}.${key}`);
