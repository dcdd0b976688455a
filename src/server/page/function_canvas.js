// The editor that draws a transfer function over the volume's histogram. The pointer changes the function:
// points are dragged, a click on the line or above the bars adds a point, and a double click or the key
// Delete removes a point. A strip below the histogram shows the colours.

import { hexOf } from "./color.js";
import { make, shortNumber } from "./controls.js";
import { followDrag, reachOf } from "./drag.js";
import { blankContext, drawBars, drawValueAxis } from "./histogram.js";
import { addPoint, addStop, colorAt, movePoint, moveStop, opacityAt, removePoint, removeStop } from "./transfer_function.js";

const HEIGHT = 180, STRIP = 16, GAP = 20, MARGIN = 9; // pixels
const GRIP = 10; // pixels from a point within which a mouse grabs it

export class FunctionCanvas {
  element;
  #canvas;
  #get;
  #set;
  #histogram;
  #range;
  #shown; // the values at the left and the right edge
  #selected = { kind: "point", index: 0 };
  onSelect = () => {};

  // get() returns the transfer function. The transfer function is undefined while labels or isosurfaces
  // replace it; a key can cause this during a drag. set(tf, name) takes a changed function. histogram: the
  // counts of bins of equal width over `range`.
  constructor({ get, set, histogram, range }) {
    this.#get = get;
    this.#set = set;
    this.#histogram = histogram;
    this.#range = range[1] > range[0] ? range : [range[0] - 0.5, range[0] + 0.5];
    this.#shown = this.#range;
    this.#canvas = make("canvas", {
      class: "function", tabindex: 0, role: "application",
      "aria-label": "Opacity over values. Arrow keys move the chosen point, Tab with Page Up and Page Down choose " +
        "another, Insert adds one, Delete removes it.",
      onpointerdown: (event) => this.#get() && this.#down(event), onkeydown: (event) => this.#get() && this.#key(event),
      ondblclick: (event) => this.#get() && this.#remove(this.#find(event)), onpointermove: (event) => this.#get() && this.#hover(event),
      onwheel: (event) => this.#wheel(event), oncontextmenu: (event) => event.preventDefault(),
    });
    this.element = make("div", { class: "function-area" }, this.#canvas);
    new ResizeObserver(() => this.draw()).observe(this.element);
  }

  // The index of the chosen point or colour. If the present function has fewer points than the index, the
  // last point is chosen.
  get selected() {
    const { kind, index } = this.#selected, tf = this.#get(), rows = (kind === "point" ? tf?.opacity : tf?.color) ?? [];
    return { kind, index: Math.max(0, Math.min(index, rows.length - 1)) };
  }

  get shown() { return this.#shown; }
  set shown([low, high]) {
    const span = this.#range[1] - this.#range[0];
    if (!(high - low > span * 1e-6)) return;
    this.#shown = [low, high];
    this.draw();
  }

  // ---- places ----

  get #width() { return this.element.clientWidth - 2 * MARGIN; }
  get #plot() { return HEIGHT - STRIP - GAP - 2 * MARGIN; }
  #x(value) { return MARGIN + ((value - this.#shown[0]) / (this.#shown[1] - this.#shown[0])) * this.#width; }
  #y(opacity) { return MARGIN + (1 - opacity) * this.#plot; }
  #value(x) { return this.#shown[0] + ((x - MARGIN) / this.#width) * (this.#shown[1] - this.#shown[0]); }
  #opacity(y) { return 1 - (y - MARGIN) / this.#plot; }

  #place(event) {
    const box = this.#canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  // The point or colour under the pointer: { kind, index }, or null.
  #find(event) {
    const [x, y] = this.#place(event), tf = this.#get(), reach = reachOf(event, GRIP);
    if (y > HEIGHT - STRIP - MARGIN - GAP / 2) {
      const at = tf.color.findIndex(([value]) => Math.abs(this.#x(value) - x) < reach * 0.7);
      return at < 0 ? null : { kind: "stop", index: at };
    }
    let best = null, nearest = reach;
    tf.opacity.forEach(([value, opacity], index) => {
      const far = Math.hypot(this.#x(value) - x, this.#y(opacity) - y);
      if (far < nearest) [best, nearest] = [{ kind: "point", index }, far];
    });
    return best;
  }

  // ---- hands ----

  #select(what) {
    this.#selected = what;
    this.onSelect(what);
    this.draw();
  }

  #down(event) {
    if (event.button !== 0) {
      this.#remove(this.#find(event));
      return;
    }
    let what = this.#find(event);
    const [x, y] = this.#place(event), strip = y > HEIGHT - STRIP - MARGIN - GAP / 2;
    if (what === null) {
      const added = strip ? addStop(this.#get(), this.#value(x)) : addPoint(this.#get(), this.#value(x), this.#opacity(y));
      what = { kind: strip ? "stop" : "point", index: added.index };
      this.#set(added.tf, `add ${Math.random()}`);
    }
    this.#select(what);
    this.#canvas.focus({ preventScroll: true });
    const name = `drag ${Math.random()}`;
    followDrag(event, this.#canvas, (moved) => {
      if (!this.#get()) return;
      const [mx, my] = this.#place(moved);
      this.#set(this.#moved(what, this.#value(mx), this.#opacity(my)), name);
    });
  }

  #moved({ kind, index }, value, opacity) {
    const tf = this.#get();
    if (!(kind === "point" ? tf.opacity : tf.color)[index]) return tf; // a preset has replaced the function during the drag
    return kind === "point" ? movePoint(tf, index, value, opacity, this.#range) : moveStop(tf, index, value);
  }

  #remove(what) {
    if (what === null) return;
    const tf = this.#get();
    this.#set(what.kind === "point" ? removePoint(tf, what.index) : removeStop(tf, what.index), `remove ${Math.random()}`);
    this.#select({ kind: what.kind, index: Math.max(0, what.index - 1) });
  }

  #hover(event) {
    this.#canvas.style.cursor = this.#find(event) ? "grab" : "copy";
    const [x, y] = this.#place(event);
    this.#canvas.title = `value ${shortNumber(this.#value(x))}, opacity ${shortNumber(Math.min(Math.max(this.#opacity(y), 0), 1))}`;
  }

  // Zooms the range of shown values about the pointer. If all values are shown already, zooming out is
  // left to the side bar, which scrolls.
  #wheel(event) {
    if (event.deltaY >= 0 && this.#shown.every((value, n) => value === this.#range[n])) return;
    event.preventDefault();
    const [x] = this.#place(event), at = this.#value(x), factor = 1.0015 ** event.deltaY;
    const [low, high] = this.#shown.map((value) => at + (value - at) * factor);
    this.shown = [Math.max(low, this.#range[0]), Math.min(high, this.#range[1])];
  }

  #key(event) {
    const tf = this.#get(), { kind, index } = this.selected, rows = kind === "point" ? tf.opacity : tf.color;
    const at = rows[index];
    if (!at) return;
    const dx = (this.#shown[1] - this.#shown[0]) / (event.shiftKey ? 20 : 200), dy = event.shiftKey ? 0.1 : 0.01;
    const moves = { ArrowLeft: [-dx, 0], ArrowRight: [dx, 0], ArrowUp: [0, dy], ArrowDown: [0, -dy] };
    if (moves[event.key]) this.#set(this.#moved(this.selected, at[0] + moves[event.key][0], at[1] + moves[event.key][1]), "keys");
    else if (event.key === "PageUp" || event.key === "PageDown")
      this.#select({ kind, index: (index + (event.key === "PageDown" ? 1 : rows.length - 1)) % rows.length });
    else if (event.key === "Delete" || event.key === "Backspace") this.#remove(this.selected);
    else if (event.key === "Insert") {
      const value = at[0] + 10 * dx, added = kind === "point" ? addPoint(tf, value, at[1]) : addStop(tf, value);
      this.#set(added.tf, `add ${Math.random()}`);
      this.#select({ kind, index: added.index });
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }

  // ---- the drawing ----

  draw() {
    const context = blankContext(this.#canvas, this.element.clientWidth, HEIGHT), style = getComputedStyle(this.#canvas);
    if (context === null) return;
    this.#drawBars(context, style);
    this.#drawLine(context, style);
    this.#drawStrip(context, style);
  }

  #drawBars(context, style) {
    context.fillStyle = style.getPropertyValue("--bars");
    drawBars(context, {
      counts: this.#histogram, range: this.#range, x: (value) => this.#x(value), left: MARGIN, right: MARGIN + this.#width,
      base: this.#y(0), height: 0.92 * this.#plot,
    });
    drawValueAxis(context, { range: this.#shown, x: (value) => this.#x(value), left: MARGIN, right: MARGIN + this.#width, y: this.#y(0), color: style.getPropertyValue("--dim") });
    context.strokeStyle = style.getPropertyValue("--grid");
    context.lineWidth = 1;
    context.beginPath();
    for (const opacity of [0, 0.25, 0.5, 0.75, 1]) {
      const y = Math.round(this.#y(opacity)) + 0.5;
      context.moveTo(MARGIN, y);
      context.lineTo(MARGIN + this.#width, y);
    }
    context.stroke();
  }

  #drawLine(context, style) {
    const tf = this.#get(), left = MARGIN, right = MARGIN + this.#width, base = this.#y(0);
    context.save();
    context.beginPath();
    context.rect(0, 0, 2 * MARGIN + this.#width, HEIGHT);
    context.clip();
    context.beginPath();
    context.moveTo(left, this.#y(opacityAt(tf, this.#shown[0])));
    for (const [value, opacity] of tf.opacity) {
      const x = this.#x(value);
      if (x >= left && x <= right) context.lineTo(x, this.#y(opacity));
    }
    context.lineTo(right, this.#y(opacityAt(tf, this.#shown[1])));
    context.strokeStyle = style.getPropertyValue("--line");
    context.lineWidth = 2;
    context.lineJoin = "round";
    context.stroke();
    context.lineTo(right, base);
    context.lineTo(left, base);
    context.closePath();
    context.globalAlpha = 0.28;
    context.fillStyle = this.#gradient(context);
    context.fill();
    context.globalAlpha = 1;
    tf.opacity.forEach(([value, opacity], index) => {
      const chosen = this.selected.kind === "point" && this.selected.index === index;
      context.beginPath();
      context.arc(this.#x(value), this.#y(opacity), chosen ? 6 : 4.5, 0, 2 * Math.PI);
      context.fillStyle = hexOf(colorAt(tf, value));
      context.fill();
      context.lineWidth = chosen ? 2.5 : 1.5;
      context.strokeStyle = style.getPropertyValue(chosen ? "--accent" : "--line");
      context.stroke();
    });
    context.restore();
  }

  #gradient(context) {
    const tf = this.#get(), gradient = context.createLinearGradient(MARGIN, 0, MARGIN + this.#width, 0);
    for (let n = 0; n <= 64; n++) {
      const color = colorAt(tf, this.#shown[0] + (n / 64) * (this.#shown[1] - this.#shown[0]));
      gradient.addColorStop(n / 64, hexOf(color));
    }
    return gradient;
  }

  #drawStrip(context, style) {
    const top = HEIGHT - STRIP - MARGIN, tf = this.#get();
    context.fillStyle = this.#gradient(context);
    context.beginPath();
    context.roundRect(MARGIN, top, this.#width, STRIP, 3);
    context.fill();
    if (tf.color.length > 24) return; // a colormap has too many rows for a handle at each row
    tf.color.forEach(([value, ...color], index) => {
      const x = this.#x(value), chosen = this.selected.kind === "stop" && this.selected.index === index;
      if (x < 0 || x > this.#width + 2 * MARGIN) return;
      context.beginPath();
      context.roundRect(x - 4, top - 3, 8, STRIP + 6, 3);
      context.fillStyle = hexOf(color);
      context.fill();
      context.lineWidth = chosen ? 2.5 : 1.5;
      context.strokeStyle = style.getPropertyValue(chosen ? "--accent" : "--line");
      context.stroke();
    });
  }
}
