// The drawings over the picture: orientation marker, scale bar, clip box, cuts, and the handles of lights.

import { axes, projector, worldHeight } from "./camera.js";
import { corners, edges, placed, worldBox } from "./boxes.js";
import { ClipHandles } from "./clip_handles.js";
import { CutHandles } from "./cut_handles.js";
import { hexOf } from "./color.js";
import { make, shortNumber } from "./controls.js";
import { followDrag } from "./drag.js";
import { directionOf, sizeOf, steppedDirection, withDirection, withSize } from "./light.js";
import { SkyRing } from "./sky_ring.js";
import { symbolOf } from "./units.js";

const MARKER = { size: 34, left: 64, bottom: 64, roomy: 360, letter: 24 }; // pixels; the marker is smaller in a picture whose shorter side is below `roomy`
const BAR_WIDTH = 140, LEAST_BAR = 20; // pixels: the greatest width of the scale bar, and the width that the bar may have even where there is no room
// Radius of the sphere on which lights are moved, as a fraction of the picture's shorter side.
const SPHERE_OF_HEIGHT = 0.42;
const RING_PER_DEGREE = 1.6; // a handle's ring has this radius in pixels for each degree of the light's size
const RING_LEAST = 15;
const KEY_STEP = 3; // degrees

const AXIS_NAMES = { RAS: ["R", "A", "S"], LPS: ["L", "P", "S"], LAS: ["L", "A", "S"] };

// Returns the greatest length of the form 1, 2 or 5 times a power of ten that is at most `most`.
export function roundLength(most) {
  const power = 10 ** Math.floor(Math.log10(most));
  return [5, 2, 1].map((n) => n * power).find((x) => x <= most * 1.0000001);
}

// Returns the unit of lengths of the world, with a space in front, such as " mm". The unit is known if a volume's file tells it,
// no other volume tells another unit, and no volume is scaled. If no file tells a unit, the user's unit is taken. "": the unit is
// not known.
function unitOf({ scene, page }, volumes) {
  const told = new Set(volumes.map((volume) => symbolOf(volume?.unit)).filter(Boolean));
  if (told.size === 0 && page.unit) told.add(symbolOf(page.unit));
  return told.size === 1 && scene.volumes.every(({ transform }) => (transform?.scale ?? 1) === 1) ? ` ${[...told][0]}` : "";
}

export class Overlay {
  #svg;
  #store;
  #start;
  #showLights = false;
  #lights = make("svg:g");
  #marker = make("svg:g", { class: "marker", "aria-hidden": "true" });
  #bar = make("svg:g", { class: "scale", "aria-hidden": "true" });
  #box = make("svg:path", { class: "clip-box", "aria-hidden": "true" });
  #clip;
  #cuts = [];
  #sky;
  #current;
  #width = 1;
  #height = 1;
  #showBox = false;
  #showSky = false;

  constructor(svg, viewer) {
    const { store, start, current } = viewer;
    this.#current = current;
    this.#svg = svg;
    this.#store = store;
    this.#start = start;
    this.#clip = new ClipHandles(viewer);
    this.#sky = new SkyRing(store);
    svg.append(this.#box, this.#marker, this.#bar, this.#sky.element, this.#lights, this.#clip.element);
    store.listen(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(svg);
  }

  get showsLights() { return this.#showLights; }
  set showsLights(shows) {
    this.#showLights = shows;
    this.draw();
  }

  // Sets whether the edges of the volumes' boxes and the handles of the chosen volume's clip box
  // are shown.
  set showsBox(shows) {
    this.#showBox = shows;
    this.draw();
  }

  // Sets whether the sky's horizon and handles are shown.
  set showsSky(shows) {
    this.#showSky = shows;
    this.draw();
  }

  // Adds the handles of a cut. The handles are visible while `source` has a cut (cut_handles.js).
  addCut(source) {
    const handles = new CutHandles(source);
    this.#cuts.push(handles);
    this.#svg.append(handles.path, handles.element);
  }

  draw() {
    this.#width = this.#svg.clientWidth;
    this.#height = this.#svg.clientHeight;
    if (this.#height === 0) return; // the picture has no size yet
    this.#drawMarker();
    this.#drawBar();
    this.#drawBox();
    const project = projector(this.#store.scene.camera, this.#width, this.#height);
    this.#clip.drawClip(this.#showBox && this.#start.volumes.length > 0, project, this.#width, this.#height);
    this.#cuts.forEach((cut) => cut.drawCut(project, this.#width, this.#height));
    this.#sky.draw(this.#showSky, this.#sphere());
    this.#drawLights();
  }

  // The marker's size in this picture, as a fraction of its full size.
  get #markerPart() { return Math.min(Math.max(Math.min(this.#width, this.#height) / MARKER.roomy, 0.5), 1); }

  #drawMarker() {
    const frame = axes(this.#store.scene.camera);
    const names = AXIS_NAMES[this.#start.volumes[0]?.space] ?? ["x", "y", "z"];
    const part = this.#markerPart, size = part * MARKER.size;
    const middle = [part * MARKER.left, this.#height - part * MARKER.bottom];
    const arrows = [0, 1, 2].map((k) => ({ k, right: frame.right[k], up: frame.up[k], depth: frame.towards[k] }));
    arrows.sort((a, b) => a.depth - b.depth);
    this.#marker.replaceChildren(...arrows.flatMap(({ k, right, up, depth }) => {
      const tip = [middle[0] + size * right, middle[1] - size * up];
      const name = [middle[0] + (size + 12) * right, middle[1] - (size + 12) * up];
      const style = `axis axis-${k}${depth < -0.2 ? " far" : ""}`;
      const text = make("svg:text", { x: name[0], y: name[1], class: style }, names[k]);
      return [make("svg:line", { x1: middle[0], y1: middle[1], x2: tip[0], y2: tip[1], class: style }), text];
    }));
  }

  #drawBar() {
    const perPixel = worldHeight(this.#store.scene.camera) / this.#height;
    const right = this.#width - 24, room = right - this.#markerPart * (MARKER.left + MARKER.size) - MARKER.letter; // the pixels between the marker and the right edge
    const size = roundLength(Math.min(BAR_WIDTH, Math.max(room, LEAST_BAR)) * perPixel), pixels = size / perPixel, y = this.#height - 26;
    const path = `M${right - pixels} ${y - 5}v5h${pixels}v-5`;
    this.#bar.replaceChildren(
      make("svg:path", { d: path, class: "halo" }), make("svg:path", { d: path }),
      make("svg:text", { x: right - pixels / 2, y: y - 8 }, shortNumber(size) + unitOf(this.#store, this.#start.volumes)));
  }

  #drawBox() {
    const project = projector(this.#store.scene.camera, this.#width, this.#height);
    const lines = this.#store.scene.volumes.flatMap((volume, v) => {
      if (!this.#showBox || !this.#start.volumes[v]) return [];
      const points = corners(volume.clip ?? worldBox(this.#start.volumes[v])).map((point) => project(placed(point, volume.transform)));
      return edges.filter(([a, b]) => points[a] && points[b]).map(([a, b]) => `M${points[a]}L${points[b]}`);
    });
    this.#box.setAttribute("d", lines.join(""));
  }

  // ---- lights ----

  #sphere() {
    return { x: this.#width / 2, y: this.#height / 2, radius: SPHERE_OF_HEIGHT * Math.min(this.#width, this.#height) };
  }

  #drawLights() {
    const { lights, camera } = this.#store.scene, sphere = this.#sphere();
    this.#svg.classList.toggle("with-lights", this.#showLights);
    if (!this.#showLights) {
      this.#lights.replaceChildren();
      return;
    }
    if (this.#lights.childElementCount === 0) this.#lights.append(make("svg:circle", { class: "light-sphere" }));
    while (this.#lights.childElementCount > lights.length + 1) this.#lights.lastElementChild.remove();
    while (this.#lights.childElementCount < lights.length + 1) this.#lights.append(this.#makeHandle(this.#lights.childElementCount - 1)); // the focus stays where it is
    const rim = this.#lights.firstElementChild;
    for (const [key, value] of [["cx", sphere.x], ["cy", sphere.y], ["r", sphere.radius]]) rim.setAttribute(key, value);
    lights.forEach((light, l) => this.#placeHandle(this.#lights.children[l + 1], light, l, camera, sphere));
  }

  #placeHandle(handle, light, l, camera, sphere) {
    const [right, up, towards] = directionOf(light, camera), size = sizeOf(light, camera);
    const [ring, dot] = handle.children;
    handle.setAttribute("transform", `translate(${sphere.x + right * sphere.radius} ${sphere.y - up * sphere.radius})`);
    // The handle of a light without shadows is hidden unless the light is chosen: a fill light from
    // the eye would have its handle in the picture's middle, where users drag to turn the picture.
    handle.toggleAttribute("hidden", light.shadows === "off" && l !== this.#current.light);
    handle.setAttribute("class", `light${towards < 0 ? " behind" : ""}${l === this.#current.light ? " chosen" : ""}`);
    handle.setAttribute("aria-valuetext",
      `${Math.round((Math.atan2(right, towards) * 180) / Math.PI)} degrees right, ` +
      `${Math.round((Math.asin(Math.min(Math.max(up, -1), 1)) * 180) / Math.PI)} degrees up, ` +
      `${Math.round(size)} degrees wide`);
    ring.setAttribute("r", RING_LEAST + RING_PER_DEGREE * size);
    dot.setAttribute("fill", hexOf(light.color.map((c) => c / Math.max(...light.color, 1e-9))));
  }

  #makeHandle(l) {
    const ring = make("svg:circle", { class: "light-ring", onpointerdown: (event) => this.#grab(event, l, "size") });
    const dot = make("svg:circle", { class: "light-dot", r: 9, onpointerdown: (event) => this.#grab(event, l, "place") });
    const target = make("svg:circle", { class: "target", r: 12, onpointerdown: (event) => this.#grab(event, l, "place") });
    return make("svg:g", {
      class: "light", tabindex: 0, role: "slider", "aria-label": `Light ${l + 1}`, "aria-valuenow": l + 1, "data-light": l,
      onkeydown: (event) => this.#key(event, l), // the focus alone does not choose a light, because the focus also comes back when the window comes to the front
    }, ring, dot, target);
  }

  #choose(l) {
    if (this.#current.light !== l) this.#current.choose("light", l);
  }

  // Starts a drag of a light's handle. A drag of the dot moves the light over the sphere; beyond the
  // sphere's rim, the light moves behind the scene. A drag of the ring changes the light's size.
  #grab(event, l, what) {
    event.stopPropagation();
    event.preventDefault();
    this.#choose(l);
    const handle = event.currentTarget.parentNode, target = event.currentTarget;
    handle.focus({ preventScroll: true });
    const box = this.#svg.getBoundingClientRect(), sphere = this.#sphere();
    const began = { right: (event.clientX - box.left - sphere.x) / sphere.radius, up: (sphere.y - event.clientY + box.top) / sphere.radius };
    const before = directionOf(this.#store.scene.lights[l], this.#store.scene.camera);
    const offset = { right: before[0] - began.right, up: before[1] - began.up };
    followDrag(event, target, (moved) => {
      const right = (moved.clientX - box.left - sphere.x) / sphere.radius + (what === "place" ? offset.right : 0);
      const up = (sphere.y - moved.clientY + box.top) / sphere.radius + (what === "place" ? offset.up : 0);
      if (what === "place") this.moveLight(l, right, up, before[2]);
      else {
        const [x, y] = [right - before[0], up - before[1]];
        this.resizeLight(l, (Math.hypot(x, y) * sphere.radius - RING_LEAST) / RING_PER_DEGREE);
      }
    });
  }

  // Moves a light. right, up: the pointer's position relative to a sphere of radius 1. If the pointer lies
  // beyond the sphere's rim, the light moves to the half of the sphere on which it was not at the drag's
  // start.
  moveLight(l, right, up, side = 1) {
    const far = Math.hypot(right, up), folded = far > 1 ? Math.max(2 - far, 0) / far : 1;
    const [x, y] = [right * folded, up * folded];
    const depth = Math.sqrt(Math.max(1 - x * x - y * y, 0)) * (far > 1 ? -1 : 1) * (side < 0 ? -1 : 1);
    this.#store.changeLight(l, "place", (light) => withDirection(light, this.#store.scene.camera, [x, y, depth]));
  }

  resizeLight(l, degrees) {
    this.#store.changeLight(l, "size", (light) => withSize(light, this.#store.scene.camera, degrees));
  }

  #key(event, l) {
    const light = this.#store.scene.lights[l], camera = this.#store.scene.camera;
    const arrows = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    if (!arrows[event.key] && event.key !== "+" && event.key !== "-") return;
    this.#choose(l);
    if (arrows[event.key]) {
      const direction = steppedDirection(directionOf(light, camera), ...arrows[event.key], KEY_STEP);
      this.#store.changeLight(l, "place", (changed) => withDirection(changed, camera, direction));
    } else this.resizeLight(l, sizeOf(light, camera) + (event.key === "+" ? 1 : -1));
    event.preventDefault();
    event.stopPropagation();
  }
}
