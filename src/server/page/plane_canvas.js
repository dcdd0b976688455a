// The drawing of a transfer function of two numbers: its boxes over a histogram of value and gradient, and the pointer
// on it. Boxes are dragged, their edges too; a click beside them adds one, a double click or Delete removes it.

import { hexOf } from "./color.js";
import { make, shortNumber } from "./controls.js";
import { blankContext } from "./histogram.js";

const HEIGHT = 190, MARGIN = 9; // pixels
const GRIP = 7; // pixels within which an edge is grabbed
const AXES = ["value", "second"];

export class PlaneCanvas {
  element;
  #canvas;
  #get;
  #set;
  #range; // [from, to] of both axes
  #histogram;
  selected = 0;
  onSelect = () => {};

  // get() gives the transfer function; set(tf, name) takes a changed one. range: [[from, to], [from, to]] of value and
  // second number. histogram: { columns, rows, counts } over range, or null.
  constructor({ get, set, range, histogram }) {
    this.#get = get;
    this.#set = set;
    this.#range = range.map(([from, to]) => (to > from ? [from, to] : [from - 0.5, from + 0.5]));
    this.#histogram = histogram;
    this.#canvas = make("canvas", {
      class: "function plane", tabindex: 0, role: "application",
      "aria-label": "Boxes of values and second numbers. Arrow keys move the chosen box, with Alt its upper ends; Page Up " +
        "and Page Down choose another, Insert adds one, Delete removes it.",
      onpointerdown: (event) => this.#down(event), onkeydown: (event) => this.#key(event),
      ondblclick: (event) => this.#remove(this.#find(event)?.index), onpointermove: (event) => this.#hover(event),
      oncontextmenu: (event) => event.preventDefault(),
    });
    this.element = make("div", { class: "function-area" }, this.#canvas);
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  get boxes() { return this.#get().boxes ?? []; }

  // ---- places ----

  #size(axis) { return axis === 0 ? this.element.clientWidth - 2 * MARGIN : HEIGHT - 2 * MARGIN; }
  #pixel(axis, number) {
    const [from, to] = this.#range[axis], part = (number - from) / (to - from);
    return MARGIN + (axis === 0 ? part : 1 - part) * this.#size(axis);
  }
  #number(axis, pixel) {
    const [from, to] = this.#range[axis], part = (pixel - MARGIN) / this.#size(axis);
    return from + (axis === 0 ? part : 1 - part) * (to - from);
  }
  #place(event) {
    const box = this.#canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  // What is under the pointer: { index, ends }, for each axis which end of the box is grabbed (0, 1; null: neither); or null.
  #find(event) {
    const at = this.#place(event);
    for (let index = this.boxes.length - 1; index >= 0; index--) {
      const box = this.boxes[index], pixels = AXES.map((key, axis) => box[key].map((number) => this.#pixel(axis, number)));
      if (!pixels.every((pair, axis) => at[axis] > Math.min(...pair) - GRIP && at[axis] < Math.max(...pair) + GRIP)) continue;
      const ends = pixels.map((pair, axis) => {
        const far = pair.map((pixel) => Math.abs(pixel - at[axis]));
        return Math.min(...far) > GRIP ? null : far[0] <= far[1] ? 0 : 1;
      });
      return { index, ends };
    }
    return null;
  }

  // ---- hands ----

  change(index, part, name) {
    const boxes = this.boxes.map((box, n) => (n === index ? { ...box, ...part } : box));
    this.#set({ ...this.#get(), boxes }, name);
  }

  #select(index) {
    this.selected = index;
    this.onSelect(index);
    this.draw();
  }

  #add(at) {
    const like = this.boxes[this.selected] ?? { color: [0.9, 0.6, 0.3], opacity: 0.5 }, { edge: _, ...look } = like;
    const around = AXES.map((_, axis) => {
      const [from, to] = this.#range[axis], half = (to - from) / 12;
      return [Math.max(at[axis] - half, from), Math.min(at[axis] + half, to)];
    });
    this.#set({ ...this.#get(), boxes: [...this.boxes, { ...look, value: around[0], second: around[1] }] }, `add ${Math.random()}`);
    this.#select(this.boxes.length - 1);
  }

  #remove(index) {
    if (index === undefined || this.boxes.length < 2) return;
    this.#set({ ...this.#get(), boxes: this.boxes.filter((_, n) => n !== index) }, `remove ${Math.random()}`);
    this.#select(Math.max(0, index - 1));
  }

  // A box moved by `by`, or its ends: they keep apart.
  #moved(box, ends, by) {
    const whole = ends.every((end) => end === null);
    return Object.fromEntries(AXES.map((key, axis) => {
      const least = (this.#range[axis][1] - this.#range[axis][0]) / 200, [low, high] = box[key];
      if (whole) return [key, [low + by[axis], high + by[axis]]];
      if (ends[axis] === 0) return [key, [Math.min(low + by[axis], high - least), high]];
      return [key, ends[axis] === 1 ? [low, Math.max(high + by[axis], low + least)] : [low, high]];
    }));
  }

  #down(event) {
    const found = this.#find(event), start = this.#place(event).map((pixel, axis) => this.#number(axis, pixel));
    this.#canvas.focus({ preventScroll: true });
    if (event.button !== 0) {
      this.#remove(found?.index);
      return;
    }
    if (found === null) {
      this.#add(start);
      return;
    }
    this.#select(found.index);
    this.#canvas.setPointerCapture(event.pointerId);
    const name = `drag ${Math.random()}`, box = this.boxes[found.index];
    const move = (moved) => {
      const by = this.#place(moved).map((pixel, axis) => this.#number(axis, pixel) - start[axis]);
      this.change(found.index, this.#moved(box, found.ends, by), name);
    };
    const end = () => this.#canvas.removeEventListener("pointermove", move);
    this.#canvas.addEventListener("pointermove", move);
    for (const over of ["pointerup", "pointercancel"]) this.#canvas.addEventListener(over, end, { once: true });
  }

  #hover(event) {
    const found = this.#find(event), numbers = this.#place(event).map((pixel, axis) => shortNumber(this.#number(axis, pixel)));
    const [x, y] = found?.ends ?? [null, null];
    const shapes = [[x !== null && y !== null, x === y ? "nesw-resize" : "nwse-resize"], [x !== null, "ew-resize"], [y !== null, "ns-resize"]];
    this.#canvas.style.cursor = found === null ? "copy" : (shapes.find(([fits]) => fits)?.[1] ?? "grab");
    this.#canvas.title = `value ${numbers[0]}, ${this.#get().second === "gradient" ? "gradient" : "other volume"} ${numbers[1]}`;
  }

  #key(event) {
    const step = event.shiftKey ? 20 : 200, moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const count = this.boxes.length, box = this.boxes[this.selected];
    if (moves[event.key] && box) {
      const by = moves[event.key].map((sign, axis) => (sign * (this.#range[axis][1] - this.#range[axis][0])) / step);
      this.change(this.selected, this.#moved(box, event.altKey ? [1, 1] : [null, null], by), "keys");
    } else if (event.key === "PageUp" || event.key === "PageDown")
      this.#select((this.selected + (event.key === "PageDown" ? 1 : count - 1)) % Math.max(count, 1));
    else if (event.key === "Delete" || event.key === "Backspace") this.#remove(this.selected);
    else if (event.key === "Insert") this.#add(this.#range.map(([from, to]) => (from + to) / 2));
    else return;
    event.preventDefault();
    event.stopPropagation();
  }

  // ---- the drawing ----

  draw() {
    const context = blankContext(this.#canvas, this.element.clientWidth, HEIGHT), style = getComputedStyle(this.#canvas);
    if (context === null) return;
    this.selected = Math.min(this.selected, Math.max(this.boxes.length - 1, 0));
    this.#drawHistogram(context, style);
    for (const polygon of this.#get().polygons ?? []) this.#drawPolygon(context, polygon);
    this.boxes.forEach((box, index) => this.#drawBox(context, style, box, index === this.selected));
  }

  #drawHistogram(context, style) {
    if (this.#histogram === null) return;
    const { columns, rows, counts } = this.#histogram, most = Math.log1p(counts.reduce((a, b) => Math.max(a, b), 0));
    const wide = this.#size(0) / columns, tall = this.#size(1) / rows;
    context.fillStyle = style.getPropertyValue("--line");
    counts.forEach((count, n) => {
      if (count === 0) return;
      context.globalAlpha = 0.75 * (Math.log1p(count) / most);
      context.fillRect(MARGIN + (n % columns) * wide, HEIGHT - MARGIN - (Math.floor(n / columns) + 1) * tall, wide + 0.4, tall + 0.4);
    });
    context.globalAlpha = 1;
  }

  #drawPolygon(context, { vertices, color }) {
    context.beginPath();
    for (const [value, second] of vertices) context.lineTo(this.#pixel(0, value), this.#pixel(1, second));
    context.closePath();
    context.strokeStyle = hexOf(color);
    context.lineWidth = 1.5;
    context.stroke();
  }

  #drawBox(context, style, box, chosen) {
    const [left, right] = box.value.map((value) => this.#pixel(0, value)), [bottom, top] = box.second.map((second) => this.#pixel(1, second));
    context.beginPath();
    context.rect(left, top, right - left, bottom - top);
    context.fillStyle = hexOf(box.color);
    context.globalAlpha = 0.12 + 0.35 * box.opacity;
    context.fill();
    context.globalAlpha = 1;
    context.lineWidth = chosen ? 2.5 : 1.5;
    context.strokeStyle = chosen ? style.getPropertyValue("--accent") : hexOf(box.color);
    context.stroke();
  }
}
