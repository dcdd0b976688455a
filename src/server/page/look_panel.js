// The panel of looks: the program's looks for the volume by name, each with a small picture.

import { section } from "./controls.js";
import { gallery } from "./gallery.js";
import { difference } from "./link.js";

const PROJECTION = "mip"; // the look that is no surface and no medium: its greys are a preset

// The scene that a maximum projection can show: without isosurfaces and meshes.
const projected = ({ meshes: _, ...scene }) => ({ ...scene, volumes: scene.volumes.map(({ iso: __, ...volume }) => (volume.labels ? volume : { ...volume, transfer_function: { preset: PROJECTION } })) });

// What makes a look of a scene, whichever its view and light.
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
