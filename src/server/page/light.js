// A light of the scene: where it stands as the camera sees it, how large it looks, and how both change.
//
// A light's places and directions are in the world, or, with "frame": "camera", in the camera's axes about its
// target. All kinds are moved by turning them about the target, and resized as seen from there, in degrees.

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

// The vector from the target to the light in the light's own axes; it need not have unit length.
function arm(light, camera) {
  return light.type === "directional" ? scale(light.direction, -1) : subtract(center(light), pivot(light, camera));
}

// The unit direction from the target to the light: components to the right, up, and towards the viewer.
export function directionOf(light, camera) {
  const towards = normalize(arm(light, camera));
  return isInCamera(light) ? towards : toCamera(towards, camera);
}

// The light in another direction, given in the camera's axes.
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

// A direction as from directionOf(), turned to the right and up by a number of steps of some degrees.
export function steppedDirection([right, up, towards], dx, dy, degrees) {
  const azimuth = Math.atan2(right, towards) + dx * degrees * radians;
  const elevation = Math.min(Math.max(Math.asin(Math.min(Math.max(up, -1), 1)) + dy * degrees * radians, -1.55), 1.55);
  return [Math.cos(elevation) * Math.sin(azimuth), Math.sin(elevation), Math.cos(elevation) * Math.cos(azimuth)];
}

// The scene with its first light that casts shadows on its way to its place, from behind the left; part: from
// 0 to 1.
export function sweptLight(scene, part) {
  const index = scene.lights.findIndex((light) => light.shadows !== "off");
  if (index < 0) return scene;
  const { camera } = scene, [right, up, towards] = directionOf(scene.lights[index], camera), left = SWEEP * (1 - part) ** 3;
  const turned = [right * Math.cos(left) - towards * Math.sin(left), up, towards * Math.cos(left) + right * Math.sin(left)];
  return { ...scene, lights: scene.lights.map((light, l) => (l === index ? withDirection(light, camera, turned) : light)) };
}

// Half of the light's width.
function reach(light) {
  if (light.type === "rect") return Math.max(length(light.edge1), length(light.edge2)) / 2;
  if (light.type === "polygon") return Math.max(...light.vertices.map((v) => length(subtract(v, center(light)))));
  return light.radius ?? 0;
}

// The light's width in degrees, seen from the target.
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

// The light in the other axes; it keeps its present place and brightness.
export function withOtherFrame(light, camera) {
  const was = isInCamera(light), turn = (v) => (was ? toWorld(v, camera) : toCamera(v, camera));
  const point = (p) => (was ? add(camera.target, turn(p)) : turn(subtract(p, camera.target)));
  const { frame: _, ...changed } = light;
  for (const key of ["direction", "normal", "edge1", "edge2"]) if (light[key]) changed[key] = turn(light[key]);
  if (light.position) changed.position = point(light.position);
  if (light.vertices) changed.vertices = light.vertices.map(point);
  return was ? changed : { ...changed, frame: "camera" };
}

// A new light from the upper right.
export const newLight = () => ({
  type: "directional", frame: "camera", direction: normalize([-0.6, -0.6, -0.5]),
  angular_diameter_deg: 7, color: [1, 1, 1], intensity: 0.8,
});

// The paths in a scene of what says where a light is.
export const placesOf = (light, index) => ["direction", "normal", "edge1", "edge2", "position"].filter((key) => light[key]).map((key) => `lights.${index}.${key}`);
