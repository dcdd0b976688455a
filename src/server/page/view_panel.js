// The panel of the view: projection, sides to look from, background, exposure, tone.

import { lookAlong, withType } from "./camera.js";
import { hexOf, linearOf } from "./color.js";
import { button, color, make, row, section, segments, slider } from "./controls.js";

export function viewPanel({ store, frameEverything, firstView }) {
  const { element, body } = section("View", false);
  const look = (axis, sign) => store.setCamera(lookAlong(store.scene.camera, axis, sign));
  const sides = make("span", { class: "buttons" }, ...[0, 1, 2].flatMap((axis) => [1, -1].map((sign) =>
    button(`${sign > 0 ? "+" : "−"}${"xyz"[axis]}`, () => look(axis, sign), { "aria-label": `Look from ${sign > 0 ? "plus" : "minus"} ${"xyz"[axis]}` }))));
  const projection = segments({
    label: "Projection", choices: [["perspective", "Perspective"], ["orthographic", "Parallel"]],
    get: () => store.scene.camera.type, set: (type) => store.setCamera(withType(store.scene.camera, type)),
  });
  const background = color({
    label: "Background", get: () => hexOf(store.scene.image.background),
    set: (hex) => store.change("background", (scene) => ({ ...scene, image: { ...scene.image, background: linearOf(hex) } })),
  });
  const exposure = slider({
    label: "Exposure", path: () => "image.exposure", low: -4, high: 4, unit: "stops", get: () => store.scene.image.exposure ?? 0,
    set: (stops) => store.change("exposure", (scene) => ({ ...scene, image: { ...scene.image, exposure: Math.abs(stops) < 0.03 ? 0 : stops } })),
  });
  const tone = segments({
    label: "Tone", choices: [["clip", "Clip"], ["filmic", "Filmic"]], get: () => store.scene.image.tone ?? "clip",
    set: (name) => store.change("tone", (scene) => ({ ...scene, image: { ...scene.image, tone: name } })),
  });
  body.append(row(make("span", { class: "name" }, "From"), sides),
    row("", make("span", { class: "buttons" }, button("show all", frameEverything), button("first view", firstView))), projection.element, background.element, exposure.element,
    tone.element);
  const update = () => { for (const part of [projection, background, exposure, tone]) part.update(); };
  update();
  return { element, update, updateView: () => projection.update() };
}
