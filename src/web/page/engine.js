// The library, as a WebAssembly file, in one worker or in node: opens files and renders scenes (src/web/web.h).

import { Files } from "./files.js";

const OK = 0, CANCELLED = 6; // hl_status
const MEBIBYTES = 3800; // of WebAssembly's four gibibytes, beside stacks and code
const FIRST_PAGES = 512, MOST_PAGES = 65535; // of 64 KiB, of shared memory, as src/web/meson.build has them
const STACK = 1 << 20, ALIGNED = 64; // bytes of a stack, as src/web/meson.build has it, and of what its end is a multiple of
const MOST_THREADS = 8; // of a picture: more wait for each other
const POOLS = 2; // that keep their threads: of pictures at rest and of those while something moves

const SOURCES = ["voxels", "mask", "picture"]; // slice_source
const BLENDS = ["maximum", "minimum", "mean"]; // hl_blend, from 1

// As http_channel.js has it: the number of bytes tells whether they are floats or doubles.
const valuesOf = (buffer, width, height) => ({ values: buffer.byteLength === 4 * width * height ? new Float32Array(buffer) : new Float64Array(buffer), width, height });

const sharesMemory = (module) => WebAssembly.Module.imports(module).some(({ kind }) => kind === "memory");

export class EngineError extends Error {}

export class Engine {
  static waits = typeof WebAssembly.Suspending === "function"; // JavaScript Promise Integration

  threads = 1; // of a picture at most
  #exports;
  #memory;
  #files = new Files();

  // hooks: { cancelled(): whether the call that runs is wanted no longer, or a promise of that, where the engine can wait
  // for one in the middle of a call (Engine.waits); progress(fraction): of a file that is read; help(work): starts a worker that calls
  // Engine.help(work), a promise of it being ready }.
  constructor(module, { cancelled = () => false, progress = () => {} } = {}) {
    this.#memory = sharesMemory(module) ? new WebAssembly.Memory({ initial: FIRST_PAGES, maximum: MOST_PAGES, shared: true }) : null;
    const instance = new WebAssembly.Instance(module, {
      env: { memory: this.#memory },
      wasi_snapshot_preview1: this.#files.imports(() => this.#memory),
      page: { cancelled: Engine.waits ? new WebAssembly.Suspending(cancelled) : () => +cancelled(), progress },
    });
    this.#exports = { ...instance.exports };
    this.#memory ??= this.#exports.memory;
    if (Engine.waits)
      for (const name of ["web_begin", "web_open", "web_join", "web_complete", "web_frame", "web_slice", "web_depth"]) this.#exports[name] = WebAssembly.promising(this.#exports[name]);
    this.#exports._initialize();
  }

  // threads: of a picture at most, where the module is for several.
  static async of(module, hooks = {}, threads = globalThis.navigator?.hardwareConcurrency ?? 1) {
    const engine = new Engine(module, hooks);
    if (sharesMemory(module)) engine.threads = Math.min(threads, MOST_THREADS);
    engine.#check(await engine.#exports.web_begin(MEBIBYTES, engine.threads));
    const helpers = engine.fuses ? POOLS * (engine.threads - 1) : 0;
    await Promise.all(Array.from({ length: helpers }, (_, number) => hooks.help(engine.#work(module, number))));
    return engine;
  }

  // What a helper's worker is given.
  #work(module, number) {
    const { web_room, __tls_size } = this.#exports, room = web_room(STACK + ALIGNED + __tls_size.value) >>> 0;
    if (room === 0) throw new EngineError("no memory for a thread");
    return { module, memory: this.#memory, number, stack: Math.ceil((room + STACK) / ALIGNED) * ALIGNED };
  }

  // In a helper's worker: runs what the library's pools ask of it, for ever. ready() is called before.
  static help({ module, memory, number, stack }, ready) {
    const { exports } = new WebAssembly.Instance(module, {
      env: { memory },
      wasi_snapshot_preview1: new Files().imports(() => memory),
      page: { cancelled: () => 0, progress: () => {} },
    });
    exports.__stack_pointer.value = stack; // it grows down; the thread's variables lie above
    exports.__wasm_init_tls(stack);
    if (exports.web_helper_arrive(number) === 1) ready();
    exports.web_helper_serve(number);
  }

  // The engine of the first of some files, the quickest first, that this machine runs to the same bytes. A machine may have no room
  // for memory that is shared.
  static async best(files, hooks) {
    for (const bytes of files) {
      const module = WebAssembly.validate(bytes) ? await WebAssembly.compile(bytes) : null;
      const engine = module && await (sharesMemory(module) ? Engine.of(module, hooks).catch(() => null) : Engine.of(module, hooks));
      if (engine?.fuses) return engine;
    }
    throw new EngineError("this browser has no WebAssembly with SIMD: use a newer one");
  }

  // Whether products and sums are rounded once: engines may round those of relaxed SIMD twice.
  get fuses() { return this.#exports.web_fuses() === 1; }

  get memoryHeld() { return this.#exports.web_memory_held(); }

  // Texts are written as UTF-8, bytes as they are. Returns their number.
  #write(content) {
    const bytes = typeof content === "string" ? new TextEncoder().encode(content) : content, pointer = this.#exports.web_text(bytes.length) >>> 0;
    if (pointer === 0) throw new EngineError("no memory for a scene's text");
    new Uint8Array(this.#memory.buffer, pointer, bytes.length).set(bytes);
    return bytes.length;
  }

  #answer() {
    return new Uint8Array(this.#memory.buffer, this.#exports.web_answer() >>> 0, this.#exports.web_answer_bytes());
  }

  // An answer's text: decoders refuse memory that is shared.
  #text(answer) { return new TextDecoder().decode(answer.slice()); }

  // Null: cancelled.
  #check(status) {
    if (status === OK) return this.#answer();
    if (status === CANCELLED) return null;
    throw new EngineError(this.#text(this.#answer()));
  }

  // A short text for a call's own argument.
  async #with(text, call) {
    const bytes = new TextEncoder().encode(`${text}\0`), pointer = this.#exports.web_room(bytes.length) >>> 0;
    new Uint8Array(this.#memory.buffer, pointer, bytes.length).set(bytes);
    try {
      return this.#check(await call(pointer));
    } finally {
      this.#exports.web_release(pointer);
    }
  }

  // Opens one of some files, or a folder of theirs: { "folder/name": Uint8Array or Blob }. Returns start.json's object.
  async open(contents, path, title = path) {
    this.#files.replace(contents);
    this.#write(`/${path}`);
    const answer = await this.#with(title, (pointer) => this.#exports.web_open(pointer));
    return answer === null ? null : JSON.parse(this.#text(answer));
  }

  // Adds the same to a scene of what is open.
  async join(scene, contents, path, title) {
    this.#files.replace(contents);
    const length = this.#write(JSON.stringify(scene));
    const answer = await this.#with(`/${path}\0${title}`, (pointer) => this.#exports.web_join(length, pointer));
    return answer === null ? null : JSON.parse(this.#text(answer));
  }

  async complete(scene, { look = "", rig = "" } = {}) {
    const length = this.#write(JSON.stringify(scene));
    const answer = await this.#with(`${look}\0${rig}`, (pointer) => this.#exports.web_complete(length, pointer));
    return JSON.parse(this.#text(answer));
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
    const answer = this.#check(await this.#exports.web_slice(volume, SOURCES.indexOf(of), 1 + BLENDS.indexOf(blend), +(between === "linear")));
    return answer && valuesOf(answer.slice().buffer, width, height);
  }

  // How deep lies what the middle of the scene's picture shows (depth() of http_channel.js); null: cancelled.
  async depth(scene) {
    const answer = this.#check(await this.#exports.web_depth(this.#write(JSON.stringify(scene))));
    return answer && JSON.parse(this.#text(answer));
  }
}
