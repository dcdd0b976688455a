// The editor of a transfer function of two numbers: it draws the function's boxes and polygons over a
// histogram of value and gradient. The pointer drags shapes and their edges, vertices and apexes. A click
// beside all shapes adds a box. A double click on a polygon's side adds a vertex; a double click
// elsewhere, or the key Delete, removes the vertex or the shape.

import { hexOf } from "./color.js";
import { make, shortNumber } from "./controls.js";
import { followDrag, reachOf } from "./drag.js";
import { blankContext } from "./histogram.js";
import { apexOf, isPolygon, moved, partAt, withVertex, withoutVertex } from "./plane_shapes.js";

const HEIGHT = 190, MARGIN = 9; // pixels
const GRIP = 7; // pixels from an edge within which a mouse grabs it
const AXES = ["value", "second"];

export class PlaneCanvas {
  element;
  #canvas;
  #get;
  #set;
  #range; // [from, to] of both axes
  #histogram;
  selected = 0; // index of the chosen shape in the list of all boxes, followed by all polygons
  vertex = 0; // index of the chosen vertex of a polygon
  onSelect = () => {};

  // get() returns the transfer function; set(tf, name) takes a changed one. range: [[from, to], [from, to]]
  // of value and second number. histogram: { columns, rows, counts } over range, or null.
  constructor({ get, set, range, histogram }) {
    this.#get = get;
    this.#set = set;
    this.#range = range.map(([from, to]) => (to > from ? [from, to] : [from - 0.5, from + 0.5]));
    this.#histogram = histogram;
    this.#canvas = make("canvas", {
      class: "function plane", tabindex: 0, role: "application",
      "aria-label": "Boxes and polygons of values and second numbers. Arrow keys move the chosen one, with Alt a box's upper " +
        "ends or a polygon's chosen vertex; Page Up and Page Down choose another shape, Home and End another vertex; Insert adds a " +
        "box, Delete removes the shape, and with Alt they add and remove a vertex.",
      onpointerdown: (event) => this.#down(event), onkeydown: (event) => this.#key(event),
      ondblclick: (event) => this.#twice(event), onpointermove: (event) => this.#hover(event),
      oncontextmenu: (event) => event.preventDefault(),
    });
    this.element = make("div", { class: "function-area" }, this.#canvas);
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  get boxes() { return this.#get().boxes ?? []; }
  get shapes() { return [...this.boxes, ...(this.#get().polygons ?? [])]; }

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

  #inPixels(shape) {
    const places = (list) => list.map((numbers) => numbers.map((number, axis) => this.#pixel(axis, number)));
    if (isPolygon(shape)) return { vertices: places(shape.vertices), apex: places([apexOf(shape)])[0] };
    return Object.fromEntries(AXES.map((key, axis) => [key, shape[key].map((number) => this.#pixel(axis, number))]));
  }

  // Returns the shape under the pointer: its index and its part (partAt()); or null.
  #find(event) {
    const at = this.#place(event), shapes = this.shapes;
    for (let index = shapes.length - 1; index >= 0; index--) {
      const part = partAt(this.#inPixels(shapes[index]), at, reachOf(event, GRIP));
      if (part !== null) return { index, part };
    }
    return null;
  }

  // ---- hands ----

  #take(shapes, name) {
    const [polygons, boxes] = [true, false].map((wanted) => shapes.filter((shape) => isPolygon(shape) === wanted));
    const { polygons: _, ...tf } = this.#get();
    this.#set({ ...tf, boxes, ...(polygons.length > 0 ? { polygons } : {}) }, name);
  }

  change(index, part, name) {
    this.#take(this.shapes.map((shape, n) => (n === index ? { ...shape, ...part } : shape)), name);
  }

  #select(index, vertex = 0) {
    this.selected = index;
    this.vertex = vertex;
    this.onSelect(index);
    this.draw();
  }

  #look() {
    const { color, opacity } = this.shapes[this.selected] ?? { color: [0.9, 0.6, 0.3], opacity: 0.5 };
    return { color, opacity };
  }

  #add(at) {
    const around = AXES.map((_, axis) => {
      const [from, to] = this.#range[axis], half = (to - from) / 12;
      return [Math.max(at[axis] - half, from), Math.min(at[axis] + half, to)];
    });
    const box = { ...this.#look(), value: around[0], second: around[1] }, place = this.boxes.length;
    this.#take([...this.boxes, box, ...this.shapes.slice(place)], `add ${Math.random()}`);
    this.#select(place);
  }

  // Adds a polygon, a rhombus in the middle.
  addPolygon() {
    const middle = this.#range.map(([from, to]) => (from + to) / 2), half = this.#range.map(([from, to]) => (to - from) / 6);
    const vertices = [[-1, 0], [0, -1], [1, 0], [0, 1]].map((to) => to.map((sign, axis) => middle[axis] + sign * half[axis]));
    this.#take([...this.shapes, { vertices, apex: middle, ...this.#look(), falloff: 1 }], `add ${Math.random()}`);
    this.#select(this.shapes.length - 1);
  }

  #remove(index) {
    if (index === undefined || this.shapes.length < 2) return;
    this.#take(this.shapes.filter((_, n) => n !== index), `remove ${Math.random()}`);
    this.#select(Math.max(0, index - 1));
  }

  #addVertex(index, side, at) {
    this.change(index, { vertices: withVertex(this.shapes[index], side, at) }, `vertex ${Math.random()}`);
    this.#select(index, side + 1);
  }

  #removeVertex(index, vertex) {
    const vertices = withoutVertex(this.shapes[index], vertex);
    if (vertices === null) return;
    this.change(index, { vertices }, `vertex ${Math.random()}`);
    this.#select(index, Math.max(0, vertex - 1));
  }

  #twice(event) {
    const found = this.#find(event);
    if (found === null) return;
    if (found.part.side !== undefined) this.#addVertex(found.index, found.part.side, this.#place(event).map((pixel, axis) => this.#number(axis, pixel)));
    else if (found.part.vertex !== undefined) this.#removeVertex(found.index, found.part.vertex);
    else this.#remove(found.index);
  }

  #moved(shape, part, by) {
    return moved(shape, part, by, this.#range.map(([from, to]) => (to - from) / 200));
  }

  #down(event) {
    const found = this.#find(event), start = this.#place(event).map((pixel, axis) => this.#number(axis, pixel));
    this.#canvas.focus({ preventScroll: true });
    if (event.button !== 0) {
      if (found?.part.vertex !== undefined) this.#removeVertex(found.index, found.part.vertex);
      else this.#remove(found?.index);
      return;
    }
    if (found === null) {
      this.#add(start);
      return;
    }
    this.#select(found.index, found.part.vertex);
    const name = `drag ${Math.random()}`, shape = this.shapes[found.index];
    followDrag(event, this.#canvas, (moved) => {
      const by = this.#place(moved).map((pixel, axis) => this.#number(axis, pixel) - start[axis]);
      this.change(found.index, this.#moved(shape, found.part, by), name);
    });
  }

  #hover(event) {
    const found = this.#find(event), numbers = this.#place(event).map((pixel, axis) => shortNumber(this.#number(axis, pixel)));
    const [x, y] = found?.part.ends ?? [null, null], point = found?.part.vertex !== undefined || found?.part.apex;
    const shapes = [[point, "move"], [x !== null && y !== null, x === y ? "nesw-resize" : "nwse-resize"], [x !== null, "ew-resize"], [y !== null, "ns-resize"]];
    this.#canvas.style.cursor = found === null ? "copy" : (shapes.find(([fits]) => fits)?.[1] ?? "grab");
    this.#canvas.title = `value ${numbers[0]}, ${this.#get().second === "gradient" ? "gradient" : "other volume"} ${numbers[1]}`;
  }

  #key(event) {
    const step = event.shiftKey ? 20 : 200, moves = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    const count = this.shapes.length, shape = this.shapes[this.selected], polygon = shape !== undefined && isPolygon(shape);
    if (moves[event.key] && shape) {
      const by = moves[event.key].map((sign, axis) => (sign * (this.#range[axis][1] - this.#range[axis][0])) / step);
      const part = polygon ? (event.altKey ? { vertex: this.vertex } : {}) : { ends: event.altKey ? [1, 1] : [null, null] };
      this.change(this.selected, this.#moved(shape, part, by), "keys");
    } else if (event.key === "PageUp" || event.key === "PageDown")
      this.#select((this.selected + (event.key === "PageDown" ? 1 : count - 1)) % Math.max(count, 1));
    else if (polygon && (event.key === "Home" || event.key === "End"))
      this.#select(this.selected, (this.vertex + (event.key === "End" ? 1 : shape.vertices.length - 1)) % shape.vertices.length);
    else if (polygon && event.altKey && event.key === "Insert") this.#addVertex(this.selected, this.vertex);
    else if (polygon && event.altKey && event.key === "Delete") this.#removeVertex(this.selected, this.vertex);
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
    const shapes = this.shapes;
    this.selected = Math.min(this.selected, Math.max(shapes.length - 1, 0));
    this.#drawHistogram(context, style);
    shapes.forEach((shape, index) => this.#drawShape(context, style, shape, index === this.selected));
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

  #drawShape(context, style, shape, chosen) {
    const { value, second, vertices, apex } = this.#inPixels(shape);
    context.beginPath();
    if (vertices) for (const [x, y] of vertices) context.lineTo(x, y);
    else context.rect(value[0], second[1], value[1] - value[0], second[0] - second[1]);
    context.closePath();
    context.fillStyle = hexOf(shape.color);
    context.globalAlpha = 0.12 + 0.35 * shape.opacity;
    context.fill();
    context.globalAlpha = 1;
    context.lineWidth = chosen ? 2.5 : 1.5;
    context.strokeStyle = chosen ? style.getPropertyValue("--accent") : hexOf(shape.color);
    context.stroke();
    if (vertices && chosen) this.#drawHandles(context, vertices, apex);
  }

  // Draws a disk at each vertex and a ring at the apex. The disk at the chosen vertex is larger.
  #drawHandles(context, vertices, apex) {
    const disk = ([x, y], radius) => { context.beginPath(); context.arc(x, y, radius, 0, 2 * Math.PI); };
    context.fillStyle = context.strokeStyle;
    this.vertex = Math.min(this.vertex, vertices.length - 1);
    vertices.forEach((place, n) => { disk(place, n === this.vertex ? 5 : 3); context.fill(); });
    disk(apex, 4);
    context.lineWidth = 1.5;
    context.stroke();
  }
}
