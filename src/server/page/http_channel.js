// A viewer's requests to the server that sent its page. All of them stay below the page's own address, which holds
// the token. The widget of notebooks has a channel of its own with the same methods (widget.js).

export class Refused extends Error {}

async function check(response) {
  if (response.ok) return response;
  throw new Refused((await response.text()).trim() || `the viewer answered ${response.status}`);
}

// "render;dur=12.5, encode;dur=3" as { render: 12.5, encode: 3 }, in milliseconds.
function parseTimes(header) {
  return Object.fromEntries((header ?? "").split(", ").map((part) => part.split(";dur=")).map(([k, v]) => [k, +v]));
}

export class HttpChannel {
  #number = 0;
  #opened;
  #page = crypto.getRandomValues(new Uint32Array(2)).reduce((name, n) => name + n.toString(36), "p");

  // opened: the number of what is open (of start.json), whose volumes the scenes have.
  constructor(opened = 0) {
    this.#opened = opened;
  }

  // What is open, and what there is to choose from: start.json.
  async start() {
    return (await check(await fetch("start.json"))).json();
  }

  // The scene with its defaults written out: presets as points, a camera that frames everything.
  async completeScene(scene) {
    return (await check(await fetch(`scene?opened=${this.#opened}`, { method: "POST", body: JSON.stringify(scene) }))).json();
  }

  // A picture of the scene: { blob, times }, or null where a newer frame of this page has cancelled it. `lane` sets
  // frames apart that do not cancel each other.
  async fetchFrame(scene, { format = "jpeg", quality = 85, depth = 8, metadata = true, lane = "" } = {}) {
    const query = new URLSearchParams({ page: this.#page + lane, number: ++this.#number, opened: this.#opened, format, quality, depth, metadata: +metadata });
    const response = await check(await fetch(`frame?${query}`, { method: "POST", body: JSON.stringify(scene) }));
    if (response.status === 204) return null;
    return { blob: await response.blob(), times: parseTimes(response.headers.get("Server-Timing")) };
  }

  // What can be opened in a folder below the one that the viewer was started in: { at, entries }.
  async folder(at) {
    return (await check(await fetch(`folder.json?${new URLSearchParams({ at })}`))).json();
  }

  // Opens a file of the folder, or one that the browser has: what is open then, for a channel of its own.
  async open(file) {
    return (await check(await fetch(`open?${new URLSearchParams({ file })}`, { method: "POST" }))).json();
  }

  async upload(file) {
    return (await check(await fetch(`upload?${new URLSearchParams({ name: file.name })}`, { method: "POST", body: file }))).json();
  }

  // The page is closed, or shows another file: the viewer gives back what it held for this one.
  leave() {
    navigator.sendBeacon(`leave?${new URLSearchParams({ page: this.#page, opened: this.#opened })}`);
  }

  // How far it is read: { part }, from 0 to 1.
  async opening() {
    return (await check(await fetch("opening.json"))).json();
  }

  // The scene at a frame of its film: exactly the one that the film shows there.
  async sceneAt(scene, { turntable, keys, frames }, frame) {
    const query = new URLSearchParams({ opened: this.#opened, turntable, frames, frame });
    keys.forEach((key, n) => query.append(`key${n}`, key));
    return (await check(await fetch(`scene?${query}`, { method: "POST", body: JSON.stringify(scene) }))).json();
  }

  // A film of the scene, as a blob; null: it was stopped.
  async film(scene, { turntable, keys, frames, fps, format }) {
    const query = new URLSearchParams({ page: `${this.#page}-film`, number: ++this.#number, opened: this.#opened, turntable, frames, fps, format });
    keys.forEach((key, n) => query.append(`key${n}`, key));
    const response = await check(await fetch(`film?${query}`, { method: "POST", body: JSON.stringify(scene) }));
    return response.status === 204 ? null : response.blob();
  }

  // { done, frames }.
  async filmProgress() {
    return (await check(await fetch(`film.json?page=${this.#page}-film`))).json();
  }

  async stopFilm() {
    await fetch(`cancel?page=${this.#page}-film&number=${++this.#number}`, { method: "POST" });
  }
}
