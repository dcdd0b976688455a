// The probe: reads the volumes under the cursor. When the picture is at rest, the probe requests three small
// pictures of floats. The first picture shows data values as colours. The other two show white matter without
// highlights, one with shadows and one without. The sky and the meshes are invisible in the small pictures,
// but meshes still cast shadows. A pixel of the first picture, divided by its opacity, is the mean of the
// data values that the pixel shows; the weight of a sample is its share of the pixel. The ratio of the other
// two pictures is the fraction of the lights' light that arrives at the pixel's matter.

import { make, shortNumber } from "./controls.js";
import { isPlane } from "./transfer_function.js";

const PIXELS = 90000; // number of pixels of a small picture

// Reads a .npy file of the program. Returns { width, height, rgba }; rgba: floats, top row first.
export function readNpy(bytes) {
  const view = new DataView(bytes), begin = 10 + view.getUint16(8, true);
  const [, height, width] = new TextDecoder().decode(new Uint8Array(bytes, 10, begin - 10)).match(/\((\d+), (\d+), 4\)/).map(Number);
  return { width, height, rgba: new Float32Array(bytes.slice(begin)) };
}

function small(scene) {
  const { width, height } = scene.image, factor = Math.min(1, Math.sqrt(PIXELS / (width * height)));
  const { exposure: _, tone: __, ...image } = scene.image;
  return {
    ...scene, image: { ...image, width: Math.max(1, Math.round(width * factor)), height: Math.max(1, Math.round(height * factor)) },
    render: { ...scene.render, sheet_spacing: Math.max(scene.render.sheet_spacing, 1), pixel_samples: 0 },
  };
}

// Returns the scene without sky, with invisible meshes, and with other colours of the volumes. colorAt(value, index
// of the volume): returns the colour of a label or isosurface. tfColor(index of the volume): returns the colour rows
// of a transfer function.
function recolored({ sky: _, ...scene }, { colorAt, tfColor, change }) {
  const paint = (things, v) => things.map((thing) => ({ ...thing, color: colorAt(thing.value, v) }));
  const volumes = scene.volumes.map((volume, v) => ({
    ...volume, ...change(volume),
    ...(volume.transfer_function?.color ? { transfer_function: { ...volume.transfer_function, color: tfColor(v) } } : {}),
    ...(volume.labels ? { labels: paint(volume.labels, v) } : {}), ...(volume.iso ? { iso: paint(volume.iso, v) } : {}),
  }));
  return { ...scene, volumes, ...(scene.meshes ? { meshes: scene.meshes.map((mesh) => ({ ...mesh, visible: false })) } : {}) };
}

// Returns the scene with greys that rise from 0 to 1 over each volume's range, in even light.
export function valueScene(scene, start) {
  const ends = (v) => start.volumes[v].range;
  return recolored({ ...small(scene), lights: [], ambient: [1, 1, 1] }, {
    colorAt: (value, v) => Array(3).fill(ends(v)[1] > ends(v)[0] ? (value - ends(v)[0]) / (ends(v)[1] - ends(v)[0]) : 0),
    tfColor: (v) => (ends(v)[1] > ends(v)[0] ? [[ends(v)[0], 0, 0, 0], [ends(v)[1], 1, 1, 1]] : [[ends(v)[0], 0, 0, 0]]),
    change: () => ({ shading: "flat", material: { ambient: 1, diffuse: 0, specular: 0 }, scattering: {} }),
  });
}

export function lightScene(scene, shadows) {
  const lights = scene.lights.map((light) => ({ ...light, color: [1, 1, 1], ...(shadows ? {} : { shadows: "off" }) }));
  return recolored({ ...small(scene), ambient: [0, 0, 0], lights }, {
    colorAt: () => [1, 1, 1], tfColor: () => [[0, 1, 1, 1]],
    change: (volume) => ({ shading: volume.shading === "flat" ? "none" : volume.shading, material: { ...volume.material, specular: 0, emission: 0 }, scattering: {} }),
  });
}

export class Probe {
  #viewer;
  #box;
  #on = false;
  #maps = null; // { value, lit, unlit } of the scene at rest
  #asked = null; // the scene for which the maps were requested
  #cursor = null; // [x, y] in fractions of the picture

  // area: the picture's element, over which the readout is shown.
  constructor(viewer, area) {
    this.#viewer = viewer;
    this.#box = make("output", { class: "probe", hidden: true, "aria-live": "off" });
    area.append(this.#box);
    area.addEventListener("pointermove", (event) => this.#move(event, area));
    area.addEventListener("pointerleave", () => { this.#box.hidden = true; });
    viewer.store.listen(() => { this.#maps = null; this.#show(); });
  }

  get on() { return this.#on; }
  set on(on) {
    this.#on = on;
    this.#show();
    if (on) this.rest();
  }

  // Called when the picture has come to rest: requests the small pictures.
  async rest() {
    const { store, start, channel } = this.#viewer, scene = store.scene;
    if (!this.#on || this.#maps !== null || this.#asked === scene) return;
    this.#asked = scene;
    const maps = {};
    try {
      for (const [name, wanted] of [["value", valueScene(scene, start)], ["lit", lightScene(scene, true)], ["unlit", lightScene(scene, false)]]) {
        const frame = await channel.fetchFrame(wanted, { format: "npy", lane: "-probe" });
        if (frame === null || store.scene !== scene) return;
        maps[name] = readNpy(await frame.blob.arrayBuffer());
      }
      this.#maps = maps;
      this.#show();
    } catch (error) {
      this.#viewer.report(error.message);
    } finally {
      if (this.#asked === scene) this.#asked = null;
    }
  }

  // Returns { value, opacity, light } at a place, given in fractions of the picture; null: the
  // small pictures have not arrived.
  at(x, y) {
    if (this.#maps === null) return null;
    const { value, lit, unlit } = this.#maps, { width, height } = value;
    const at = 4 * (Math.min(Math.floor(y * height), height - 1) * width + Math.min(Math.floor(x * width), width - 1));
    const opacity = value.rgba[at + 3];
    if (!(opacity > 0.002)) return { opacity, value: null, light: null };
    const { store, start, current } = this.#viewer, [low, high] = start.volumes[current.volume].range;
    // all values in a box of a function of two numbers have one colour, so the colour tells no value
    const known = !isPlane(store.scene.volumes[current.volume]);
    return {
      opacity, value: known ? low + (value.rgba[at] / opacity) * (high - low) : NaN,
      light: unlit.rgba[at] > 1e-4 ? Math.min(lit.rgba[at] / unlit.rgba[at], 1) : null,
    };
  }

  #move(event, area) {
    const box = area.getBoundingClientRect();
    this.#cursor = [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    this.#show();
  }

  #show() {
    this.#box.hidden = !this.#on || this.#cursor === null;
    if (this.#box.hidden) return;
    const found = this.at(...this.#cursor);
    if (found === null) this.#box.textContent = "…";
    else if (found.value === null) this.#box.textContent = "nothing is seen here";
    else
      this.#box.textContent = `${Number.isNaN(found.value) ? "" : `value ${shortNumber(found.value)} · `}opacity ${found.opacity.toFixed(2)}` +
        (found.light === null ? " · no light" : ` · light ${found.light.toFixed(2)}`);
    this.#box.style.left = `${100 * this.#cursor[0]}%`;
    this.#box.style.top = `${100 * this.#cursor[1]}%`;
    this.#box.classList.toggle("left", this.#cursor[0] > 0.5);
  }
}
