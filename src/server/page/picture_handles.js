// Handles over the picture: small squares that are dragged, or moved by arrow keys, along one or two directions of the scene.
//
// A handle is { label, kind, at, ways, move }. kind: a name for the style sheet. at: the handle's point in the scene. ways:
// the directions in which the handle moves, each { to, size, low, high, now }. A way has a coordinate: now is its present
// value, low and high are its bounds, and an increase by `size` brings the handle to the point `to`. move(steps): moves the
// handle; steps: the increase of each way's coordinate since the handle was made.

import { make } from "./controls.js";
import { followDrag } from "./drag.js";

const KEY_STEP = 0.02; // how far an arrow key moves a handle, as a fraction of the way from low to high
const MARGIN = 14; // pixels between a handle and the picture's edge
const KEYS = { ArrowLeft: [0, -1], ArrowRight: [0, 1], ArrowDown: [1, -1], ArrowUp: [1, 1] }; // [index of the way, sign]

// Moves a place towards another place until it lies in the picture, so that a point beyond the picture's
// edge still has a handle.
function within([x, y], [towardsX, towardsY], width, height) {
  const part = (from, to, most) => {
    const inside = Math.min(Math.max(from, MARGIN), most - MARGIN);
    return inside === from || to === from ? 0 : (inside - from) / (to - from);
  };
  const t = Math.min(Math.max(part(x, towardsX, width), part(y, towardsY, height), 0), 1);
  return [x + t * (towardsX - x), y + t * (towardsY - y)];
}

// Splits a movement of the pointer into movements along the ways, as fractions of each way's length in pixels. Null:
// no way is visible, because all run along the line of sight.
function partsOf(ways, [x, y]) {
  const [a, b] = ways, square = a[0] ** 2 + a[1] ** 2;
  if (ways.length === 1) return square > 1e-3 ? [(x * a[0] + y * a[1]) / square] : null;
  const area = a[0] * b[1] - a[1] * b[0];
  return Math.abs(area) > 1e-3 ? [(x * b[1] - y * b[0]) / area, (a[0] * y - a[1] * x) / area] : null;
}

export class PictureHandles {
  #className;
  #handles = [];
  #project;
  element = make("svg:g");

  constructor(className) {
    this.#className = className;
  }

  // Draws the handles. handles: an empty list hides all handles. middle: the point of the scene towards which
  // handles beyond the picture's edge are moved.
  draw(handles, project, middle, width, height) {
    this.#handles = handles;
    this.#project = project;
    while (this.element.childElementCount > handles.length) this.element.lastElementChild.remove();
    while (this.element.childElementCount < handles.length) this.element.append(this.#make(this.element.childElementCount));
    const towards = project(middle);
    handles.forEach((handle, n) => {
      const square = this.element.children[n], place = project(handle.at), at = place && towards ? within(place, towards, width, height) : null;
      square.toggleAttribute("hidden", at === null);
      if (at !== null) square.setAttribute("transform", `translate(${at[0]} ${at[1]})`);
      const { low, high, now } = handle.ways[0];
      const said = { class: `${this.#className} ${handle.kind}`, "aria-label": handle.label, "aria-valuemin": low, "aria-valuemax": high, "aria-valuenow": now };
      for (const [key, value] of Object.entries(said)) square.setAttribute(key, value);
    });
  }

  #make(n) {
    return make("svg:g", {
      tabindex: 0, role: "slider", onpointerdown: (event) => this.#grab(event, this.#handles[n]), onkeydown: (event) => this.#key(event, this.#handles[n]),
    }, make("svg:rect", { class: "target", x: -12, y: -12, width: 24, height: 24 }), make("svg:rect", { class: "square", x: -6, y: -6, width: 12, height: 12, rx: 3 }));
  }

  #grab(event, handle) {
    event.stopPropagation();
    event.preventDefault();
    const target = event.currentTarget, from = this.#project(handle.at), ends = handle.ways.map(({ to }) => this.#project(to));
    target.focus({ preventScroll: true });
    if (from === null || ends.includes(null)) return;
    const ways = ends.map((end) => [end[0] - from[0], end[1] - from[1]]);
    followDrag(event, target, (moved) => {
      const parts = partsOf(ways, [moved.clientX - event.clientX, moved.clientY - event.clientY]);
      if (parts !== null) handle.move(parts.map((part, n) => part * handle.ways[n].size));
    });
  }

  #key(event, handle) {
    if (!(event.key in KEYS)) return;
    const [wanted, sign] = KEYS[event.key], way = Math.min(wanted, handle.ways.length - 1), { low, high } = handle.ways[way];
    handle.move(handle.ways.map((_, n) => (n === way ? sign * KEY_STEP * (high - low) : 0)));
    event.preventDefault();
    event.stopPropagation();
  }
}
