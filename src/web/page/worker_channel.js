// A viewer's requests to the library in a worker of the page, in place of a server: the methods of http_channel.js that
// need none.

export class WorkerChannel {
  #worker;
  #number = 0;
  #waiting = new Map(); // by number: { resolve, reject }
  #frames = new Map(); // by lane: the number of the frame under way

  constructor(worker) {
    this.#worker = worker;
    worker.addEventListener("message", ({ data: { number, part, problem, ...answer } }) => {
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

  #ask(kind, content) {
    const number = ++this.#number;
    return new Promise((resolve, reject) => {
      this.#waiting.set(number, { resolve, reject });
      this.#worker.postMessage({ number, kind, ...content });
    });
  }

  // modules: the WebAssembly files' bytes, the quickest first.
  begin(modules) {
    return this.#ask("begin", { modules });
  }

  // What is open: start.json's object. contents: { "folder/name": Uint8Array or Blob }; path: what of it is opened.
  async open(contents, path, title) {
    return (await this.#ask("open", { contents, path, title })).start;
  }

  // What is open when the same was added to a scene of what is open: start.json's object.
  async join(scene, contents, path, title) {
    return (await this.#ask("join", { scene, contents, path, title })).start;
  }

  async completeScene(scene, choices = {}) {
    return (await this.#ask("complete", { scene, choices })).scene;
  }

  // { values, width, height } of a plane of voxels.
  slice(plane) {
    return this.#ask("slice", plane);
  }

  // Null: cancelled.
  async depth(scene) {
    return (await this.#ask("depth", { scene })).found;
  }

  // A new frame ends the frame of its lane that is under way. One that moves ends the probe's, too: there is one worker.
  #cancel(lane) {
    for (const [other, number] of this.#frames)
      if (other === lane || (lane === "" && other === "-probe")) {
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
