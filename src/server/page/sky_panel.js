// The panel of the sky: none, even, from ground to zenith, or the scene's own image.

import { hexOf, linearOf } from "./color.js";
import { color, section, segments, select, slider, toggle } from "./controls.js";
import { COLORS, STRENGTH, hasUp } from "./sky.js";

const SIDES = [0, 1, 2].flatMap((axis) => [1, -1].map((sign) => [`${sign > 0 ? "+" : "−"}${"xyz"[axis]}`, [0, 1, 2].map((k) => (k === axis ? sign : 0))]));
const sideOf = (up) => SIDES.find(([, axis]) => axis.every((x, k) => Math.abs(x - up[k]) < 1e-9))?.[0] ?? "";

export function skyPanel({ store, start, overlay }) {
  const { element, body } = section("Sky", false);
  const sky = () => store.scene.sky;
  const change = (name, part) => store.change(`sky ${name}`, (scene) => ({ ...scene, sky: { ...scene.sky, ...part } }));
  const kept = { ...COLORS }; // keys that only one kind has are kept, so that they come back with this kind
  if (start.scene.sky?.type === "image") kept.image = { file: start.scene.sky.file, rotation_deg: 0 };

  function ofKind(before, type) {
    const { strength = STRENGTH, hemisphere = false, up = start.scene.camera.up, type: was, ...own } = before ?? {};
    if (was !== undefined) kept[was] = own;
    return { type, ...kept[type], up, hemisphere, strength };
  }
  const setKind = (type) => store.change("sky kind", ({ sky: before, ...scene }) =>
    (type === "none" ? scene : { ...scene, sky: ofKind(before, type) }));

  const kind = segments({
    label: "Kind", choices: [["none", "None"], ["uniform", "Even"], ["gradient", "Gradient"], ...(kept.image ? [["image", "Image"]] : [])],
    get: () => sky()?.type ?? "none", set: setKind,
  });
  const shade = (key, label, type) => ({
    type, ...color({ label, get: () => hexOf(sky()[key]), set: (hex) => change(key, { [key]: linearOf(hex) }) }),
  });
  const colors = [shade("color", "Sky", "uniform"), shade("zenith", "Zenith", "gradient"), shade("horizon", "Horizon", "gradient"), shade("ground", "Ground", "gradient")];
  const strength = slider({
    label: "Strength", path: () => "sky.strength", low: 0, high: 3, get: () => sky().strength ?? 1, set: (value) => change("strength", { strength: value }),
  });
  const rotation = slider({
    label: "Rotation", path: () => "sky.rotation_deg", low: -180, high: 180, unit: "°", title: "About up, counterclockwise as seen from above",
    get: () => sky().rotation_deg ?? 0, set: (value) => change("rotation", { rotation_deg: value }),
  });
  const hemisphere = toggle({ label: "Dark below the horizon", get: () => sky().hemisphere === true, set: (on) => change("hemisphere", { hemisphere: on }) });
  const suns = toggle({ label: "Suns are lights", get: () => sky().suns !== false, set: (on) => change("suns", { suns: on }) });
  const up = select({
    label: "Up", choices: [["", "own"], ...SIDES.map(([name]) => [name, name])], title: "Where the zenith is",
    get: () => sideOf(sky().up ?? [0, 0, 1]), set: (name) => name && change("up", { up: SIDES.find(([side]) => side === name)[1] }),
  });
  body.append(kind.element, ...[...colors, strength, rotation, suns, hemisphere, up].map((part) => part.element));
  element.addEventListener("toggle", () => { overlay.showsSky = element.open; });

  function update() {
    kind.update();
    for (const part of colors) part.element.hidden = sky()?.type !== part.type;
    strength.element.hidden = hemisphere.element.hidden = sky() === undefined;
    rotation.element.hidden = suns.element.hidden = sky()?.type !== "image";
    up.element.hidden = !hasUp(sky());
    for (const part of [...colors, strength, rotation, suns, hemisphere, up]) if (!part.element.hidden) part.update();
  }
  update();
  return { element, update };
}
