// The channel of a page: the requests to the server that sent the page. The addresses of all requests begin with the page's own address, which contains the
// token. The widget of notebooks has another channel with the same methods (widget.js).
//
// Methods that a channel may have besides start(), completeScene() and fetchFrame(), for a viewer with slices and measuring:
//
// - slice({ volume, of, width, height, depth, origin, across, down, through, blend, between }): the values of a plane of samples of a volume. volume: the index
//   of an open volume; of: "voxels", the file's voxels; "mask", the label map that masks the volume; "picture", the voxels that the picture shows, which are
//   smoothed if the volume is smoothed. The samples are a grid of width x height samples in `depth` layers; origin: [i, j, k], the first sample of the first row
//   of the first layer, in voxels; across, down, through: [i, j, k], the steps to the next sample, row and layer. blend: how the layers are combined: "maximum",
//   "minimum" or "mean"; between: the interpolation between voxels, "nearest" or "linear". Resolves to { values, width, height }: values is a Float32Array or a
//   Float64Array, depending on which holds the voxels' values exactly, row after row; NaN: the sample lies outside the volume.
// - depth(scene): the depth that the middle pixel of the scene's picture (at most 64 x 64 pixels) shows: { depth, opacity, object }. depth: the length along
//   the ray, from the eye or, for an orthographic camera, from the plane through the camera's position, to the point where the opacity first reaches 0.01; null:
//   the opacity stays below 0.01. object: as in hl_layers. The result is null if the request was cancelled.
// - overlay(scene, over): the parts of a figure over the scene's picture (figure_overlay.js), { blob, note }: a transparent PNG, and the program's note about
//   the PNG, for example that there is no room for a part; "": there is no note.
// - progress(): the progress of the frame that was requested last, { part, stage, others }. part: the finished fraction of the stage, from 0 to 1. stage:
//   "voxels" (finer voxels of the visible matter are read), "labels" (labels are smoothed) or "sky" (the sky's light is computed), all before the picture, or
//   "picture". others: the number of frames of other pages that are being made.

import { Lost } from "./connection.js";
import { HeldScene } from "./held_scene.js";

export class Refused extends Error {
  constructor(line, status) {
    super(line);
    this.status = status;
    this.noBase = status === NO_BASE;
  }
}

const GONE = 410; // the scene that the page had opened is not open any more
const NO_BASE = 409; // the server does not hold the scene to which a difference refers
const REPLACED = 409; // the voxels of a plane were replaced by finer voxels

async function check(response) {
  if (response.ok) return response;
  if (response.status === 403) {
    const line = (await response.text()).trim();
    throw line.includes("token") ? new Lost("The viewer runs anew, under another URL: open the one that it has printed in this tab, which keeps your work.") : new Refused(line, response.status);
  }
  throw new Refused((await response.text()).trim() || `the viewer answered ${response.status}`, response.status);
}

// Parses "render;dur=12.5, encode;dur=3" to { render: 12.5, encode: 3 }, in milliseconds.
function parseTimes(header) {
  return Object.fromEntries((header ?? "").split(", ").map((part) => part.split(";dur=")).map(([k, v]) => [k, +v]));
}

// Returns the program's warnings about an answer; "": there are no warnings.
function noteOf(response) {
  try {
    return decodeURIComponent(response.headers.get("Halflight-Note") ?? "");
  } catch {
    return ""; // the header was cut in the middle of a letter
  }
}

// Returns the resolutions that a picture shows of volumes of several resolutions; null: the picture
// shows the open volumes.
const seenOf = (response) => JSON.parse(decodeURIComponent(response.headers.get("Halflight-Seen") ?? "null"));

const numbered = (keys) => Object.fromEntries(keys.map((key, n) => [`key${n}`, key]));

const overlayQuery = ({ scaleBar = false, legend = false, axes = "none", marks = false, unit = "" }) => ({ scale_bar: +scaleBar, legend: +legend, axes, marks: +marks, ...(unit ? { unit } : {}) });

export class HttpChannel {
  #number = 0;
  #shown = 0; // the number of the newest frame of the main picture, which has no lane
  #opened;
  #refined;
  #held = new HeldScene(() => (this.#shown = ++this.#number)); // frames in lanes always send the whole scene
  #page = crypto.getRandomValues(new Uint32Array(2)).reduce((name, n) => name + n.toString(36), "p");

  #source;

  // opened: the number of the open scene (`opened` of start.json), whose volumes the channel's scenes have. source: the argument
  // with which open() opens this scene, or null. refined: `refined` of start.json.
  constructor(opened = 0, source = null, refined = 0) {
    this.#opened = opened;
    this.#refined = refined;
    this.#source = source;
  }

  // A request below the page's address. If the scene is not open any more, because the server was restarted or has closed the
  // scene to make room, the scene is opened again.
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

  // Resolves if the server answers again.
  async answers() {
    await this.#ask("state.json", {}, {});
  }

  // Returns start.json: the open scene, its volumes, and the lists of choices.
  async start() {
    const start = await (await this.#ask("start.json", { opened: 0 }, {})).json();
    this.#refined = start.refined;
    return start;
  }

  // Returns how far the volumes of several resolutions have been read, from coarse to fine: { refined,
  // refining, problem }.
  async refinement() {
    return (await this.#ask("refined.json", { opened: 0 }, {})).json();
  }

  // Returns the values of a plane of samples. There are no values if a finer resolution has replaced the voxels
  // since.
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

  // Returns the depth that the middle of the scene's picture shows.
  async depth(scene) {
    const query = { page: `${this.#page}-pick`, number: ++this.#number, opened: 0 };
    const response = await this.#ask("depth", query, { method: "POST", body: JSON.stringify(scene) });
    return response.status === 204 ? null : response.json();
  }

  async progress() {
    const asked = this.#shown, { frame, ...told } = await (await this.#ask("progress.json", { page: this.#page }, {})).json();
    return frame === asked && asked === this.#shown ? told : { ...told, part: 0, stage: "picture" }; // the answer is about an older frame, or the newest frame is not begun yet
  }

  // Returns the scene with all defaults written out, with presets as points and with a camera that shows everything. choices:
  // { look, rig }, the names of a look and of a rig of lights that the scene shall have.
  async completeScene(scene, choices = {}) {
    return (await this.#ask("scene", { opened: 0, ...choices }, { method: "POST", body: JSON.stringify(scene) })).json();
  }

  // A picture of the scene: { blob, times, note }, with the program's warnings in `note`, or null if a newer frame of this page has cancelled the frame. lane:
  // a name; only frames of the same lane cancel each other. moving: makes a quick picture, with coarser volumes if the sheets are far apart. finest: waits
  // until the finest resolutions have been read, and fails if they cannot be read. seen: reads finer voxels of volumes of several resolutions, where the
  // picture is detailed enough to show them. The answer then has `seen`, { problem, volumes: [{ level, absent_chunks }] }; problem: the reason if finer voxels
  // were not read. `seen` of the answer is null if the open volumes are fine enough. A picture with `finest` reads finer voxels, too. scaleBar, legend, axes,
  // marks (the scene's marks): the overlays that are drawn over a PNG of 8 bits. A scale bar is refused if neither the scene's files nor `unit` tell a unit of
  // length.
  async fetchFrame(scene, { format = "jpeg", quality = 85, depth = 8, metadata = true, moving = false, lane = "", finest = false, seen = false, ...over } = {}) {
    const query = { page: this.#page + lane, opened: 0, format, quality, depth, metadata: +metadata, moving: +moving, coarse: +!finest, seen: +seen, ...overlayQuery(over) };
    const ask = (number, body, base) => this.#ask("frame", { ...query, number, ...(base === undefined ? {} : { base }) }, { method: "POST", body });
    const response = await (lane === "" ? this.#held.send(scene, moving, ask) : ask(++this.#number, JSON.stringify(scene)));
    if (response.status === 204) return null;
    return { blob: await response.blob(), times: parseTimes(response.headers.get("Server-Timing")), note: noteOf(response), seen: seenOf(response) };
  }

  // Returns the overlays of the scene's picture, { blob, note }: a transparent PNG of the picture's size, and the
  // program's note; null: the request was cancelled.
  async overlay(scene, over) {
    const query = { page: `${this.#page}-overlay`, number: ++this.#number, opened: 0, ...overlayQuery(over) };
    const response = await this.#ask("overlay", query, { method: "POST", body: JSON.stringify(scene) });
    return response.status === 204 ? null : { blob: await response.blob(), note: noteOf(response) };
  }

  // Returns the files and folders that can be opened in the folder `at`, which lies below the
  // folder in which the viewer was started: { at, entries }.
  async folder(at) {
    return (await this.#ask("folder.json", { at }, {})).json();
  }

  // Opens files of the server's folder. Returns the start.json of the opened scene, which needs a channel of its own. source: a path; or {
  // file, series }, a path and one of its DICOM series; or "", the scene with which the viewer began; or a list of these, whose further
  // members are added to the first.
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

  // Returns a session in the viewer's folder, as a file; null: the file at this path is not a
  // session.
  async session(path) {
    const response = await this.#ask("session", { file: path });
    return response.status === 204 ? null : new File([await response.blob()], path.split("/").pop());
  }

  // Adds a scene that open() or upload() has opened to a scene of this channel. Returns the
  // start.json of the joined scene.
  async add(scene, added, title) {
    const query = { opened: 0, with: added.opened, title: `${title} + ${added.title}` };
    return (await this.#ask("join", query, { method: "POST", body: JSON.stringify(scene) })).json();
  }

  async upload(file) {
    return this.#opens(this.#ask("upload", { name: file.name }, { method: "POST", body: file }));
  }

  // Returns the start.json in an answer, with the program's warnings as its `note`.
  async #opens(asked) {
    const response = await asked;
    return { ...(await response.json()), note: noteOf(response) };
  }

  get opened() { return this.#opened; }

  // Tells the server that the page was closed or shows another file, so that the server releases
  // what it holds for this page.
  leave() {
    navigator.sendBeacon(`leave?${new URLSearchParams({ page: this.#page, opened: this.#opened })}`);
  }

  // Returns the progress of reading the file that is being opened: { part }, from 0 to 1.
  async opening() {
    return (await this.#ask("opening.json", {}, {})).json();
  }

  // Returns the scene at a frame of the film: exactly the scene that the film shows at this frame.
  async sceneAt(scene, { turntable, keys, frames }, frame) {
    const query = { opened: 0, turntable, frames, frame, ...numbered(keys) };
    return (await this.#ask("scene", query, { method: "POST", body: JSON.stringify(scene) })).json();
  }

  // Returns a film of the scene as a blob; null: the film was stopped.
  async film(scene, { turntable, keys, frames, fps, format }) {
    const query = { page: `${this.#page}-film`, number: ++this.#number, opened: 0, turntable, frames, fps, format, ...numbered(keys) };
    const response = await this.#ask("film", query, { method: "POST", body: JSON.stringify(scene) });
    return response.status === 204 ? null : response.blob();
  }

  // Returns the film's progress: { done, frames }, the number of finished frames and of all frames.
  async filmProgress() {
    return (await this.#ask("film.json", { page: `${this.#page}-film` }, {})).json();
  }

  // Cancels the frame or film that is being made in a lane.
  async cancel(lane) {
    await this.#ask("cancel", { page: this.#page + lane, number: ++this.#number });
  }
}
