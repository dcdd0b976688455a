// A viewer's requests to the server that sent its page. All of them stay below the page's own address, which holds
// the token. The widget of notebooks has a channel of its own with the same methods (widget.js).
//
// What a channel may have besides start(), completeScene() and fetchFrame(), for a viewer with slices and measuring:
//
// - slice({ volume, of, width, height, depth, origin, across, down, through, blend, between }): the values of a plane of
//   voxels. volume: the number of a volume of what is open; of: "voxels", the file's; "mask", the label map that masks it;
//   "picture", what the picture shows of it, which is smoothed where the volume is. A grid of width x height samples, of `depth` layers; origin: [i, j, k], the first sample of the first row of the first layer, in
//   voxels; across, down, through: [i, j, k], the steps to the next sample, row and layer. blend: what of the layers is
//   told: "maximum", "minimum" or "mean"; between: "nearest" or "linear". Resolves to { values, width, height }: values is a
//   Float32Array or Float64Array, whichever holds the voxels' values exactly, row after row; NaN: no voxel is there.
// - depth(scene): how deep lies what the middle pixel of the scene's picture (at most 64 x 64 pixels) shows:
//   { depth, opacity, object }. depth: the length along the ray from the eye, or orthographic from the plane through the
//   camera's position, to where the opacity first reaches 0.01; null: nowhere. object: as in hl_layers. Null: cancelled.
// - overlay(scene, over): what a figure has over the scene's picture (figure_overlay.js), { blob, note }: a transparent PNG, and what the program says
//   of it, as that a part finds no room; "": nothing.
// - progress(): how far the frame is that was asked for last, { part, stage, others }: part of the stage, from 0 to 1; stage: what is made,
//   "voxels" (finer ones of what is seen are read), "labels" (they are smoothed) and "sky" (its light) before the picture, and "picture"; others: frames of other pages under way.

import { Lost } from "./connection.js";
import { HeldScene } from "./held_scene.js";

export class Refused extends Error {
  constructor(line, status) {
    super(line);
    this.status = status;
    this.noBase = status === NO_BASE;
  }
}

const GONE = 410; // what the page had opened is open no longer
const NO_BASE = 409; // the viewer does not hold the scene that a difference is from
const REPLACED = 409; // the voxels of a plane were replaced by finer ones

async function check(response) {
  if (response.ok) return response;
  if (response.status === 403) {
    const line = (await response.text()).trim();
    throw line.includes("token") ? new Lost("The viewer runs anew, under another URL: open the one that it has printed in this tab, which keeps your work.") : new Refused(line, response.status);
  }
  throw new Refused((await response.text()).trim() || `the viewer answered ${response.status}`, response.status);
}

// "render;dur=12.5, encode;dur=3" as { render: 12.5, encode: 3 }, in milliseconds.
function parseTimes(header) {
  return Object.fromEntries((header ?? "").split(", ").map((part) => part.split(";dur=")).map(([k, v]) => [k, +v]));
}

// The program's warnings about an answer; "": there are none.
function noteOf(response) {
  try {
    return decodeURIComponent(response.headers.get("Halflight-Note") ?? "");
  } catch {
    return ""; // it is cut in the middle of a letter
  }
}

// What a picture shows of volumes of several resolutions; null: the volumes that are open.
const seenOf = (response) => JSON.parse(decodeURIComponent(response.headers.get("Halflight-Seen") ?? "null"));

const numbered = (keys) => Object.fromEntries(keys.map((key, n) => [`key${n}`, key]));

const overlayQuery = ({ scaleBar = false, legend = false, axes = "none", marks = false, unit = "" }) => ({ scale_bar: +scaleBar, legend: +legend, axes, marks: +marks, ...(unit ? { unit } : {}) });

export class HttpChannel {
  #number = 0;
  #shown = 0; // the number of the newest frame that is in no lane
  #opened;
  #refined;
  #held = new HeldScene(() => (this.#shown = ++this.#number)); // not of the frames in lanes
  #page = crypto.getRandomValues(new Uint32Array(2)).reduce((name, n) => name + n.toString(36), "p");

  #source;

  // opened: the number of what is open (of start.json), whose volumes the scenes have; source: what open() opens it by, or null;
  // refined: of start.json.
  constructor(opened = 0, source = null, refined = 0) {
    this.#opened = opened;
    this.#refined = refined;
    this.#source = source;
  }

  // A request below the page's address. What is open no longer, as the viewer has begun anew or has made room, is opened again.
  async #ask(path, query = {}, options = { method: "POST" }, again = true) {
    const words = new URLSearchParams(query);
    if ("opened" in query) words.set("opened", this.#opened);
    let response;
    try {
      response = await fetch(words.size > 0 ? `${path}?${words}` : path, options);
    } catch {
      this.#held.forget();
      throw new Lost("The viewer does not answer: it has ended, or the network is lost.");
    }
    if (response.status === GONE && again && this.#source !== null) {
      this.#opened = (await this.open(this.#source)).opened;
      if ("base" in query) throw new Refused("the viewer holds no scene of this page", NO_BASE);
      return this.#ask(path, query, options, false);
    }
    return check(response);
  }

  // Whether the viewer answers again.
  async answers() {
    await this.#ask("state.json", {}, {});
  }

  // What is open, and what there is to choose from: start.json.
  async start() {
    const start = await (await this.#ask("start.json", { opened: 0 }, {})).json();
    this.#refined = start.refined;
    return start;
  }

  // How far volumes of several resolutions are read, from coarse to fine: { refined, refining, problem }.
  async refinement() {
    return (await this.#ask("refined.json", { opened: 0 }, {})).json();
  }

  // The values of a plane of voxels; none where a finer resolution has taken the place of the voxels meanwhile.
  async slice({ width, height, origin, across, down, through, depth = 1, volume = 0, of = "voxels", blend = "maximum", between = "nearest" }) {
    let bytes;
    try {
      bytes = await (await this.#ask("slice", { opened: 0, refined: this.#refined, volume, of, width, height, depth, origin, across, down, through, blend, between })).arrayBuffer();
    } catch (error) {
      if (error.status !== REPLACED) throw error;
      return { values: new Float32Array(width * height).fill(NaN), width, height };
    }
    return { values: bytes.byteLength === 4 * width * height ? new Float32Array(bytes) : new Float64Array(bytes), width, height };
  }

  // How deep lies what the middle of the scene's picture shows.
  async depth(scene) {
    const query = { page: `${this.#page}-pick`, number: ++this.#number, opened: 0 };
    const response = await this.#ask("depth", query, { method: "POST", body: JSON.stringify(scene) });
    return response.status === 204 ? null : response.json();
  }

  async progress() {
    const asked = this.#shown, { frame, ...told } = await (await this.#ask("progress.json", { page: this.#page }, {})).json();
    return frame === asked && asked === this.#shown ? told : { ...told, part: 0, stage: "picture" }; // of an older frame, or not yet begun
  }

  // The scene with its defaults written out: presets as points, a camera that frames everything. choices: { look, rig }, names
  // of what it is to have.
  async completeScene(scene, choices = {}) {
    return (await this.#ask("scene", { opened: 0, ...choices }, { method: "POST", body: JSON.stringify(scene) })).json();
  }

  // A picture of the scene: { blob, times, note }, with the program's warnings in `note`, or null where a newer frame of this page has cancelled it. `lane` sets
  // frames apart that do not cancel each other; `moving` makes a quick picture, of coarser volumes where the sheets are wide; `finest`
  // waits until the finest resolutions that are to be read are there, and fails where they cannot be read. `seen`: volumes of several resolutions
  // have, where the picture sees them, the voxels that it deserves; the answer then has `seen`, { problem, volumes: [{ level, absent_chunks }] },
  // with the reason in `problem` where finer voxels were not read; null: the volumes are fine enough. A picture with `finest` does so, too.
  // scaleBar, legend, axes, marks (those of the scene): drawn over a PNG of 8 bits; a bar is refused where neither the scene's files nor `unit` tell a unit of length.
  async fetchFrame(scene, { format = "jpeg", quality = 85, depth = 8, metadata = true, moving = false, lane = "", finest = false, seen = false, ...over } = {}) {
    const query = { page: this.#page + lane, opened: 0, format, quality, depth, metadata: +metadata, moving: +moving, coarse: +!finest, seen: +seen, ...overlayQuery(over) };
    const ask = (number, body, base) => this.#ask("frame", { ...query, number, ...(base === undefined ? {} : { base }) }, { method: "POST", body });
    const response = await (lane === "" ? this.#held.send(scene, moving, ask) : ask(++this.#number, JSON.stringify(scene)));
    if (response.status === 204) return null;
    return { blob: await response.blob(), times: parseTimes(response.headers.get("Server-Timing")), note: noteOf(response), seen: seenOf(response) };
  }

  // What is drawn over the scene's picture: { blob, note }, a transparent PNG of its size; null: it was cancelled.
  async overlay(scene, over) {
    const query = { page: `${this.#page}-overlay`, number: ++this.#number, opened: 0, ...overlayQuery(over) };
    const response = await this.#ask("overlay", query, { method: "POST", body: JSON.stringify(scene) });
    return response.status === 204 ? null : { blob: await response.blob(), note: noteOf(response) };
  }

  // What can be opened in a folder below the one that the viewer was started in: { at, entries }.
  async folder(at) {
    return (await this.#ask("folder.json", { at }, {})).json();
  }

  // Opens a file of the folder, or one that the browser has: what is open then, for a channel of its own. source: a path, or { file, series },
  // a path and one of the DICOM series in it; "" is what the viewer began with; of several in a list, the others are added to the first one.
  async open(source) {
    const [first, ...others] = [source].flat();
    let start = first === "" ? await this.start() : await this.#opens(this.#ask("open", typeof first === "string" ? { file: first } : first));
    for (const file of others) {
      const channel = new HttpChannel(start.opened);
      start = await channel.add(start.scene, await this.open(file), start.title);
      if (channel.opened > 0) channel.leave();
    }
    return start;
  }

  // A session in the viewer's folder, as a file; null: the file there is none.
  async session(path) {
    const response = await this.#ask("session", { file: path });
    return response.status === 204 ? null : new File([await response.blob()], path.split("/").pop());
  }

  // Adds what open() or upload() has opened to a scene of what this channel is of: what is open then.
  async add(scene, added, title) {
    const query = { opened: 0, with: added.opened, title: `${title} + ${added.title}` };
    return (await this.#ask("join", query, { method: "POST", body: JSON.stringify(scene) })).json();
  }

  async upload(file) {
    return this.#opens(this.#ask("upload", { name: file.name }, { method: "POST", body: file }));
  }

  // What an answer opens, with the program's warnings as its `note`.
  async #opens(asked) {
    const response = await asked;
    return { ...(await response.json()), note: noteOf(response) };
  }

  get opened() { return this.#opened; }

  // The page is closed, or shows another file: the viewer gives back what it held for this one.
  leave() {
    navigator.sendBeacon(`leave?${new URLSearchParams({ page: this.#page, opened: this.#opened })}`);
  }

  // How far it is read: { part }, from 0 to 1.
  async opening() {
    return (await this.#ask("opening.json", {}, {})).json();
  }

  // The scene at a frame of its film: exactly the one that the film shows there.
  async sceneAt(scene, { turntable, keys, frames }, frame) {
    const query = { opened: 0, turntable, frames, frame, ...numbered(keys) };
    return (await this.#ask("scene", query, { method: "POST", body: JSON.stringify(scene) })).json();
  }

  // A film of the scene, as a blob; null: it was stopped.
  async film(scene, { turntable, keys, frames, fps, format }) {
    const query = { page: `${this.#page}-film`, number: ++this.#number, opened: 0, turntable, frames, fps, format, ...numbered(keys) };
    const response = await this.#ask("film", query, { method: "POST", body: JSON.stringify(scene) });
    return response.status === 204 ? null : response.blob();
  }

  // { done, frames }.
  async filmProgress() {
    return (await this.#ask("film.json", { page: `${this.#page}-film` }, {})).json();
  }

  // Gives up what is being made in a lane.
  async cancel(lane) {
    await this.#ask("cancel", { page: this.#page + lane, number: ++this.#number });
  }
}
