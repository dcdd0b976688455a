// Keys over time, as the timeline shows them: tracks { path, points: [[frame, value], ...] }, of numbers and vectors of the scene and of
// the camera as a whole, whose path is "camera" and whose values are cameras. Every function returns a new list of tracks.

import { axes, distance, withType } from "./camera.js";
import { add, rotate, scale, subtract, turnOfFrames } from "./vector.js";

export const CAMERA = "camera";

// Paths of vectors whose three numbers have one track together. With three tracks, a direction would pass through wrong directions
// between its keys.
const VECTORS = /(^|[._])(ambient|background|albedo|color|direction|normal|axis|up|position|target|translate|center|point|edge1|edge2)$/;

// Returns the value at a path of a scene: a number, a vector, or a value that can have no track.
export const valueAt = (scene, path) => path.split(".").reduce((at, key) => at?.[key], scene);

// Returns the scene with another value at a path.
export function withValue(scene, path, value) {
  const [key, ...rest] = path.split("."), copy = Array.isArray(scene) ? [...scene] : { ...scene };
  copy[key] = rest.length > 0 ? withValue(copy[key], rest.join("."), value) : value;
  return copy;
}

// Returns the path of the track of a number: the vector's path if the number belongs to a vector,
// else the number's path.
export function trackOf(scene, path) {
  const whole = path.replace(/\.[012]$/, "");
  return VECTORS.test(whole) && isVector(valueAt(scene, whole)) ? whole : path;
}

// Returns the displayed name of a track: "light 1, intensity" for lights.0.intensity, "volume 1, clip min x" for
// volumes.0.clip.min.0.
export function trackName(path) {
  const [kind, number, ...rest] = path.split("."), isOne = ["lights", "volumes", "meshes"].includes(kind) && rest.length > 0;
  const words = (isOne ? rest : path.split(".")).map((word, n, all) => (n === all.length - 1 && /^[012]$/.test(word) ? "xyz"[word] : word.replaceAll("_", " ").replace(/ deg$/, "")));
  return isOne ? `${kind.slice(0, -1).replace("meshe", "mesh")} ${+number + 1}, ${words.join(" ")}` : words.join(" ");
}
export const MOST_FRAMES = 100000, MOST_FPS = 240;
export const FORMATS = [["mp4", "MP4"], ["webm", "WebM"], ["gif", "GIF"], ["zip", "Pictures"]];
// Angle between two successive keys of a turning camera. At this angle, the middle of the chord is
// 0.14 % nearer to the target than the arc.
const STEP = Math.PI / 30;
const ZOOM_STEP = 0.1; // greatest step, between two keys, of the logarithm of the camera's distance
const DIGITS = 7; // digits of numbers between keys

const byFrame = (a, b) => a[0] - b[0];

// Sets a key at a frame. If the frame already has a key, the key gets the new value.
export function withKey(tracks, path, frame, value) {
  const point = [frame, value], before = tracks.find((track) => track.path === path);
  if (!before) return [...tracks, { path, points: [point] }];
  const points = [...before.points.filter(([at]) => at !== frame), point].sort(byFrame);
  return tracks.map((track) => (track === before ? { path, points } : track));
}

// Removes a key. A track without keys is removed, too.
export function withoutKey(tracks, path, frame) {
  return tracks.map((track) => (track.path === path ? { path, points: track.points.filter(([at]) => at !== frame) } : track))
    .filter((track) => track.points.length > 0);
}

// Moves a key to another frame. The key replaces any key at that frame.
export function withMovedKey(tracks, path, from, to) {
  const value = tracks.find((track) => track.path === path).points.find(([at]) => at === from)[1];
  return withKey(withoutKey(tracks, path, from), path, to, value);
}

// Returns the tracks of a film that is made longer or shorter. Each key keeps its fraction of the film's length. If several keys come
// to the same frame, the last of them stays.
export function stretched(tracks, before, frames) {
  const to = (frame) => Math.round((frame * (frames - 1)) / Math.max(before - 1, 1));
  return tracks.map(({ path, points }) => ({ path, points: [...new Map(points.map(([frame, value]) => [to(frame), value]))] }));
}

const isVector = (value) => Array.isArray(value) && value.length === 3 && value.every(Number.isFinite);
const isCamera = (value) => typeof value === "object" && value !== null && ["position", "target", "up"].every((key) => isVector(value[key])) &&
  Number.isFinite(value.type === "orthographic" ? value.height : value.fovy_deg);
export const isKeyable = (value) => Number.isFinite(value) || isVector(value);
const isTrack = (track) => typeof track?.path === "string" && Array.isArray(track.points) && track.points.length > 0 &&
  track.points.every((point, n, all) => Array.isArray(point) && Number.isInteger(point[0]) && point[0] >= 0 && (n === 0 || point[0] > all[n - 1][0]) &&
    (track.path === CAMERA ? isCamera(point[1]) : isKeyable(point[1]) && Array.isArray(point[1]) === Array.isArray(all[0][1])));

// Returns the value at a frame of a track of numbers.
function numberBetween(points, frame) {
  const next = points.findIndex(([at]) => at >= frame);
  if (next <= 0) return points.at(next)[1];
  const [[from, a], [to, b]] = points.slice(next - 1, next + 1);
  return a + ((b - a) * (frame - from)) / (to - from);
}

// Films of earlier versions have a track for each number of a vector. These three tracks become one
// track.
export function joined(tracks, scene) {
  return tracks.flatMap((track) => {
    const { path } = track, whole = trackOf(scene, path), parts = [0, 1, 2].map((k) => tracks.find((one) => one.path === `${whole}.${k}`));
    if (whole === path || parts.includes(undefined) || tracks.some((one) => one.path === whole)) return [track];
    const frames = [...new Set(parts.flatMap(({ points }) => points.map(([frame]) => frame)))].sort((a, b) => a - b);
    return track === parts[0] ? [{ path: whole, points: frames.map((frame) => [frame, parts.map(({ points }) => numberBetween(points, frame))]) }] : [];
  });
}

// Returns the valid parts of a film from a file: numbers that lie within their bounds, and valid tracks. from: { camera, image }, the view
// from which a film turns.
export function readFilm(object) {
  const { frames, fps, frame, turns, open, format, tracks, from } = object ?? {};
  const within = (value, low, high) => Number.isInteger(value) && value >= low && value <= high;
  return {
    ...(within(frames, 2, MOST_FRAMES) ? { frames } : {}), ...(within(fps, 1, MOST_FPS) ? { fps } : {}),
    ...(within(frame, 0, (within(frames, 2, MOST_FRAMES) ? frames : 2) - 1) ? { frame } : {}),
    ...(FORMATS.some(([name]) => name === format) ? { format } : {}), turns: turns === true, open: open === true,
    tracks: Array.isArray(tracks) ? tracks.filter(isTrack) : [], ...(isCamera(from?.camera) && from.image?.width > 0 && from.image.height > 0 ? { from } : {}),
  };
}

// Returns the camera on the way from camera a to camera b. The camera turns about its target at an even
// speed. part: the fraction of the way, from 0 to 1.
export function cameraBetween(a, b, part) {
  const [from, to] = [a, b].map((camera) => { const { right, up, towards } = axes(camera); return [right, up, towards]; });
  const { axis, angle } = turnOfFrames(from, to), turned = (vector) => rotate(vector, axis, part * angle);
  const mixed = (x, y) => x + part * (y - x), far = distance(a) * (distance(b) / distance(a)) ** part;
  const target = add(a.target, scale(subtract(b.target, a.target), part));
  return {
    ...a, target, position: add(target, scale(turned(from[2]), far)), up: turned(from[1]),
    ...(a.type === "orthographic" ? { height: a.height * (b.height / a.height) ** part } : { fovy_deg: mixed(a.fovy_deg, b.fovy_deg) }),
  };
}

const cameraParts = ({ type }) => ["position", "target", "up", type === "orthographic" ? "height" : "fovy_deg"];
const keyText = (path, points) => `${path}=${points.map(([frame, value]) => `${frame}:${value}`).join(",")}`;

// Returns the frames and cameras of a camera's track, with additional cameras so close to each other
// that straight lines between them follow the arc.
function cameraPoints(points, type) {
  const keys = points.map(([frame, camera]) => [frame, withType(camera, type)]);
  return keys.flatMap(([frame, camera], n) => {
    if (n === 0) return [[frame, camera, true]];
    const [begin, before] = keys[n - 1], span = frame - begin;
    const turn = turnOfFrames(...[before, camera].map((c) => { const { right, up, towards } = axes(c); return [right, up, towards]; })).angle;
    const steps = Math.min(span, Math.max(1, Math.ceil(turn / STEP), Math.ceil(Math.abs(Math.log(distance(camera) / distance(before))) / ZOOM_STEP)));
    const between = Array.from({ length: steps - 1 }, (_, s) => begin + Math.round(((s + 1) * span) / steps));
    return [...between.map((at) => [at, cameraBetween(before, camera, (at - begin) / span), false]), [frame, camera, true]];
  });
}

// Returns the keys as `halflight animate` takes them. type: the projection type of the scene's
// camera.
export function keyTexts(tracks, type) {
  return tracks.flatMap(({ path, points }) => {
    if (path !== CAMERA) return [keyText(path, points)];
    const cameras = cameraPoints(points, type), rounded = (value) => [value].flat().map((x) => +x.toPrecision(DIGITS));
    return cameraParts(withType(points[0][1], type)).map((part) => keyText(`camera.${part}`, cameras.map(([frame, camera, exact]) => [frame, exact ? camera[part] : rounded(camera[part])])));
  });
}
