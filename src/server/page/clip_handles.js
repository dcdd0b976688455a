// Handles of the clip box: a square in the middle of each of its six faces, dragged along the face's axis.

import { projector } from "./camera.js";
import { placed, worldBox } from "./boxes.js";
import { make } from "./controls.js";

const FACES = [0, 1, 2].flatMap((axis) => [["min", axis], ["max", axis]]);
const KEY_STEP = 0.02; // of the volume's length
const MARGIN = 14; // pixels between a handle and the picture's edge

// A place, moved towards the box's middle until it lies in the picture: a face beyond the edge keeps its handle.
function within([x, y], [towardsX, towardsY], width, height) {
  const part = (from, to, most) => {
    const inside = Math.min(Math.max(from, MARGIN), most - MARGIN);
    return inside === from || to === from ? 0 : (inside - from) / (to - from);
  };
  const t = Math.min(Math.max(part(x, towardsX, width), part(y, towardsY, height), 0), 1);
  return [x + t * (towardsX - x), y + t * (towardsY - y)];
}

export class ClipHandles {
  #viewer;
  #handles;
  element = make("svg:g");

  constructor(viewer) {
    this.#viewer = viewer;
    this.#handles = FACES.map(([end, axis]) => make("svg:rect", {
      class: `clip-handle axis-${axis}`, x: -6, y: -6, width: 12, height: 12, rx: 3, tabindex: 0, role: "slider",
      "aria-label": `Clip ${"xyz"[axis]}, ${end === "min" ? "least" : "greatest"}, in the picture`,
      onpointerdown: (event) => this.#grab(event, end, axis), onkeydown: (event) => this.#key(event, end, axis),
    }));
    this.element.append(...this.#handles);
  }

  get #volume() { return this.#viewer.store.scene.volumes[this.#viewer.current.volume]; }
  get #whole() { return worldBox(this.#viewer.start.volumes[this.#viewer.current.volume]); }
  get #box() { return this.#volume.clip ?? this.#whole; }

  // The middle of a face, in the file's world.
  #middle(box, end, axis) {
    return [0, 1, 2].map((k) => (k === axis ? box[end][k] : (box.min[k] + box.max[k]) / 2));
  }

  draw(shown, width, height) {
    this.element.toggleAttribute("hidden", !shown);
    if (!shown) return;
    const project = projector(this.#viewer.store.scene.camera, width, height), box = this.#box, whole = this.#whole;
    const middle = project(placed([0, 1, 2].map((k) => (box.min[k] + box.max[k]) / 2), this.#volume.transform));
    FACES.forEach(([end, axis], n) => {
      const face = project(placed(this.#middle(box, end, axis), this.#volume.transform)), handle = this.#handles[n];
      const at = face && middle ? within(face, middle, width, height) : null;
      handle.toggleAttribute("hidden", at === null);
      if (at !== null) handle.setAttribute("transform", `translate(${at[0]} ${at[1]})`);
      handle.setAttribute("aria-valuemin", whole.min[axis]);
      handle.setAttribute("aria-valuemax", whole.max[axis]);
      handle.setAttribute("aria-valuenow", box[end][axis]);
    });
  }

  // Moves a face to a place along its axis, within the volume and not past the other face.
  move(end, axis, value) {
    const whole = this.#whole, { min, max } = this.#box, gap = (whole.max[axis] - whole.min[axis]) / 200;
    const clip = { min: [...min], max: [...max] };
    clip[end][axis] = end === "min" ? Math.min(Math.max(value, whole.min[axis]), max[axis] - gap)
                                    : Math.max(Math.min(value, whole.max[axis]), min[axis] + gap);
    this.#viewer.store.changeVolume(this.#viewer.current.volume, `clip ${axis}`, (volume) => ({ ...volume, clip }));
  }

  #grab(event, end, axis) {
    event.stopPropagation();
    event.preventDefault();
    const target = event.currentTarget, svg = target.ownerSVGElement, box = this.#box, began = box[end][axis];
    const project = projector(this.#viewer.store.scene.camera, svg.clientWidth, svg.clientHeight);
    const at = (value) => project(placed(this.#middle({ ...box, [end]: box[end].map((x, k) => (k === axis ? value : x)) }, end, axis), this.#volume.transform));
    const unit = (this.#whole.max[axis] - this.#whole.min[axis]) / 100, from = at(began), to = at(began + unit);
    target.focus({ preventScroll: true });
    target.setPointerCapture(event.pointerId);
    const along = from && to ? [to[0] - from[0], to[1] - from[1]] : [0, 0], square = along[0] ** 2 + along[1] ** 2;
    const move = (moved) => {
      const [x, y] = [moved.clientX - event.clientX, moved.clientY - event.clientY];
      if (square > 1e-3) this.move(end, axis, began + (unit * (x * along[0] + y * along[1])) / square);
    };
    target.addEventListener("pointermove", move);
    for (const over of ["pointerup", "pointercancel"])
      target.addEventListener(over, () => target.removeEventListener("pointermove", move), { once: true });
  }

  #key(event, end, axis) {
    const steps = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 };
    if (!(event.key in steps)) return;
    this.move(end, axis, this.#box[end][axis] + steps[event.key] * KEY_STEP * (this.#whole.max[axis] - this.#whole.min[axis]));
    event.preventDefault();
    event.stopPropagation();
  }
}
