// The panel of a volume's isosurfaces: their values as lines over the histogram, their colours and opacities.

import { hexOf, linearOf } from "./color.js";
import { color, make, section, shortNumber, slider, tabs, toggle } from "./controls.js";
import { followDrag, reachOf } from "./drag.js";
import { blankContext, drawBars, drawValueAxis, smoothedLine } from "./histogram.js";
import { isProjection, opacityAt, rangeOf } from "./transfer_function.js";

const HEIGHT = 88, AXIS = 16, MARGIN = 9, GRIP = 10; // pixels
// A further surface is added around the last surface: its value lies at this fraction of the way from the
// last surface's value to the value of the surroundings.
const OUTWARDS = 0.6;
const PALETTE = ["#e8c39e", "#4fa3e0", "#d9534f", "#6cc070", "#c48be0", "#e0c04f"];

// Makes the histogram with a line at each surface's value. Lines can be dragged; for the keyboard,
// there is a slider below the histogram.
function lines({ surfaces, chosen, choose, set, about }) {
  const [low, high] = about.range[1] > about.range[0] ? about.range : [about.range[0] - 0.5, about.range[0] + 0.5];
  const canvas = make("canvas", { class: "values", "aria-hidden": "true", onpointerdown: down });
  const area = make("div", { class: "function-area" }, canvas);
  const width = () => area.clientWidth - 2 * MARGIN;
  const x = (value) => MARGIN + ((value - low) / (high - low)) * width();
  const valueAt = (event) => {
    const at = (event.clientX - canvas.getBoundingClientRect().left - MARGIN) / width();
    return low + Math.min(Math.max(at, 0), 1) * (high - low);
  };

  function down(event) {
    const value = valueAt(event), far = surfaces().map((surface) => Math.abs(x(surface.value) - x(value)));
    const nearest = far.indexOf(Math.min(...far));
    if (nearest < 0) return;
    if (far[nearest] < reachOf(event, GRIP)) choose(nearest);
    else set(value);
    followDrag(event, canvas, (moved) => set(valueAt(moved)));
  }

  function update() {
    const context = blankContext(canvas, area.clientWidth, HEIGHT);
    if (context === null) return;
    const style = getComputedStyle(canvas);
    context.fillStyle = style.getPropertyValue("--bars");
    drawBars(context, { counts: about.histogram, range: [low, high], x, left: MARGIN, right: MARGIN + width(), base: HEIGHT - AXIS, height: HEIGHT - AXIS - 8 });
    drawValueAxis(context, { range: [low, high], x, left: MARGIN, right: MARGIN + width(), y: HEIGHT - AXIS, color: style.getPropertyValue("--dim") });
    surfaces().forEach((surface, n) => {
      context.fillStyle = hexOf(surface.color);
      context.strokeStyle = style.getPropertyValue(n === chosen() ? "--accent" : "--line");
      context.lineWidth = n === chosen() ? 2.5 : 1.5;
      context.beginPath();
      context.moveTo(x(surface.value), 8);
      context.lineTo(x(surface.value), HEIGHT - AXIS);
      context.stroke();
      context.beginPath();
      context.arc(x(surface.value), 9, 5, 0, 2 * Math.PI);
      context.fill();
      context.stroke();
    });
  }
  new ResizeObserver(update).observe(area);
  return { element: area, update };
}

// Returns the value for the first surface: the least value at which the transfer function reaches half of its
// greatest opacity.
function firstValue(tf, range) {
  const most = Math.max(...tf.opacity.map((point) => point[1])), [low, high] = rangeOf(tf);
  for (let n = 0; n <= 200 && most > 0; n++) {
    const value = low + (n / 200) * (high - low);
    if (opacityAt(tf, value) >= most / 2 && value > range[0] && value < range[1]) return value;
  }
  return (range[0] + range[1]) / 2;
}

const isClear = (tf) => tf.opacity.every((point) => point[1] === 0);
const cleared = (tf) => ({ ...tf, opacity: tf.opacity.map(([value]) => [value, 0]) });

// Returns the middle of the fullest bin, which is mostly the value of the things' surroundings.
function commonest({ histogram, range: [low, high] }) {
  return low + ((histogram.indexOf(Math.max(...histogram)) + 0.5) / histogram.length) * (high - low);
}

export function surfacePanel({ store, start, current, failed, channel, waits }) {
  const { element, body } = section("Isosurfaces", false);
  const volume = () => store.scene.volumes[current.volume], about = () => start.volumes[current.volume];
  const surfaces = () => volume().iso ?? [], chosen = () => current.of("surface", surfaces().length), surface = () => surfaces()[chosen()];
  const key = () => `alone ${current.volume}`; // the name under which the transfer function is kept that the switch "Surfaces alone" has hidden
  let parts = [];
  // Surfaces can be added if the transfer function takes one number and the scene is no maximum
  // projection.
  const isOfValue = () => volume()?.transfer_function?.opacity !== undefined && !isProjection(store.scene);

  const changeSurface = (name, part) => store.changeVolume(current.volume, `iso ${chosen()} ${name}`, (v) => ({
    ...v, iso: v.iso.map((one, n) => (n === chosen() ? { ...one, ...part } : one)),
  }));
  const choose = (n) => current.choose("surface", n);

  function add() {
    const last = surfaces().at(-1), tf = volume().transfer_function;
    const value = last === undefined ? firstValue(tf, about().range) : last.value + OUTWARDS * (commonest(about()) - last.value);
    const made = { value, color: linearOf(PALETTE[surfaces().length % PALETTE.length]), opacity: last === undefined ? 1 : 0.3 };
    if (last === undefined && !isClear(tf)) store.putAside(key(), tf);
    store.changeVolume(current.volume, `iso add ${Math.random()}`, (v) => ({
      ...v, iso: [...(v.iso ?? []), made], transfer_function: last === undefined ? cleared(tf) : tf,
    }));
    choose(surfaces().length - 1);
  }

  function remove() {
    const gone = chosen(), back = surfaces().length === 1 && isClear(volume().transfer_function) ? store.aside(key()) : undefined;
    store.changeVolume(current.volume, `iso remove ${Math.random()}`, ({ iso, ...v }) => {
      const rest = iso.filter((_, n) => n !== gone);
      return { ...v, ...(back ? { transfer_function: back } : {}), ...(rest.length > 0 ? { iso: rest } : {}) };
    });
    choose(Math.max(0, gone - 1));
  }

  // Hides everything of the volume but its isosurfaces, or shows it again. If the volume had only
  // isosurfaces from the beginning, the volume gets its default look.
  async function setAlone(alone) {
    const tf = volume().transfer_function, { iso: _, transfer_function: __, ...bare } = volume(), index = current.volume;
    const set = (wanted) => store.changeVolume(index, "iso alone", (v) => ({ ...v, transfer_function: wanted }));
    if (alone) {
      store.putAside(key(), tf);
      set(cleared(tf));
    } else if (store.aside(key())) set(store.aside(key()));
    else
      try {
        const volumes = store.scene.volumes.map((v, n) => (n === index ? bare : v));
        set((await waits(channel.completeScene({ ...store.scene, volumes }))).volumes[index].transfer_function);
      } catch (error) {
        failed(error);
      }
  }

  const list = tabs({ label: "Isosurfaces", noun: "isosurface", count: () => surfaces().length, chosen, choose, add, remove });
  function build() {
    if (!isOfValue() || !about()) {
      parts = [];
      element.hidden = true;
      return;
    }
    element.hidden = false;
    const drawing = lines({ surfaces, chosen, choose, set: (value) => changeSurface("value", { value }), about: about() });
    parts = [
      slider({ label: "Value", path: () => `volumes.${current.volume}.iso.${chosen()}.value`, low: about().range[0], high: about().range[1], get: () => surface().value, set: (value) => changeSurface("value", { value }) }),
      color({ label: "Colour", get: () => hexOf(surface().color), set: (hex) => changeSurface("color", { color: linearOf(hex) }) }),
      slider({ label: "Opacity", path: () => `volumes.${current.volume}.iso.${chosen()}.opacity`, low: 0, high: 1, title: "The fraction of light that the surface stops", get: () => surface().opacity, set: (opacity) => changeSurface("opacity", { opacity }) }),
      toggle({ label: "Surfaces alone", get: () => isClear(volume().transfer_function), set: setAlone }),
      drawing,
    ];
    const none = make("p", { class: "facts" }, `+ adds the surface of one value${about().unsmoothed ? "" : `, of ${about().range.map(shortNumber).join(" to ")}`}.`);
    body.replaceChildren(list.element, none, drawing.element, smoothedLine(about()), ...parts.slice(0, 4).map((part) => part.element));
    parts.unshift({ element: none, update: () => {} });
    update();
  }
  function update() {
    if (element.hidden !== !isOfValue()) build();
    if (element.hidden) return;
    list.update();
    for (const [n, part] of parts.entries()) {
      part.element.hidden = (surface() === undefined) !== (n === 0);
      if (!part.element.hidden) part.update();
    }
  }
  build();
  return { element, update, rebuild: build };
}
