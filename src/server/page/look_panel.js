// The panel of looks: the program's looks for the volume by name, each with a small picture.

import { section } from "./controls.js";
import { gallery } from "./gallery.js";
import { difference } from "./link.js";

const PROJECTION = "mip"; // the look of a maximum projection; its greys are a preset of the transfer function

// Returns the scene without isosurfaces and meshes, which a maximum projection cannot show.
const projected = ({ meshes: _, ...scene }) => ({ ...scene, volumes: scene.volumes.map(({ iso: __, ...volume }) => (volume.labels ? volume : { ...volume, transfer_function: { preset: PROJECTION } })) });

// Returns the parts of a scene that a look sets: all but the camera, the lights, the sky and the
// picture's size.
const seen = ({ camera: _, lights: __, sky: ___, ambient: ____, image: _____, ...rest }) => rest;

export function lookPanel(viewer) {
  const { store, start, channel } = viewer, { element, body } = section("Looks");
  const names = start.looks ?? [], isOf = () => names.length > 0 && store.scene.volumes.some((volume) => !volume.labels);
  const looks = gallery({
    label: "Looks", names, viewer, made: (look) => channel.completeScene(look === PROJECTION ? projected(store.scene) : store.scene, { look }),
    seen, isTaken: (scene) => difference(seen(scene), seen(store.scene)) === undefined,
    take: (name, made) => store.change(`look ${name}`, ({ camera, image: { width, height } }) => ({ ...made, camera, image: { ...made.image, width, height } })),
  });
  viewer.atRest.push(looks.atRest);
  element.addEventListener("toggle", looks.atRest);
  body.append(looks.element, viewer.comparison.compareButton());
  function update() {
    element.hidden = !isOf();
    looks.update();
  }
  update();
  return { element, update };
}
