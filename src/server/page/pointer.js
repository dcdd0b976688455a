// The mouse and fingers on the picture, as in VTK and ParaView: a drag with the left button turns the camera;
// with ctrl, the drag rolls; with shift, or with the middle button, the drag pans. A drag with the right button
// and the wheel zoom. One finger turns the camera; two fingers pan, zoom and roll.

import { pan, roll, turn, zoom } from "./camera.js";

const TURN_OF_HEIGHT = Math.PI; // radians by which a drag over the picture's height turns
const WHEEL_FACTOR = 1.0015; // factor of zooming for each pixel of the wheel
const PINCH_SPEED = 6;

export class Pointer {
  #area;
  #store;
  #points = new Map(); // the positions [x, y] of the pressed pointers, by their pointer numbers
  #action = null;

  #nearest;

  // area: the element that pointers move over; nearest: the least distance of the eye from its
  // target.
  constructor(area, store, nearest) {
    this.#area = area;
    this.#nearest = nearest;
    this.#store = store;
    area.addEventListener("pointerdown", (event) => this.#down(event));
    area.addEventListener("pointermove", (event) => this.#move(event));
    for (const end of ["pointerup", "pointercancel", "lostpointercapture"])
      area.addEventListener(end, (event) => this.#points.delete(event.pointerId));
    area.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    area.addEventListener("contextmenu", (event) => event.preventDefault());
  }

  static #actionOf(event) {
    if (event.button === 1 || (event.button === 0 && event.shiftKey)) return "pan";
    if (event.button === 2) return "zoom";
    return event.ctrlKey || event.metaKey ? "roll" : "turn";
  }

  // Returns a place relative to the middle of the area, [right, up], in fractions of the area's
  // height.
  #fromMiddle(x, y) {
    const box = this.#area.getBoundingClientRect();
    return [(x - box.left - box.width / 2) / box.height, (box.top + box.height / 2 - y) / box.height];
  }

  #down(event) {
    this.#area.setPointerCapture(event.pointerId);
    this.#area.focus({ preventScroll: true });
    this.#points.set(event.pointerId, [event.clientX, event.clientY]);
    this.#action = Pointer.#actionOf(event);
    event.preventDefault();
  }

  #move(event) {
    const before = this.#points.get(event.pointerId);
    if (before === undefined) return;
    const now = [event.clientX, event.clientY];
    if (this.#points.size === 2) this.#pinch(event.pointerId, now);
    else if (this.#points.size === 1) this.#drag(before, now);
    this.#points.set(event.pointerId, now);
  }

  #drag(before, now) {
    const height = this.#area.clientHeight, camera = this.#store.scene.camera;
    const right = (now[0] - before[0]) / height, down = (now[1] - before[1]) / height;
    if (right === 0 && down === 0) return;
    let moved;
    if (this.#action === "pan") moved = pan(camera, right, -down);
    else if (this.#action === "zoom") moved = zoom(camera, Math.exp(-2.5 * down), [0, 0], this.#nearest);
    else if (this.#action === "roll") {
      const from = this.#fromMiddle(...before), to = this.#fromMiddle(...now);
      moved = roll(camera, Math.atan2(from[1], from[0]) - Math.atan2(to[1], to[0]));
    } else moved = turn(camera, -right * TURN_OF_HEIGHT, down * TURN_OF_HEIGHT);
    this.#store.setCamera(moved);
  }

  #pinch(moving, now) {
    const other = [...this.#points].find(([number]) => number !== moving)[1];
    const before = this.#points.get(moving), height = this.#area.clientHeight;
    const span = (p) => [p[0] - other[0], p[1] - other[1]];
    const [a, b] = [span(before), span(now)];
    const factor = Math.hypot(...b) / Math.max(Math.hypot(...a), 1);
    let camera = this.#store.scene.camera;
    camera = pan(camera, (now[0] - before[0]) / 2 / height, (before[1] - now[1]) / 2 / height);
    camera = roll(camera, Math.atan2(b[1], b[0]) - Math.atan2(a[1], a[0]));
    const middle = this.#fromMiddle((now[0] + other[0]) / 2, (now[1] + other[1]) / 2);
    this.#store.setCamera(zoom(camera, factor, middle, this.#nearest));
  }

  #wheel(event) {
    event.preventDefault();
    const pixels = event.deltaMode === 1 ? 30 * event.deltaY : event.deltaY;
    const cursor = this.#fromMiddle(event.clientX, event.clientY);
    // Browsers report a pinch on a trackpad as small wheel steps with ctrl.
    const speed = event.ctrlKey ? PINCH_SPEED : 1;
    this.#store.setCamera(zoom(this.#store.scene.camera, WHEEL_FACTOR ** (-pixels * speed), cursor, this.#nearest));
  }
}
