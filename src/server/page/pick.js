// The place of the scene that a pixel of the picture shows: where half of what is seen there has been passed.
//
// The program tells the depth at which a ray's opacity reaches 1 %. So the scene is asked for twice, in a tiny picture
// along the pixel's ray: for the whole opacity A of the ray, and once more with all matter so thin that its opacity reaches
// 1 % where the ray's own reaches A / 2. Thinning by a factor f turns each transmittance T into T^f (Beer and Lambert), so
// f = ln(0.99) / ln(1 - A / 2) (derived).

import { along, axes, worldHeight } from "./camera.js";
import { add, scale, subtract, normalize } from "./vector.js";

const SIDE = 15; // pixels, an odd number: one is in the middle
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

// The scene without lights, in a tiny picture whose middle pixel is the one at [x, y] of a picture of width x height.
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

// [x, y]: pixels in a picture that is shown as width x height. Resolves to the point of the scene; null: nothing is seen there.
export async function pick(channel, whole, place, width, height) {
  const { scene, eye, direction } = rayScene(whole, place, width, height);
  const seen = await channel.depth(scene);
  if (seen === null || seen.depth === null || !(seen.opacity > 0)) return null;
  const f = Math.log(1 - FIRST) / Math.log(1 - Math.min(seen.opacity, 1) / 2);
  const middle = f < 1 ? await channel.depth(thinned(scene, f)) : seen;
  return add(eye, scale(direction, middle?.depth ?? seen.depth));
}
