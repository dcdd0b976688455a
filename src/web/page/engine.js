// The library, as a WebAssembly file, in one worker or in node: opens files and renders scenes (src/web/web.h).

import { Files } from "./files.js";

const OK = 0, CANCELLED = 6; // hl_status
const MEBIBYTES = 3800; // of WebAssembly's four gibibytes, beside stacks and code

const BLENDS = ["maximum", "minimum", "mean"]; // hl_blend, from 1

// As http_channel.js has it: the number of bytes tells whether they are floats or doubles.
const valuesOf = (buffer, width, height) => ({ values: buffer.byteLength === 4 * width * height ? new Float32Array(buffer) : new Float64Array(buffer), width, height });

export class EngineError extends Error {}

export class Engine {
  static waits = typeof WebAssembly.Suspending === "function"; // JavaScript Promise Integration

  #exports;
  #files = new Files();

  // hooks: { cancelled(): whether the call that runs is wanted no longer, or a promise of that, where the engine can wait
  // for one in the middle of a call (Engine.waits); progress(fraction): of a file that is read }.
  constructor(module, { cancelled = () => false, progress = () => {} } = {}) {
    const instance = new WebAssembly.Instance(module, {
      wasi_snapshot_preview1: this.#files.imports(() => this.#exports.memory),
      page: { cancelled: Engine.waits ? new WebAssembly.Suspending(cancelled) : () => +cancelled(), progress },
    });
    this.#exports = { ...instance.exports };
    if (Engine.waits)
      for (const name of ["web_begin", "web_open", "web_join", "web_complete", "web_frame", "web_slice", "web_depth"]) this.#exports[name] = WebAssembly.promising(this.#exports[name]);
    this.#exports._initialize();
  }

  static async of(module, hooks) {
    const engine = new Engine(module, hooks);
    engine.#check(await engine.#exports.web_begin(MEBIBYTES));
    return engine;
  }

  // The engine of the first of some files, the quickest first, that this machine runs to the same bytes.
  static async best(files, hooks) {
    for (const bytes of files) {
      const module = WebAssembly.validate(bytes) ? await WebAssembly.compile(bytes) : null;
      const engine = module === null ? null : await Engine.of(module, hooks);
      if (engine?.fuses) return engine;
    }
    throw new EngineError("this browser has no WebAssembly with SIMD: use a newer one");
  }

  // Whether products and sums are rounded once: engines may round those of relaxed SIMD twice.
  get fuses() { return this.#exports.web_fuses() === 1; }

  get memoryHeld() { return this.#exports.web_memory_held(); }

  // Texts are written as UTF-8, bytes as they are. Returns their number.
  #write(content) {
    const bytes = typeof content === "string" ? new TextEncoder().encode(content) : content, pointer = this.#exports.web_text(bytes.length);
    if (pointer === 0) throw new EngineError("no memory for a scene's text");
    new Uint8Array(this.#exports.memory.buffer, pointer, bytes.length).set(bytes);
    return bytes.length;
  }

  #answer() {
    return new Uint8Array(this.#exports.memory.buffer, this.#exports.web_answer(), this.#exports.web_answer_bytes());
  }

  // Null: cancelled.
  #check(status) {
    if (status === OK) return this.#answer();
    if (status === CANCELLED) return null;
    throw new EngineError(new TextDecoder().decode(this.#answer()));
  }

  // A short text for a call's own argument.
  async #with(text, call) {
    const bytes = new TextEncoder().encode(`${text}\0`), pointer = this.#exports.malloc(bytes.length);
    new Uint8Array(this.#exports.memory.buffer, pointer, bytes.length).set(bytes);
    try {
      return this.#check(await call(pointer));
    } finally {
      this.#exports.free(pointer);
    }
  }

  // Opens one of some files, or a folder of theirs: { "folder/name": Uint8Array or Blob }. Returns start.json's object.
  async open(contents, path, title = path) {
    this.#files.replace(contents);
    this.#write(`/${path}`);
    const answer = await this.#with(title, (pointer) => this.#exports.web_open(pointer));
    return answer === null ? null : JSON.parse(new TextDecoder().decode(answer));
  }

  // Adds the same to a scene of what is open.
  async join(scene, contents, path, title) {
    this.#files.replace(contents);
    const length = this.#write(JSON.stringify(scene));
    const answer = await this.#with(`/${path}\0${title}`, (pointer) => this.#exports.web_join(length, pointer));
    return answer === null ? null : JSON.parse(new TextDecoder().decode(answer));
  }

  async complete(scene, { look = "", rig = "" } = {}) {
    const length = this.#write(JSON.stringify(scene));
    const answer = await this.#with(`${look}\0${rig}`, (pointer) => this.#exports.web_complete(length, pointer));
    return JSON.parse(new TextDecoder().decode(answer));
  }

  // A picture's bytes, for the caller to keep; null: cancelled. format: "png", "npy" or "rgba".
  async frame(scene, { format = "rgba", depth = 8, metadata = true, moving = false } = {}) {
    const length = this.#write(JSON.stringify(scene));
    const answer = await this.#with(format, (pointer) => this.#exports.web_frame(length, pointer, depth, +metadata, +moving));
    return answer?.slice() ?? null;
  }

  // The values of a plane of voxels (slice() of http_channel.js); null: cancelled.
  async slice({ width, height, origin, across, down, through, depth = 1, volume = 0, of = "voxels", blend = "maximum", between = "nearest" }) {
    this.#write(new Uint8Array(Float64Array.of(width, height, depth, ...origin, ...across, ...down, ...through).buffer));
    const answer = this.#check(await this.#exports.web_slice(volume, +(of === "mask"), 1 + BLENDS.indexOf(blend), +(between === "linear")));
    return answer && valuesOf(answer.slice().buffer, width, height);
  }

  // How deep lies what the middle of the scene's picture shows (depth() of http_channel.js); null: cancelled.
  async depth(scene) {
    const answer = this.#check(await this.#exports.web_depth(this.#write(JSON.stringify(scene))));
    return answer && JSON.parse(new TextDecoder().decode(answer));
  }
}
