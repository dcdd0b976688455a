// The values of the planes that slices show. Requests for values are sent one after the other, and only the
// newest waiting request is sent. The functions below turn the values into pictures.

import { hexOf } from "./color.js";
import { contourPieces } from "./contours.js";
import { planeIn } from "./sections.js";

const LABEL_STRENGTH = 0.45; // strength of a label's colour over the greys

// Returns the range of values for the greys, used until the user chooses a range: all values except the
// rarest. The commonest value is left out of the count, because it is mostly the air around things.
export function automaticWindow({ histogram, range: [low, high] }) {
  const commonest = histogram.indexOf(Math.max(...histogram)), counts = histogram.map((count, bin) => (bin === commonest ? 0 : count));
  const total = counts.reduce((sum, count) => sum + count, 0), width = (high - low) / counts.length;
  if (!(total > 0)) return [low, high > low ? high : low + 1];
  const reached = (part) => {
    let sum = 0;
    return counts.findIndex((count) => (sum += count) >= part * total);
  };
  return [low + reached(0.005) * width, low + (reached(0.995) + 1) * width];
}

// Returns { histogram, range } of the values that slices show of a volume: the file's values, even if the picture shows
// smoothed values.
export const measured = (about) => about.unsmoothed ?? about;

// Returns the index of the volume that slices show: the chosen volume, or the first volume that is
// no label map.
export function sourceVolume({ store, start, current }) {
  const { volumes } = store.scene, isGrey = (v) => start.volumes[v] && !volumes[v].labels;
  if (start.volumes.length === 0) return -1;
  if (isGrey(current.volume)) return current.volume;
  const found = volumes.findIndex((_, v) => isGrey(v));
  return found >= 0 ? found : current.volume;
}

// Returns the sources of labels: the source volume itself, its mask, and other label maps, each as
// { volume, of, grid, transform, labels }.
export function labelSources({ store, start }, source) {
  return store.scene.volumes.flatMap((volume, v) => {
    const about = start.volumes[v];
    if (!about) return [];
    if (volume.labels) return [{ volume: v, of: "voxels", grid: about, transform: volume.transform, labels: volume.labels }];
    if (v === source && volume.mask?.labels && about.mask) return [{ volume: v, of: "mask", grid: about.mask, transform: volume.transform, labels: volume.mask.labels }];
    return [];
  });
}

const asked = ({ name: _n, pitch: _p, edges: _e, ...plane }, volume, of, blend) => ({ ...plane, volume, of, blend });

export class SliceValues {
  #channel;
  #onLoad;
  #onFail;
  #wanted = null;
  #busy = false;
  #known = new Map(); // the answers to the newest plane's requests, by the text of the request
  shown = null; // { plane, values, pictured, labels: [{ volume, of, values }] }; pictured: the values that the picture shows, which may be smoothed

  constructor(channel, onLoad, onFail) {
    this.#channel = channel;
    this.#onLoad = onLoad;
    this.#onFail = onFail;
  }

  // source: { volume, grid, transform }; labels: the result of labelSources(). hasLines: whether isolines are drawn; isolines need
  // the picture's values, so that they lie on the picture's isosurfaces.
  want(plane, source, labels, blend, hasLines) {
    const requests = [asked(plane, source.volume, "voxels", blend), asked(plane, source.volume, hasLines && source.grid.unsmoothed ? "picture" : "voxels", blend),
      ...labels.map((map) => asked(planeIn(plane, source, map), map.volume, map.of, "maximum"))].map((request) => JSON.stringify(request));
    this.#wanted = { plane, requests, maps: labels };
    if (!this.#busy) this.#load();
  }

  // Whether requested values have not arrived yet.
  get isBusy() { return this.#busy; }

  // Drops all known values, because finer voxels have replaced the old voxels. An answer that is on its way holds old values
  // and is dropped, too.
  forget() {
    this.#known = new Map();
    this.shown = null;
  }

  async #load() {
    this.#busy = true;
    while (this.#wanted !== null) {
      const { plane, requests, maps } = this.#wanted;
      this.#wanted = null;
      try {
        const known = new Map(), before = this.#known;
        for (const request of new Set(requests)) known.set(request, before.get(request) ?? (await this.#channel.slice(JSON.parse(request))));
        if (this.#known !== before) continue; // forget() was called meanwhile; its caller requests the values again
        this.#known = known;
        const [values, pictured, ...labels] = requests.map((request) => known.get(request));
        this.shown = { plane, values: values.values, pictured: pictured.values, labels: labels.map(({ values: own }, m) => ({ volume: maps[m].volume, of: maps[m].of, values: own })) };
        this.#onLoad();
      } catch (error) {
        this.#onFail(error);
      }
    }
    this.#busy = false;
  }
}

// Puts greys and labels into a canvas with one pixel for each sample. maps: the results of labelSources() that
// are drawn; some maps may have no values yet. isAlone: whether the values themselves are labels.
export function paint(canvas, { plane, values, labels }, [low, high], maps, isAlone) {
  const { width, height } = plane, image = new ImageData(width, height), { data } = image, span = high > low ? high - low : 1;
  for (let n = 0; n < width * height; n++) {
    const value = values[n], grey = isAlone ? 0 : (255 * (value - low)) / span; // a Uint8ClampedArray rounds and clamps
    data[4 * n] = data[4 * n + 1] = data[4 * n + 2] = grey;
    data[4 * n + 3] = Number.isNaN(value) ? 0 : 255;
  }
  for (const map of maps) {
    const own = labels.find((one) => one.volume === map.volume && one.of === map.of);
    if (own) tint(data, own.values, map.labels, isAlone ? 1 : LABEL_STRENGTH);
  }
  canvas.width = width;
  canvas.height = height;
  canvas.getContext("2d").putImageData(image, 0, 0);
}

function tint(data, values, labels, strength) {
  const colors = new Map(labels.filter((label) => label.visible !== false).map((label) => [label.value, rgbOf(label.color)]));
  for (let n = 0; n < values.length; n++) {
    const color = colors.get(values[n]);
    if (color === undefined) continue;
    for (let c = 0; c < 3; c++) data[4 * n + c] += strength * (color[c] - data[4 * n + c]);
    data[4 * n + 3] = 255;
  }
}

const rgbOf = (linear) => [1, 3, 5].map((at) => parseInt(hexOf(linear).slice(at, at + 2), 16));

// Returns the isolines of the source volume's isosurfaces: [{ color, pieces }].
export const isolines = ({ plane, pictured }, surfaces) =>
  surfaces.map((surface) => ({ color: hexOf(surface.color), pieces: contourPieces(pictured, plane.width, plane.height, surface.value) }));
