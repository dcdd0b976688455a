// The panel of looks: what the program makes of the volume by name, each with a small picture.

import { section } from "./controls.js";
import { gallery } from "./gallery.js";

const same = (a, b) => JSON.stringify(a) === JSON.stringify(b);
const PROJECTION = "mip"; // the look that is no surface and no medium: its greys are a preset

// What a look says of a scene.
const seen = ({ camera: _, lights: __, sky: ___, ambient: ____, image: _____, ...rest }) => rest;

export function lookPanel(viewer) {
  const { store, start, channel } = viewer, { element, body } = section("Looks");
  const names = start.looks ?? [], isOf = () => names.length > 0 && store.scene.volumes.length > 0 && store.scene.volumes.every((volume) => !volume.labels);
  const looks = gallery({
    label: "Looks", names, viewer, lane: "-looks", made: (look) => channel.completeScene(look === PROJECTION ? { ...store.scene, volumes: store.scene.volumes.map((volume) => ({ ...volume, transfer_function: { preset: PROJECTION } })) } : store.scene, { look }),
    isTaken: (scene) => same(seen(scene), seen(store.scene)),
    take: (name, made) => store.change(`look ${name}`, ({ camera, image: { width, height } }) => ({ ...made, camera, image: { ...made.image, width, height } })),
  });
  viewer.atRest.push(looks.atRest);
  element.addEventListener("toggle", looks.atRest);
  body.append(looks.element);
  function update() {
    element.hidden = !isOf();
    looks.update();
  }
  update();
  return { element, update };
}
