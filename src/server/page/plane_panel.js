// The panel of a transfer function that takes two numbers: the drawing of its boxes and polygons, and the
// colour, opacity and edge of the chosen shape.

import { hexOf, linearOf } from "./color.js";
import { button, color, make, slider } from "./controls.js";
import { PlaneCanvas } from "./plane_canvas.js";
import { isPolygon } from "./plane_shapes.js";
import { rangeOf } from "./transfer_function.js";

const GRADIENT = "gradient";

// Returns [0, greatest gradient in the drawing], per unit of the world. A volume's scale in the
// scene divides the gradient.
function gradientsOf(volume, about) {
  const scale = volume.transform?.scale ?? 1, mean = Array.isArray(scale) ? Math.cbrt(scale[0] * scale[1] * scale[2]) : scale;
  return [0, (about.plane?.gradient ?? (about.range[1] - about.range[0]) / 4) / mean];
}

// Returns a function of value and gradient that shows about the same matter as a function of the
// value alone.
export function byGradient(tf, volume, about) {
  const [low, high] = rangeOf(tf), greatest = tf.opacity.reduce((a, b) => (b[1] > a[1] ? b : a), [0, 0.5]);
  const middle = tf.color[Math.floor(tf.color.length / 2)] ?? [0, 0.8, 0.8, 0.8];
  return {
    unit_distance: tf.unit_distance, second: GRADIENT,
    boxes: [{
      value: [low, Math.max(high, about.range[1])], second: gradientsOf(volume, about), color: middle.slice(1),
      opacity: Math.max(greatest[1], 0.1), edge: [(Math.max(high, about.range[1]) - low) / 4, 0],
    }],
  };
}

// Returns { element, parts }. element: contains the rows. parts: the controls that show the scene's
// present values.
export function planePanel({ store, start, current, get, set }) {
  const volume = store.scene.volumes[current.volume], about = start.volumes[current.volume], second = get().second;
  const other = store.scene.volumes.findIndex((v) => v.name !== undefined && v.name === second.volume);
  const seconds = second === GRADIENT ? gradientsOf(volume, about) : (start.volumes[other]?.range ?? [0, 1]);
  const canvas = new PlaneCanvas({
    get, set, range: [about.range, seconds], histogram: second === GRADIENT ? (about.plane ?? null) : null,
  });
  const chosen = () => canvas.shapes[canvas.selected] ?? { color: [1, 1, 1], opacity: 0, value: [0, 1], second: [0, 1] };
  // The softness of a shape: half the falloff of a polygon, or the width of a box's edge as a
  // fraction of the box's width.
  const soft = () => (isPolygon(chosen()) ? (chosen().falloff ?? 1) / 2 : (chosen().edge?.[0] ?? 0) / (chosen().value[1] - chosen().value[0]));
  const softened = (part) => (isPolygon(chosen()) ? { falloff: 2 * part } : { edge: ["value", "second"].map((key) => part * (chosen()[key][1] - chosen()[key][0])) });
  // Returns the path of the chosen shape in the scene.
  const place = () => {
    const n = canvas.selected, boxes = canvas.boxes.length;
    return `volumes.${current.volume}.transfer_function.${n < boxes ? `boxes.${n}` : `polygons.${n - boxes}`}`;
  };
  const parts = [
    color({ label: "Fill colour", get: () => hexOf(chosen().color), set: (hex) => canvas.change(canvas.selected, { color: linearOf(hex) }, "color") }),
    slider({ label: "Fill opacity", path: () => `${place()}.opacity`, low: 0, high: 1, get: () => chosen().opacity, set: (opacity) => canvas.change(canvas.selected, { opacity }, "opacity") }),
    slider({
      label: "Soft edge", path: () => (isPolygon(chosen()) ? `${place()}.falloff` : [`${place()}.edge.0`, `${place()}.edge.1`]), low: 0, high: 0.5, title: "The part of the shape's width within which it fades towards its border", get: soft,
      set: (part) => canvas.change(canvas.selected, softened(part), "edge"),
    }),
  ];
  canvas.onSelect = () => parts.forEach((part) => part.update());
  const axes = make("p", { class: "facts" }, second === GRADIENT ? "Right: value; up: the gradient's length" : `Right: value; up: that of "${second.volume}"`);
  const adding = make("p", { class: "facts" }, button("Add a polygon", () => canvas.addPolygon()));
  return { elements: [canvas.element, axes, adding, ...parts.map((part) => part.element)], parts: [{ update: () => canvas.draw() }, ...parts] };
}
