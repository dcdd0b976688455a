// The panel of a volume's transfer function: the drawing, the numbers of the chosen point, colormaps and
// presets.

import { hexOf, linearOf } from "./color.js";
import { button, color, isActive, make, row, section, select, slider } from "./controls.js";
import { FunctionCanvas } from "./function_canvas.js";
import { smoothedLine } from "./histogram.js";
import { byGradient, planePanel } from "./plane_panel.js";
import { colormapOf, isPlane, isProjection, movePoint, moveStop, rangeOf, recolorStop, stretched, withColormap } from "./transfer_function.js";

// Makes the fields for the numbers of the point or colour that is chosen in the drawing.
function chosenPoint(canvas, get, set, range) {
  const number = (label, give, take) => make("input", {
    type: "number", step: "any", "aria-label": label,
    onchange: (event) => {
      if (event.target.value !== "") take(+event.target.value);
    },
    give,
  });
  const at = () => {
    const { kind, index } = canvas.selected, rows = kind === "point" ? get().opacity : get().color;
    return { kind, index, row: rows[index] };
  };
  const value = number("Value", null, (x) => {
    const { kind, index, row: chosen } = at();
    set(kind === "point" ? movePoint(get(), index, x, chosen[1], range) : moveStop(get(), index, x), "value");
  });
  const opacity = number("Opacity", null, (o) => {
    const { index, row: chosen } = at();
    set(movePoint(get(), index, chosen[0], o, range), "opacity");
  });
  const shade = make("input", {
    type: "color", "aria-label": "Colour", oninput: () => set(recolorStop(get(), at().index, linearOf(shade.value)), "color"),
  });
  const opacityLabel = make("label", { class: "inline" }, "opacity ", opacity);
  const shadeLabel = make("label", { class: "inline" }, "colour ", shade);
  function update() {
    const { kind, row: chosen } = at();
    if (!chosen) return;
    if (!isActive(value)) value.value = +chosen[0].toPrecision(5);
    if (kind === "point" && !isActive(opacity)) opacity.value = +chosen[1].toPrecision(3);
    if (kind === "stop") shade.value = hexOf(chosen.slice(1));
    opacityLabel.hidden = kind !== "point";
    shadeLabel.hidden = kind === "point";
  }
  return { element: make("div", { class: "row chosen" }, make("label", { class: "inline" }, "value ", value), opacityLabel, shadeLabel), update };
}

// Returns the range over which a colormap is spread: the function's own range, or the volume's
// range if all points of the function have one value.
const spread = ([low, high], range) => (high > low ? [low, high] : range);

// Makes the row of the two values between which the function's colours and opacities lie.
function rangeRow(get, set) {
  const inputs = [0, 1].map((end) => make("input", {
    type: "number", step: "any", "aria-label": end === 0 ? "Least value of the range" : "Greatest value of the range",
    onchange: (event) => {
      const before = rangeOf(get()), now = [...before];
      now[end] = +event.target.value;
      if (event.target.value !== "" && now[1] > now[0] && before[1] > before[0]) set(stretched(get(), before, now), "range");
      update();
    },
  }));
  function update() {
    rangeOf(get()).forEach((value, end) => {
      if (!isActive(inputs[end])) inputs[end].value = +value.toPrecision(5);
    });
  }
  return { element: row(make("span", { class: "name" }, "Range"), make("span", { class: "pair" }, inputs[0], "to", inputs[1])), update };
}

// Presets that suit the volume's kind, which the program has found, come first in the list. If the least
// value of a scan is below LEAST_OF_MR, the scan's values are Hounsfield units.
const SUITED = { "scanned brain": /^mr-/, "smoke or cloud": /^smoke/, field: /^electron/ };
const LEAST_OF_MR = -500;

function presetGroups(names, { kind, range }) {
  const suits = kind === "scanned body" || kind === "scanned matter" ? (range[0] <= LEAST_OF_MR ? /^ct-/ : /^(ct|mr)-/) : SUITED[kind];
  const listed = (some) => some.map((name) => [name, name]), suited = names.filter((name) => suits?.test(name));
  if (suited.length === 0) return listed(names);
  return [{ group: `suited to ${kind}`, choices: listed(suited) }, { group: "for other volumes", choices: listed(names.filter((name) => !suited.includes(name))) }];
}

export function functionPanel({ store, start, current, channel, failed, waits }) {
  const { element, body } = section("Transfer function");
  const volume = () => store.scene.volumes[current.volume];
  const get = () => volume().transfer_function;
  const set = (tf, name = "") =>
    store.changeVolume(current.volume, `function ${name}`, (changed) => ({ ...changed, transfer_function: tf }));
  const named = new Map(); // the name of the preset that gave a function, by the function's text
  const key = () => `by value ${current.volume}`; // the name under which the function is kept that the switch "by gradient" has replaced
  let parts = [], ofTwo = false;

  // The program knows the points of a preset. The page therefore sends the scene with the preset's name, and
  // the answer has the preset's points.
  async function applyPreset(name) {
    const volumes = store.scene.volumes.map((v, n) => {
      if (n !== current.volume) return v;
      const { transfer_function: _, ...rest } = v;
      return name === "automatic" ? rest : { ...rest, transfer_function: { preset: name } };
    });
    try {
      const complete = await waits(channel.completeScene({ ...store.scene, volumes }));
      const made = complete.volumes[current.volume].transfer_function;
      named.set(JSON.stringify(made), name);
      set(made, `preset ${name}`);
    } catch (error) {
      failed(error);
    }
  }

  function build() {
    element.hidden = !volume()?.transfer_function; // labels have colours and opacities of their own
    parts = [];
    if (element.hidden) return;
    ofTwo = isPlane(volume());
    const about = start.volumes[current.volume], range = about.range;
    const presets = select({
      label: "Preset", choices: [["", "choose …"], ["automatic", "automatic"], ...presetGroups(start.presets, about)],
      get: () => named.get(JSON.stringify(get())) ?? "", set: (name) => name && applyPreset(name),
    });
    if (ofTwo) {
      const plane = planePanel({ store, start, current, get, set });
      const back = button("by value", () => (store.aside(key()) ? set(store.aside(key()), "by value") : applyPreset("automatic")), { title: "The line over the values again" });
      body.replaceChildren(...plane.elements, smoothedLine(about), presets.element, row("", back));
      parts = [...plane.parts, presets];
      parts.forEach((part) => part.update());
      return;
    }
    const canvas = new FunctionCanvas({ get, set, histogram: about.histogram, range });
    const chosen = chosenPoint(canvas, get, set, range), ends = rangeRow(get, set);
    canvas.onSelect = () => chosen.update();
    const unit = start.scene.volumes[current.volume]?.transfer_function?.unit_distance ?? get().unit_distance; // the unit distance that the program has chosen
    const density = slider({
      label: "Opacity", path: () => `volumes.${current.volume}.transfer_function.unit_distance`, low: 0.02, high: 50, exponential: true, unit: "×", title: "How much a length of matter hides",
      get: () => unit / get().unit_distance, set: (factor) => set({ ...get(), unit_distance: unit / factor }, "density"),
    });
    const maps = select({
      label: "Colours", choices: [["", "own"], ...Object.keys(start.colormaps).map((name) => [name, name])],
      get: () => colormapOf(get(), start.colormaps), set: (name) => name && set(withColormap(get(), start.colormaps[name], spread(rangeOf(get()), range)), `map ${name}`),
    });
    const gradient = button("by gradient", () => { store.putAside(key(), get()); set(byGradient(get(), volume(), about), "by gradient"); },
      { title: "Boxes in the plane of value and gradient in place of the line" });
    const zoomed = row(make("span", { class: "name" }, "Zoom to"), make("span", { class: "buttons" },
      button("all values", () => { canvas.shown = range; }),
      button("range", () => { canvas.shown = rangeOf(get()); }),
      gradient));
    body.replaceChildren(canvas.element, smoothedLine(about), chosen.element, density.element, maps.element, presets.element, ends.element, zoomed);
    parts = [{ update: () => canvas.draw() }, chosen, density, maps, presets, ends, { update: () => { gradient.hidden = isProjection(store.scene); } }];
    parts.forEach((part) => part.update());
  }
  const update = () => {
    if (element.hidden !== !volume()?.transfer_function || (!element.hidden && ofTwo !== isPlane(volume()))) build();
    else parts.forEach((part) => part.update());
  };
  build();
  return { element, update, rebuild: build };
}
