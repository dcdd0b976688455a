// The sky in the picture, while its panel is open: the horizon as a ring around the middle, a handle at the zenith, and
// on the ring one at the middle of the sky's image, which turns it.

import { axes } from "./camera.js";
import { make } from "./controls.js";
import { followDrag } from "./drag.js";
import { directionOf, steppedDirection, withDirection } from "./light.js";
import { hasUp, skyAxes } from "./sky.js";
import { add, dot, scale } from "./vector.js";

const STEPS = 120; // number of pieces of the ring
const KEY_STEP = 3; // degrees
// A place of the ring counts as farther from the pointer by this, for each radian away from the handle.
const FAR_SIDE = 0.02;

const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };

// The zenith as a light that shines from there, so that it is moved as lights are moved.
const asLight = (sky) => ({ type: "directional", direction: scale(skyAxes(sky).up, -1) });

export class SkyRing {
  #store;
  #sphere = { x: 0, y: 0, radius: 1 };
  #front = make("svg:path", { class: "sky-ring" });
  #back = make("svg:path", { class: "sky-ring behind" });
  #zenith = this.#handle("The sky's zenith", "M0-8L7 5H-7Z", (right, up) => this.moveZenith(right, up), (dx, dy) => this.#stepZenith(dx, dy));
  #turn = this.#handle("The rotation of the sky's image", "M0-7L7 0L0 7L-7 0Z", (right, up) => this.#turnTo(right, up), (dx, dy) => this.#turnBy((dx - dy) * KEY_STEP));
  element = make("svg:g", {}, this.#back, this.#front, this.#zenith, this.#turn);

  constructor(store) {
    this.#store = store;
  }

  get #sky() { return this.#store.scene.sky; }

  #change(name, part) {
    this.#store.change(`sky ${name}`, (scene) => ({ ...scene, sky: { ...scene.sky, ...part } }));
  }

  // sphere: { x, y, radius } of the picture's sphere of directions.
  draw(shown, sphere) {
    const visible = shown && hasUp(this.#sky);
    this.element.toggleAttribute("hidden", !visible);
    if (!visible) return;
    this.#sphere = sphere;
    const { up, right, middle } = skyAxes(this.#sky);
    const ring = Array.from({ length: STEPS + 1 }, (_, n) => {
      const angle = (n / STEPS) * 2 * Math.PI;
      return this.#seen(add(scale(right, Math.cos(angle)), scale(middle, Math.sin(angle))));
    });
    const path = (inFront) => ring.map(({ x, y, towards }, n) =>
      (n > 0 && (towards >= 0) === inFront ? `M${ring[n - 1].x} ${ring[n - 1].y}L${x} ${y}` : "")).join("");
    this.#front.setAttribute("d", path(true));
    this.#back.setAttribute("d", path(false));
    this.#place(this.#zenith, up);
    this.#turn.toggleAttribute("hidden", this.#sky.type !== "image");
    this.#place(this.#turn, middle);
    this.#turn.setAttribute("aria-valuenow", this.#sky.rotation_deg ?? 0);
    this.#zenith.setAttribute("aria-valuetext", `towards ${up.map((x) => x.toFixed(2)).join(", ")}`);
  }

  // The place of a direction in the picture; towards: above 0 on the viewer's side.
  #seen(direction) {
    const frame = axes(this.#store.scene.camera), { x, y, radius } = this.#sphere;
    return { x: x + radius * dot(direction, frame.right), y: y - radius * dot(direction, frame.up), towards: dot(direction, frame.towards) };
  }

  #place(handle, direction) {
    const { x, y, towards } = this.#seen(direction);
    handle.setAttribute("transform", `translate(${x} ${y})`);
    handle.classList.toggle("behind", towards < 0);
  }

  // right and up: on the sphere of radius 1; the zenith stays on the side that it is on.
  moveZenith(right, up) {
    const { camera } = this.#store.scene, far = Math.max(Math.hypot(right, up), 1), [x, y] = [right / far, up / far];
    const side = directionOf(asLight(this.#sky), camera)[2] < 0 ? -1 : 1;
    this.#setZenith([x, y, side * Math.sqrt(Math.max(1 - x * x - y * y, 0))]);
  }

  #stepZenith(dx, dy) {
    this.#setZenith(steppedDirection(directionOf(asLight(this.#sky), this.#store.scene.camera), dx, dy, KEY_STEP));
  }

  #setZenith(direction) {
    this.#change("up", { up: scale(withDirection(asLight(this.#sky), this.#store.scene.camera, direction).direction, -1) });
  }

  // Goes to the place of the ring that is nearest to the pointer. Where the ring looks like a line, it stays
  // on its side.
  #turnTo(right, up) {
    const { right: quarter, middle } = skyAxes(this.#sky), frame = axes(this.#store.scene.camera);
    let best = 0, least = Infinity;
    for (let degrees = -180; degrees < 180; degrees++) {
      const angle = (degrees * Math.PI) / 180, at = add(scale(middle, Math.cos(angle)), scale(quarter, -Math.sin(angle)));
      const away = Math.hypot(dot(at, frame.right) - right, dot(at, frame.up) - up) + FAR_SIDE * Math.abs(angle);
      if (away < least) [best, least] = [degrees, away];
    }
    this.#turnBy(best);
  }

  #turnBy(degrees) {
    const turned = (this.#sky.rotation_deg ?? 0) + degrees;
    this.#change("rotation", { rotation_deg: turned - 360 * Math.round(turned / 360) });
  }

  #handle(label, d, move, step) {
    return make("svg:g", {
      class: "sky-handle", tabindex: 0, role: "slider", "aria-label": label, "aria-valuemin": -180, "aria-valuemax": 180, "aria-valuenow": 0,
      onpointerdown: (event) => this.#grab(event, move),
      onkeydown: (event) => {
        if (!ARROWS[event.key]) return;
        step(...ARROWS[event.key]);
        event.preventDefault();
        event.stopPropagation();
      },
    }, make("svg:path", { d }), make("svg:circle", { class: "target", r: 12 }));
  }

  #grab(event, move) {
    event.stopPropagation();
    event.preventDefault();
    const target = event.currentTarget, box = target.ownerSVGElement.getBoundingClientRect();
    target.focus({ preventScroll: true });
    followDrag(event, target, (moved) => {
      const { x, y, radius } = this.#sphere;
      move((moved.clientX - box.left - x) / radius, (y - moved.clientY + box.top) / radius);
    });
  }
}
