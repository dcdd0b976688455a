// The view of one plane through the volume, beside the picture: it draws the plane's greys, labels and isolines and the
// crosshair, and handles the pointer and the keyboard. A click moves the crosshair. A drag does what the panel of slices chooses
// for it (DRAGS in slices.js); a drag with the right button (or alt + drag) changes window and level. A drag with shift pans.
// The wheel moves to other planes. ctrl + wheel or two fingers zoom. With the keyboard, arrow keys move the crosshair.

import { isActive, make } from "./controls.js";
import { drawSections } from "./cut_sections.js";
import { planeTitle, sampleAt, samplePoint } from "./sections.js";
import { isolines, paint } from "./slice_values.js";
import { subtract } from "./vector.js";

const WHEEL_FACTOR = 1.0015; // factor of zooming for each pixel of the wheel
const WHEEL_STEP = 40; // pixels of the wheel that move the view by one plane
const DRAG_STEP = 8; // pixels of a drag that move the view by one plane
const STILL = 6; // pixels that a finger may move during a tap
const LEAST_ZOOM = 0.2, MOST_ZOOM = 60;
const EDGE = 14; // pixels from a line of the crosshair to a letter beside it
const SMOOTH_UP_TO = 3; // voxels that are at most this many pixels large on the screen are interpolated; larger voxels are drawn as squares

export class SliceView {
  #slices;
  #name;
  #canvas = make("canvas");
  #svg = make("svg:svg", { class: "slice-overlay" });
  #title = make("figcaption");
  #greys = document.createElement("canvas");
  #lines = [];
  #drawn = null; // the values and settings from which the greys are drawn
  #zoom = 1;
  #pan = [0, 0]; // pixels
  #points = new Map(); // the positions [x, y] of the pressed pointers
  #action = null; // one of DRAGS, or "pinch", or "none": the rest of the drag has no effect
  #tapped = null; // the place where a finger was pressed, while the finger has not moved
  #wheeled = 0; // pixels of the wheel or of a drag that have not moved the view by a plane yet
  marks = make("svg:g");

  // slices: an object of class Slices (slices.js). name: the plane's name.
  constructor(slices, name) {
    this.#slices = slices;
    this.#name = name;
    this.#svg.append(make("svg:path", { class: "crosshair", "aria-hidden": "true" }), make("svg:g", { "aria-hidden": "true" }), this.marks);
    this.area = make("div", { class: "slice-area", tabindex: 0, role: "application" }, this.#canvas, this.#svg);
    this.element = make("figure", { class: "slice", "data-plane": name }, this.area, this.#title);
    this.area.addEventListener("pointerdown", (event) => this.#down(event));
    this.area.addEventListener("pointermove", (event) => this.#move(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
      this.area.addEventListener(end, (event) => this.#up(event));
    this.area.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    this.area.addEventListener("contextmenu", (event) => event.preventDefault());
    this.area.addEventListener("keydown", (event) => this.#key(event));
    this.area.addEventListener("dblclick", () => this.#slices.finishMark());
    new ResizeObserver(() => this.draw()).observe(this.area);
  }

  get name() { return this.#name; }
  set name(name) {
    if (name === this.#name) return;
    this.#name = name;
    this.element.dataset.plane = name;
    this.reset();
  }

  reset() {
    [this.#zoom, this.#pan] = [1, [0, 0]];
    this.draw();
  }

  // ---- places ----

  get #plane() { return this.#slices.shown(this.#name)?.plane ?? null; }

  // Returns { x, y, left, top }. x, y: the size of a sample in pixels of the screen. left, top: the place
  // of the middle of sample 0, 0.
  #fit() {
    const { width, height, pitch } = this.#plane, wide = this.area.clientWidth, tall = this.area.clientHeight;
    const scale = this.#zoom * Math.min(wide / (width * pitch[0]), tall / (height * pitch[1])), x = scale * pitch[0], y = scale * pitch[1];
    return { x, y, left: (wide - (width - 1) * x) / 2 + this.#pan[0], top: (tall - (height - 1) * y) / 2 + this.#pan[1] };
  }

  // Returns the point of the scene under a place [x, y] of the area.
  pointAt([x, y]) {
    const fit = this.#fit();
    return samplePoint(this.#plane, this.#slices.source, (x - fit.left) / fit.x, (y - fit.top) / fit.y);
  }

  // Returns [x, y, layers] for a point of the scene. layers: the point's distance from the plane, in layers.
  // Null: no plane is shown yet.
  project(point) {
    if (this.#plane === null || this.#slices.source === null) return null;
    const [column, row, layers] = sampleAt(this.#plane, this.#slices.source, point), fit = this.#fit();
    return [fit.left + column * fit.x, fit.top + row * fit.y, layers];
  }

  // Returns the directions across and up on the screen, as vectors of the scene with the lengths of
  // the plane's sides.
  directions() {
    const plane = this.#plane, at = (column, row) => samplePoint(plane, this.#slices.source, column, row);
    return [subtract(at(plane.width, 0), at(0, 0)), subtract(at(0, 0), at(0, plane.height))];
  }

  // The number of layers from the plane within which a mark lies in it.
  get halfDepth() { return this.#plane.depth / 2 + 1e-6; }

  #place(event) {
    const box = this.area.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  // ---- the drawing ----

  draw() {
    const wide = this.area.clientWidth, tall = this.area.clientHeight, shown = this.#slices.shown(this.#name), { grid } = this.#slices.source ?? {};
    if (wide === 0 || tall === 0 || !grid) return;
    const title = planeTitle(this.#name, grid);
    this.#title.textContent = title;
    this.area.setAttribute("aria-label", `${title} slice. Arrow keys move the crosshair, Page Up and Page Down go through the slices, plus and minus zoom, Alt with arrow keys changes window and level.`);
    if (!shown || this.#plane === null) return;
    const density = devicePixelRatio || 1, look = this.#slices.look();
    if (this.#drawn?.shown !== shown || this.#drawn.look !== look.key) {
      paint(this.#greys, shown, look.window, look.maps, look.isAlone);
      this.#lines = look.surfaces.length > 0 ? isolines(shown, look.surfaces) : [];
      this.#drawn = { shown, look: look.key };
    }
    this.#canvas.width = wide * density;
    this.#canvas.height = tall * density;
    const context = this.#canvas.getContext("2d"), fit = this.#fit(), { width, height } = this.#plane;
    context.scale(density, density);
    context.imageSmoothingEnabled = Math.max(fit.x, fit.y) < SMOOTH_UP_TO;
    context.drawImage(this.#greys, fit.left - fit.x / 2, fit.top - fit.y / 2, width * fit.x, height * fit.y);
    this.#drawLines(context, fit);
    this.#drawCuts(context, fit, density);
    this.#drawCrosshair(wide, tall);
    this.#slices.drawMarks(this);
  }

  #drawLines(context, fit) {
    context.lineWidth = 1.5;
    for (const { color, pieces } of this.#lines) {
      context.strokeStyle = color;
      context.beginPath();
      for (let n = 0; n < pieces.length; n += 4) {
        context.moveTo(fit.left + pieces[n] * fit.x, fit.top + pieces[n + 1] * fit.y);
        context.lineTo(fit.left + pieces[n + 2] * fit.x, fit.top + pieces[n + 3] * fit.y);
      }
      context.stroke();
    }
  }

  // Dims the parts that cuts and clip boxes remove.
  #drawCuts(context, fit, density) {
    const { width, height } = this.#plane, [x, y, left, top] = [fit.x, fit.y, fit.left, fit.top].map((part) => density * part);
    context.setTransform(1, 0, 0, 1, 0, 0);
    drawSections(context, this.#slices.sections(this.#plane), { x, y, left, top }, [left - x / 2, top - y / 2, width * x, height * y], density);
  }

  #drawCrosshair(wide, tall) {
    const [cross, letters] = this.#svg.children, [x, y] = this.project(this.#slices.cursor), gap = 7;
    cross.setAttribute("d", `M0 ${y}H${x - gap}M${x + gap} ${y}H${wide}M${x} 0V${y - gap}M${x} ${y + gap}V${tall}`);
    const [left, right, upper, lower] = this.#plane.edges;
    const beside = (at, line) => (Math.abs(at - line) < EDGE ? line + EDGE : at), across = beside(wide / 2, x), down = beside(tall / 2, y); // keeps the letters away from the crosshair's lines
    const places = [[left, 10, down], [right, wide - 10, down], [upper, across, 12], [lower, across, tall - 10]];
    letters.replaceChildren(...places.map(([text, lx, ly]) => make("svg:text", { x: lx, y: ly, class: "edge" }, text)));
  }

  // ---- hands ----

  #down(event) {
    if (this.#plane === null) return;
    event.preventDefault();
    this.area.focus({ preventScroll: true });
    this.area.setPointerCapture(event.pointerId);
    const at = this.#place(event);
    this.#points.set(event.pointerId, at);
    this.#tapped = null;
    if (this.#points.size > 1) this.#action = "pinch";
    else if (event.pointerType === "touch") [this.#action, this.#tapped] = [this.#slices.drag, at]; // a second finger may follow
    else this.#press(at, this.#actionOf(event));
  }

  #actionOf(event) {
    if (event.button === 2 || (event.button === 0 && event.altKey)) return "window";
    return event.button === 1 || event.shiftKey ? "pan" : this.#slices.drag;
  }

  // Handles the press of a pointer: adds a point to the mark that is being made, or moves the crosshair if
  // drags move the crosshair.
  #press(at, action) {
    this.#action = action;
    this.#wheeled = 0;
    if (action === "cursor") this.#point(at);
  }

  #point(at) {
    if (this.#slices.addPoint(this.pointAt(at))) this.#action = "none";
    else this.#slices.moveTo(this.pointAt(at));
  }

  #up(event) {
    const tapped = event.type === "pointerup" && this.#points.size === 1 ? this.#tapped : null;
    this.#points.delete(event.pointerId);
    this.#tapped = null;
    if (tapped !== null) this.#point(tapped);
  }

  #move(event) {
    const before = this.#points.get(event.pointerId), now = this.#place(event);
    if (before === undefined || this.#plane === null) return;
    if (this.#tapped !== null) {
      if (Math.hypot(now[0] - this.#tapped[0], now[1] - this.#tapped[1]) <= STILL) return;
      const from = this.#tapped;
      this.#tapped = null;
      this.#press(from, this.#action);
    }
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    if (this.#points.size === 2) this.#pinch(event.pointerId, now);
    else if (this.#action === "window") this.#slices.changeWindow(dx / this.area.clientWidth, dy / this.area.clientHeight);
    else if (this.#action === "planes") this.#scrollBy(dy, DRAG_STEP);
    else if (this.#action === "pan") this.#panBy(dx, dy);
    else if (this.#action === "cursor") this.#slices.moveTo(this.pointAt(now));
    this.#points.set(event.pointerId, now);
  }

  #panBy(dx, dy) {
    this.#pan = [this.#pan[0] + dx, this.#pan[1] + dy];
    this.draw();
  }

  #pinch(moving, now) {
    const other = [...this.#points].find(([number]) => number !== moving)[1], before = this.#points.get(moving);
    const span = (p) => Math.max(Math.hypot(p[0] - other[0], p[1] - other[1]), 1);
    this.#zoomBy(span(now) / span(before), [(now[0] + other[0]) / 2, (now[1] + other[1]) / 2]);
    this.#panBy((now[0] - before[0]) / 2, (now[1] - before[1]) / 2);
  }

  // Zooms such that the sample under the cursor keeps its place.
  #zoomBy(factor, [x, y]) {
    const zoom = Math.min(Math.max(this.#zoom * factor, LEAST_ZOOM), MOST_ZOOM), part = zoom / this.#zoom;
    const middle = [this.area.clientWidth / 2, this.area.clientHeight / 2];
    this.#pan = [x, y].map((at, k) => (at - middle[k]) * (1 - part) + this.#pan[k] * part);
    this.#zoom = zoom;
    this.draw();
  }

  #wheel(event) {
    event.preventDefault();
    if (this.#plane === null) return;
    const pixels = event.deltaMode === 1 ? 30 * event.deltaY : event.deltaY;
    if (event.ctrlKey || event.metaKey) { // browsers report a trackpad's pinch as a wheel with ctrl, too
      this.#zoomBy(WHEEL_FACTOR ** (-3 * pixels), this.#place(event));
      return;
    }
    this.#scrollBy(pixels, WHEEL_STEP);
  }

  // Moves the view to other planes. pixels: the movement of the wheel or of a drag. step: the
  // pixels for one plane.
  #scrollBy(pixels, step) {
    this.#wheeled += pixels;
    const planes = Math.trunc(this.#wheeled / step);
    this.#wheeled -= planes * step;
    if (planes !== 0) this.#scroll(planes);
  }

  #scroll(planes) {
    this.#step(0, 0, planes);
  }

  // Moves the crosshair by whole columns, rows and planes. The crosshair may be some planes ahead of the shown plane, whose
  // values arrive later.
  #step(columns, rows, planes) {
    const [column, row, layer] = sampleAt(this.#plane, this.#slices.source, this.#slices.cursor);
    this.#slices.moveTo(samplePoint(this.#plane, this.#slices.source, column + columns, row + rows, Math.round(layer) + planes));
  }

  #key(event) {
    if (this.#plane === null || event.ctrlKey || event.metaKey || !isActive(this.area)) return;
    const far = event.shiftKey ? 10 : 1, arrows = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far] }[event.key];
    const middle = [this.area.clientWidth / 2, this.area.clientHeight / 2];
    if (arrows && event.altKey) this.#slices.changeWindow(arrows[0] / 50, arrows[1] / 50);
    else if (arrows) this.#step(...arrows, 0);
    else if (event.key === "PageUp" || event.key === "PageDown") this.#scroll(event.key === "PageUp" ? far : -far);
    else if (event.key === "+" || event.key === "-") this.#zoomBy(event.key === "+" ? 1.25 : 0.8, middle);
    else if (event.key === "Home") this.reset();
    else if (event.key === "Enter") { if (!this.#slices.enter()) return; }
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
