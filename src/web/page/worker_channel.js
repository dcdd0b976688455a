// Sends a viewer's requests to the library in a worker of the page. It has the methods of http_channel.js that need no
// server.

export class WorkerChannel {
  // The number of voxels that are prepared in a few tenths of a second: a quarter of what a server prepares, because WebAssembly takes several
  // times as long, often on one thread.
  soonPrepared = 128 ** 3 / 4;
  #worker;
  #helpers = []; // the helpers' workers, so that no browser ends a worker to which nothing refers
  #number = 0;
  #waiting = new Map(); // for each request's number, { resolve, reject }
  #frames = new Map(); // for each lane, the number of the frame that is being rendered

  // url: the address of worker.js.
  constructor(url) {
    const worker = this.#worker = new Worker(url);
    worker.addEventListener("message", ({ data: { number, part, help, problem, ...answer } }) => {
      if (help !== undefined) {
        this.#makeHelper(url, help);
        return;
      }
      if (number === undefined) {
        this.onProgress?.(part);
        return;
      }
      const { resolve, reject } = this.#waiting.get(number);
      this.#waiting.delete(number);
      if (problem === undefined) resolve(answer);
      else reject(new Error(problem));
    });
    worker.addEventListener("error", (event) => {
      for (const { reject } of this.#waiting.values()) reject(new Error(event.message ?? "the worker has ended"));
      this.#waiting.clear();
    });
  }

  // Makes a helper for the worker's threads: the same script in a worker of its own. work: an object for Engine.help().
  #makeHelper(url, work) {
    const helper = new Worker(url), tell = (problem) => this.#worker.postMessage({ kind: "helped", number: work.number, problem });
    this.#helpers.push(helper);
    helper.addEventListener("message", () => tell());
    helper.addEventListener("error", (event) => tell(event.message ?? "a thread has ended"));
    helper.postMessage({ kind: "help", work });
  }

  #ask(kind, content) {
    const number = ++this.#number;
    return new Promise((resolve, reject) => {
      this.#waiting.set(number, { resolve, reject });
      this.#worker.postMessage({ number, kind, ...content });
    });
  }

  // Starts the engine. module: the bytes of a WebAssembly file. Returns the number of threads, which is 0 if the file does not suit
  // the browser; then another file may be tried.
  async begin(module) {
    return (await this.#ask("begin", { modules: [module] })).threads;
  }

  // Opens files, and returns the object of start.json. contents: { "folder/name": Uint8Array or Blob }; path: the file
  // or folder among them that is opened.
  async open(contents, path, title) {
    return (await this.#ask("open", { contents, path, title })).start;
  }

  // Opens files as open() does, and adds them to a scene of the open volumes. Returns the object of start.json.
  async join(scene, contents, path, title) {
    return (await this.#ask("join", { scene, contents, path, title })).start;
  }

  async completeScene(scene, choices = {}) {
    return (await this.#ask("complete", { scene, choices })).scene;
  }

  // Returns { values, width, height } of a plane of voxels.
  slice(plane) {
    return this.#ask("slice", plane);
  }

  // Returns the depth, or null if the request was cancelled.
  async depth(scene) {
    return (await this.#ask("depth", { scene })).found;
  }

  // Cancels the unfinished frame of a lane, because a new frame of this lane begins. There is only one worker: a new frame
  // of the main lane also cancels the frames of the other lanes, which the page asks for again when the picture rests.
  // Only the picture that is saved is not asked for again.
  #cancel(lane) {
    for (const [other, number] of this.#frames)
      if (other === lane || (lane === "" && other !== "-save")) {
        this.#worker.postMessage({ kind: "cancel", number });
        this.#frames.delete(other);
      }
  }

  async fetchFrame(scene, { format = "jpeg", quality = 85, depth = 8, metadata = true, moving = false, lane = "" } = {}) {
    this.#cancel(lane);
    const asked = this.#ask("frame", { scene, format, quality, depth, metadata, moving }), number = this.#number;
    this.#frames.set(lane, number);
    try {
      const { blob, times } = await asked;
      return blob === null ? null : { blob, times };
    } finally {
      if (this.#frames.get(lane) === number) this.#frames.delete(lane);
    }
  }
}
