// Runs the library, which is a WebAssembly file, in one worker or in node: opens files and renders scenes
// (src/web/web.h).

import { Files } from "./files.js";

const OK = 0, CANCELLED = 6; // values of hl_status
const MEBIBYTES = 3800; // the library's memory limit: the four gibibytes of WebAssembly, less the memory for stacks and code
const FIRST_PAGES = 512, MOST_PAGES = 65535; // numbers of pages of 64 KiB of the shared memory, as in src/web/meson.build
// STACK: the number of bytes of a stack, as in src/web/meson.build; ALIGNED: a stack's end is a multiple of this number
// of bytes.
const STACK = 1 << 20, ALIGNED = 64;
const MOST_THREADS = 8; // the greatest number of threads that make a picture; more threads would wait for each other
// The number of pools that keep their threads: one for pictures at rest, and one for pictures while something moves.
const POOLS = 2;

const SOURCES = ["voxels", "mask", "picture"]; // the names of the values of slice_source
const BLENDS = ["maximum", "minimum", "mean"]; // the names of the values of hl_blend, which begin at 1

// Makes the values of a slice from its bytes, as http_channel.js does. The number of bytes tells whether the values are
// floats or doubles.
const valuesOf = (buffer, width, height) => ({ values: buffer.byteLength === 4 * width * height ? new Float32Array(buffer) : new Float64Array(buffer), width, height });

const sharesMemory = (module) => WebAssembly.Module.imports(module).some(({ kind }) => kind === "memory");

export class EngineError extends Error {}

export class Engine {
  // Whether the browser has JavaScript Promise Integration, so that a call of the library can wait.
  static waits = typeof WebAssembly.Suspending === "function";

  threads = 1; // the greatest number of threads of a picture
  #exports;
  #memory;
  #files = new Files();

  // hooks: an object with three functions. cancelled() returns whether nobody wants the result of the running call any
  // more. If the engine can wait in the middle of a call (Engine.waits), the function may return a promise of this.
  // progress(fraction) receives the fraction of a file that has been read. help(work) starts a worker that calls
  // Engine.help(work), and returns a promise that is fulfilled when the worker is ready.
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

  // Makes an engine. threads: the greatest number of threads of a picture, if the module is for several threads.
  static async of(module, hooks = {}, threads = globalThis.navigator?.hardwareConcurrency ?? 1) {
    const engine = new Engine(module, hooks);
    if (sharesMemory(module)) engine.threads = Math.min(threads, MOST_THREADS);
    engine.#check(await engine.#exports.web_begin(MEBIBYTES, engine.threads));
    const helpers = engine.fuses ? POOLS * (engine.threads - 1) : 0;
    await Promise.all(Array.from({ length: helpers }, (_, number) => hooks.help(engine.#work(module, number))));
    return engine;
  }

  // Makes the object that a helper's worker gets: the module, the memory, the helper's number and its stack.
  #work(module, number) {
    const { web_room, __tls_size } = this.#exports, room = web_room(STACK + ALIGNED + __tls_size.value) >>> 0;
    if (room === 0) throw new EngineError("no memory for a thread");
    return { module, memory: this.#memory, number, stack: Math.ceil((room + STACK) / ALIGNED) * ALIGNED };
  }

  // Runs the work of the library's pools in a helper's worker, and never returns. The function calls ready() before it
  // begins.
  static help({ module, memory, number, stack }, ready) {
    const { exports } = new WebAssembly.Instance(module, {
      env: { memory },
      wasi_snapshot_preview1: new Files().imports(() => memory),
      page: { cancelled: () => 0, progress: () => {} },
    });
    exports.__stack_pointer.value = stack; // the stack grows downwards; the variables of the thread lie above it
    exports.__wasm_init_tls(stack);
    if (exports.web_helper_arrive(number) === 1) ready();
    exports.web_helper_serve(number);
  }

  // Makes an engine of the first file whose engine gives the same bytes on this machine as on all others, or returns
  // null if there is none. files: WebAssembly files, beginning with the fastest. A file for shared memory is left out
  // if the machine has no room for its memory.
  static async best(files, hooks) {
    for (const bytes of files) {
      const module = WebAssembly.validate(bytes) ? await WebAssembly.compile(bytes) : null;
      const engine = module && await (sharesMemory(module) ? Engine.of(module, hooks).catch(() => null) : Engine.of(module, hooks));
      if (engine?.fuses) return engine;
    }
    return null;
  }

  // Returns whether the engine rounds a product and a sum only once. Engines with relaxed SIMD may round twice.
  get fuses() { return this.#exports.web_fuses() === 1; }

  get memoryHeld() { return this.#exports.web_memory_held(); }

  // Writes a text as UTF-8, or bytes unchanged, to the library's memory. Returns the number of bytes.
  #write(content) {
    const bytes = typeof content === "string" ? new TextEncoder().encode(content) : content, pointer = this.#exports.web_text(bytes.length) >>> 0;
    if (pointer === 0) throw new EngineError("no memory for a scene's text");
    new Uint8Array(this.#memory.buffer, pointer, bytes.length).set(bytes);
    return bytes.length;
  }

  #answer() {
    return new Uint8Array(this.#memory.buffer, this.#exports.web_answer() >>> 0, this.#exports.web_answer_bytes());
  }

  // Decodes the text of an answer. The bytes are copied first, because decoders refuse shared memory.
  #text(answer) { return new TextDecoder().decode(answer.slice()); }

  // Returns the answer of a call, or null if the call was cancelled.
  #check(status) {
    if (status === OK) return this.#answer();
    if (status === CANCELLED) return null;
    throw new EngineError(this.#text(this.#answer()));
  }

  // Calls a function of the library with a short text as its argument.
  async #with(text, call) {
    const bytes = new TextEncoder().encode(`${text}\0`), pointer = this.#exports.web_room(bytes.length) >>> 0;
    new Uint8Array(this.#memory.buffer, pointer, bytes.length).set(bytes);
    try {
      return this.#check(await call(pointer));
    } finally {
      this.#exports.web_release(pointer);
    }
  }

  // Opens one of some files, or a folder of them. contents: { "folder/name": Uint8Array or Blob }. Returns the object
  // of start.json.
  async open(contents, path, title = path) {
    this.#files.replace(contents);
    this.#write(`/${path}`);
    const answer = await this.#with(title, (pointer) => this.#exports.web_open(pointer));
    return answer === null ? null : JSON.parse(this.#text(answer));
  }

  // Opens files as open() does, and adds them to a scene of the open volumes.
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

  // Returns the bytes of a picture, which the caller may keep, or null if the call was cancelled. format: "png", "npy"
  // or "rgba".
  async frame(scene, { format = "rgba", depth = 8, metadata = true, moving = false } = {}) {
    const length = this.#write(JSON.stringify(scene));
    const answer = await this.#with(format, (pointer) => this.#exports.web_frame(length, pointer, depth, +metadata, +moving));
    return answer?.slice() ?? null;
  }

  // Returns the values of a plane of voxels (slice() of http_channel.js), or null if the call was cancelled.
  async slice({ width, height, origin, across, down, through, depth = 1, volume = 0, of = "voxels", blend = "maximum", between = "nearest" }) {
    this.#write(new Uint8Array(Float64Array.of(width, height, depth, ...origin, ...across, ...down, ...through).buffer));
    const answer = this.#check(await this.#exports.web_slice(volume, SOURCES.indexOf(of), 1 + BLENDS.indexOf(blend), +(between === "linear")));
    return answer && valuesOf(answer.slice().buffer, width, height);
  }

  // Returns the depth of the surface that the middle of the scene's picture shows (depth() of http_channel.js), or null
  // if the call was cancelled.
  async depth(scene) {
    const answer = this.#check(await this.#exports.web_depth(this.#write(JSON.stringify(scene))));
    return answer && JSON.parse(this.#text(answer));
  }
}
