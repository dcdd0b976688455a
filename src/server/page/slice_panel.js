// The panel of slices: layout, the crosshair's numbers, window and level, thickness, and overlays.

import { unplaced } from "./boxes.js";
import { button, isActive, make, row, section, segments, select, shortNumber, slider, toggle } from "./controls.js";
import { anatomical, isAnatomical, pointAt, planeTitle, PLANES } from "./sections.js";
import { DRAGS, LAYOUTS } from "./slices.js";
import { lengthUnit } from "./units.js";
import { length, withoutErrors } from "./vector.js";

const BLENDS = [["maximum", "Maximum"], ["mean", "Mean"], ["minimum", "Minimum"]];

// Returns a value as a text with just enough digits for the text to be read back as the same float, or as the
// same double if the value is no float.
function exact(value) {
  if (Number.isNaN(value)) return "no value";
  const same = (other) => other === value || (Math.fround(value) === value && Math.fround(other) === value);
  for (let digits = 1; digits < 17; digits++) if (same(+value.toPrecision(digits))) return String(+value.toPrecision(digits));
  return String(value);
}

export function slicePanel(viewer) {
  const { store, slices } = viewer, { element, body } = section("Slices", false);
  element.hidden = !slices.available;
  if (element.hidden) return { element, update: () => {} };
  const layout = segments({ label: "Layout", choices: LAYOUTS, get: () => slices.layout, set: (name) => store.setPage({ layout: name }) });
  const plane = select({
    label: "Plane", choices: [...PLANES, "oblique"].map((name) => [name, planeTitle(name, slices.source.grid)]), get: () => slices.plane,
    set: (name) => store.setPage({ plane: name, ...(name === "oblique" ? { oblique: null } : {}) }), title: "The one beside the picture; the oblique one lies as the picture does",
  });
  const follows = toggle({ label: "Follows the picture", get: () => !store.page.oblique, set: (on) => store.setPage({ oblique: on ? null : store.scene.camera }) });

  const drag = segments({ label: "Drag", choices: DRAGS, get: () => store.page.drag ?? "cursor", set: (name) => store.setPage({ drag: name }) });

  const number = (label, get, set) => {
    const input = make("input", { type: "number", step: "any", "aria-label": label, onchange: () => {
      if (input.value !== "" && Number.isFinite(+input.value)) set(+input.value);
      update();
    } });
    return { input, update: () => { if (!isActive(input)) input.value = +get().toPrecision(4); } };
  };
  const index = [0, 1, 2].map((axis) => number(`Voxel along ${"ijk"[axis]}`, () => slices.readout?.voxel[axis] ?? 0, (value) => {
    const voxel = [...(slices.readout?.voxel ?? [0, 0, 0])];
    voxel[axis] = Math.round(value);
    slices.moveTo(pointAt(slices.source.grid, slices.source.transform, voxel));
  }));
  const ends = () => slices.window, setWidth = (width, level) => { if (width > 0) slices.window = [level - width / 2, level + width / 2]; };
  const width = number("Window", () => ends()[1] - ends()[0], (value) => setWidth(value, (ends()[0] + ends()[1]) / 2));
  const level = number("Level", () => (ends()[0] + ends()[1]) / 2, (value) => setWidth(ends()[1] - ends()[0], value));
  const finest = () => Math.min(...slices.source.grid.axes.map((axis) => Math.hypot(...axis)));
  const thickness = slider({
    label: "Thickness", low: 0, high: 200 * finest(), step: finest(), unit: lengthUnit(viewer), title: "Of a slab around each plane, of which one value shows; 0: the plane alone",
    get: () => slices.thickness, set: (value) => store.setPage({ thickness: value }),
  });
  const blend = select({ label: "Slab shows", choices: BLENDS, get: () => slices.blend, set: (name) => store.setPage({ blend: name }) });
  const labels = toggle({ label: "Labels", get: () => store.page.showLabels ?? true, set: (on) => store.setPage({ showLabels: on }) });
  const lines = toggle({ label: "Isolines of the isosurfaces", get: () => store.page.showIsolines ?? true, set: (on) => store.setPage({ showIsolines: on }) });

  const place = make("output", { class: "facts", "aria-live": "off" }), value = make("output", { class: "value", "aria-label": "Value at the crosshair", "aria-live": "polite" });
  function tell() {
    const { readout, source } = slices;
    if (readout === null || slices.layout === "picture") return;
    const { grid, transform } = source, point = withoutErrors(unplaced(slices.cursor, transform), length(grid.axes[0]) * grid.dimensions[0]);
    value.textContent = readout.inside ? [exact(readout.value), ...readout.labels].join(" · ") : "beside the volume";
    const own = `x ${shortNumber(point[0])} y ${shortNumber(point[1])} z ${shortNumber(point[2])}`;
    place.replaceChildren(...(isAnatomical(grid) ? [`${anatomical(grid, point)} `, make("span", { class: "whole" }, `(${own})`)] : [own]));
    index.forEach((one) => one.update());
  }
  slices.onReadout = tell;

  body.append(layout.element, plane.element, follows.element, drag.element,
    row(make("span", { class: "name" }, "Value"), value), row(make("span", { class: "name" }, "Place"), place),
    row(make("span", { class: "name" }, "Voxel"), make("span", { class: "numbers" }, ...index.map((one) => one.input))),
    row(make("span", { class: "name" }, "Window"), make("span", { class: "pair" }, width.input, "level", level.input, button("auto", () => { slices.window = null; }, { title: "Window and level as at first" }))),
    thickness.element, blend.element, labels.element, lines.element,
    make("p", { class: "facts" }, "Click or tap in a slice or in the picture to move the crosshair. By mouse, too: right drag for window and level, shift + drag to pan, wheel through the slices. Two fingers zoom and pan."));
  function update() {
    const hides = slices.layout === "picture", shows = (part, shown) => { part.element.hidden = !shown; };
    shows(plane, slices.layout === "beside");
    shows(follows, slices.layout === "beside" && slices.plane === "oblique");
    for (const one of [layout, plane, follows, drag, width, level, thickness, blend, labels, lines]) one.update();
    for (const rest of [...body.children].slice(3)) rest.hidden = hides;
    shows(labels, !hides && store.scene.volumes.some((volume) => volume.labels ?? volume.mask?.labels));
    shows(lines, !hides && store.scene.volumes.some((volume) => volume.iso?.length > 0));
    tell();
  }
  update();
  return { element, update, updateView: update };
}
