// Finds the point of the scene that a pixel of the picture shows: the point on the pixel's ray at which the opacity has
// reached half of the ray's whole opacity.
//
// The program tells the depth at which a ray's opacity reaches 1 %. The depth of the scene is therefore requested twice,
// with a tiny picture around the pixel's ray. The first answer tells the whole opacity A of the ray. For the second
// request, all matter is made so thin that the ray's opacity reaches 1 % where it was A / 2 before. Thinning by a factor f
// turns each transmittance T into T^f (Beer and Lambert), so f = ln(0.99) / ln(1 - A / 2) (derived).

import { along, axes, worldHeight } from "./camera.js";
import { add, scale, subtract, normalize } from "./vector.js";

const SIDE = 15; // pixels; an odd number, so that one pixel is in the middle
const FIRST = 0.01; // the opacity whose depth the program tells

const thinner = (opacity, f) => 1 - (1 - Math.min(opacity, 1)) ** f;

function thinned(scene, f) {
  const surfaces = (list) => list.map((one) => ({ ...one, opacity: thinner(one.opacity ?? 1, f) }));
  const volumes = scene.volumes.map((volume) => ({
    ...volume,
    ...(volume.transfer_function?.unit_distance ? { transfer_function: { ...volume.transfer_function, unit_distance: volume.transfer_function.unit_distance / f } } : {}),
    ...(volume.labels ? { labels: surfaces(volume.labels) } : {}), ...(volume.iso ? { iso: surfaces(volume.iso) } : {}),
  }));
  return { ...scene, volumes, ...(scene.meshes ? { meshes: surfaces(scene.meshes) } : {}) };
}

// Returns the scene without lights, with a tiny picture whose middle pixel is the pixel at [x, y] of a picture of
// width x height.
function rayScene({ sky: _, ...scene }, [x, y], width, height) {
  const camera = scene.camera, { right, up, towards } = axes(camera), tall = worldHeight(camera);
  const offset = add(scale(right, ((x - width / 2) / height) * tall), scale(up, ((height / 2 - y) / height) * tall));
  const parallel = camera.type === "orthographic", eye = parallel ? add(camera.position, offset) : camera.position;
  const direction = parallel ? scale(towards, -1) : normalize(subtract(add(camera.target, offset), camera.position));
  const { exposure: _e, tone: _t, ...image } = scene.image;
  const narrow = {
    ...scene, camera: along(camera, eye, direction, SIDE / height), lights: [], image: { ...image, width: SIDE, height: SIDE },
    render: { ...scene.render, shadows: "off" },
  };
  return { scene: narrow, eye, direction };
}

// place: [x, y], in pixels of a picture of width x height. Resolves to the point of the scene; null: the pixel shows nothing.
export async function pick(channel, whole, place, width, height) {
  const { scene, eye, direction } = rayScene(whole, place, width, height);
  const seen = await channel.depth(scene);
  if (seen === null || seen.depth === null || !(seen.opacity > 0)) return null;
  const f = Math.log(1 - FIRST) / Math.log(1 - Math.min(seen.opacity, 1) / 2);
  const middle = f < 1 ? await channel.depth(thinned(scene, f)) : seen;
  return add(eye, scale(direction, middle?.depth ?? seen.depth));
}
