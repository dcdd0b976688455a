// The panels of lights and shadows.

import { hexOf, linearOf } from "./color.js";
import { color, keyButton, make, row, section, segments, select, slider, tabs, toggle } from "./controls.js";
import { gallery } from "./gallery.js";
import { LARGEST_SIZE, newLight, placesOf, sizeOf, withOtherFrame, withSize } from "./light.js";

// Returns a light's colour, scaled so that its brightest channel is 1. The light's intensity then tells
// its strength.
const shown = (light) => light.color.map((c) => c / Math.max(...light.color, 1e-9));

// Makes the gallery of rigs. A rig is a set of lights and a sky with a name. Each rig is derived from the
// lights with which the viewer began, so that all rigs are equally bright.
function rigsOf(viewer) {
  const { store, start, channel, atRest } = viewer, { lights, sky, ambient } = start.scene;
  const told = (scene) => JSON.stringify([scene.lights, scene.sky]);
  const rigs = gallery({
    label: "Light rigs", names: start.rigs ?? [], viewer, made: (rig) => channel.completeScene({ ...store.scene, lights, ...(sky ? { sky } : {}), ...(ambient ? { ambient } : {}) }, { rig }),
    seen: ({ camera: _, image: __, ...rest }) => rest, // small pictures of rigs are not made anew when the view changes, because all of them together take seconds of processor time
    isTaken: (scene) => told(scene) === told(store.scene),
    take: (name, made) => store.change(`rig ${name}`, (scene) => ({ ...scene, lights: made.lights, sky: made.sky, ambient: made.ambient })),
  });
  atRest.push(rigs.atRest);
  return rigs;
}

export function lightPanel(viewer) {
  const { store, current, overlay } = viewer;
  const { element, body } = section("Lights");
  const light = () => store.scene.lights[current.light];
  const change = (name, set) => store.changeLight(current.light, name, set);
  const choose = (index) => current.choose("light", index);
  const add = () => {
    store.change("add light", (scene) => ({ ...scene, lights: [...scene.lights, newLight()] }));
    choose(store.scene.lights.length - 1);
  };
  const remove = () => {
    const index = current.light;
    store.change("remove light", (scene) => ({ ...scene, lights: scene.lights.filter((_, l) => l !== index) }));
    choose(Math.max(0, index - 1));
  };
  const list = tabs({ label: "Lights", noun: "light", count: () => store.scene.lights.length, chosen: () => current.light, choose, add, remove });
  const handles = toggle({
    label: "Handles in the picture", get: () => overlay.showsLights, set: (on) => { overlay.showsLights = on; },
  });
  const rows = [
    slider({
      label: "Intensity", low: 0, high: 4, path: () => `lights.${current.light}.intensity`, get: () => light().intensity ?? 1,
      set: (intensity) => change("intensity", (l) => ({ ...l, intensity })),
    }),
    slider({
      label: "Size", low: 0, high: LARGEST_SIZE, unit: "°", path: () => `lights.${current.light}.${light().type === "directional" ? "angular_diameter_deg" : "radius"}`, title: "How wide the light is: wider lights cast softer shadows",
      get: () => sizeOf(light(), store.scene.camera),
      set: (degrees) => change("size", (l) => withSize(l, store.scene.camera, degrees)),
    }),
    color({
      label: "Colour", get: () => hexOf(shown(light())),
      set: (hex) => change("color", (l) => ({ ...l, color: linearOf(hex) })),
    }),
    toggle({
      label: "Casts shadows", get: () => light().shadows !== "off",
      set: (on) => change("shadows", ({ shadows, ...l }) => (on ? l : { ...l, shadows: "off" })),
    }),
    toggle({
      label: "Goes with the camera", get: () => light().frame === "camera",
      set: () => change("frame", (l) => withOtherFrame(l, store.scene.camera)),
    }),
  ];
  const own = make("div", {}, ...rows.map((r) => r.element));
  const ambient = slider({
    label: "Ambient", low: 0, high: 1, path: () => "ambient", get: () => Math.max(...(store.scene.ambient ?? [0.2, 0.2, 0.2])),
    set: (level) => store.change("ambient", (scene) => ({ ...scene, ambient: [level, level, level] })),
  });
  const rigs = rigsOf(viewer), place = row(make("span", { class: "name" }, "Place"), make("span", { class: "facts" }, "drag it in the picture"), keyButton("the light's place", () => placesOf(light(), current.light)));
  place.classList.add("place");
  own.append(place);
  element.addEventListener("toggle", rigs.atRest);
  body.append(rigs.element, viewer.comparison.compareButton(), list.element, handles.element, own, ambient.element);
  function update() {
    list.update();
    handles.update();
    ambient.update();
    rigs.update();
    own.hidden = light() === undefined;
    if (light() !== undefined) rows.forEach((r) => r.update());
  }
  update();
  return { element, update };
}

export function shadowPanel(viewer) {
  const { store } = viewer;
  const { element, body } = section("Shadows");
  const render = () => store.scene.render;
  const kind = segments({
    label: "Shadows", choices: [["off", "Off"], ["hard", "Hard"], ["soft", "Soft"]],
    get: () => render().shadows, set: (value) => store.changeRender("shadows", value),
  });
  const method = select({
    label: "Method", choices: [["cascade", "cascade (default)"], ["sublights", "sub-lights (exact with many)"], ["paper", "as published"]],
    get: () => render().soft_method, set: (value) => store.changeRender("soft_method", value),
  });
  const samples = slider({
    label: "Sub-lights", low: 1, high: 16, step: 1, get: () => render().light_samples ?? 4, title: "So many along each side of a light",
    set: (count) => store.changeRender("light_samples", Math.round(count)),
  });
  const spacing = slider({
    label: "Step", path: () => "render.sheet_spacing", low: 0.25, high: 4, exponential: true, unit: "voxels", title: "How far apart the final picture takes samples (its sheets): closer is finer and slower",
    get: () => render().sheet_spacing, set: (value) => store.changeRender("sheet_spacing", +value.toPrecision(3)),
  });
  const edges = slider({
    label: "Smooth edges", low: 1, high: 4, step: 1, title: "The final picture takes this many samples along each side of a pixel, in as many times the time, squared: edges of cut faces become smooth",
    get: () => Math.max(render().pixel_samples ?? 0, 1), set: (count) => store.changeRender("pixel_samples", count > 1 ? Math.round(count) : 0),
  });
  body.append(kind.element, ...viewer.comparison.elements, method.element, samples.element, spacing.element, edges.element);
  function update() {
    for (const part of [kind, method, samples, spacing, edges, viewer.comparison]) part.update();
    method.element.hidden = render().shadows !== "soft";
    samples.element.hidden = method.element.hidden || render().soft_method !== "sublights";
  }
  update();
  return { element, update };
}
