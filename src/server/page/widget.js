// The viewer in a notebook: an anywidget (anywidget.dev), whose frames come through the widget's own channel. The Python
// package joins this file and those that it imports to one module (python/halflight/_page.py); the other end of the
// channel is python/halflight/widget.py.

import { make } from "./controls.js";
import { HeldScene } from "./held_scene.js";
import { mount } from "./viewer.js";

const TELL_AFTER = 150; // milliseconds without a change, after which the page sends the scene to Python

class WidgetChannel {
  #model;
  #view = Math.random().toString(36).slice(2); // several views of one widget share its messages
  #number = 0;
  #held = new HeldScene(() => ++this.#number); // frames in lanes always send the whole scene
  #waiting = new Map(); // the functions that take the answers, by the number of the request

  constructor(model) {
    this.#model = model;
    this.listen = (message, buffers) => this.#answered(message, buffers);
    model.on("msg:custom", this.listen);
  }

  close() {
    this.#model.off("msg:custom", this.listen);
    this.#model.send({ kind: "leave", view: this.#view, number: ++this.#number });
  }

  #answered({ view, number, ...answer }, buffers) {
    if (answer.show !== undefined) this.onShow?.(JSON.parse(answer.show));
    const finish = view === this.#view ? this.#waiting.get(number) : undefined;
    this.#waiting.delete(number);
    finish?.(answer, buffers);
  }

  #ask(kind, content, number = ++this.#number) {
    this.#model.send({ kind, view: this.#view, number, ...content });
    return new Promise((resolve, reject) => {
      this.#waiting.set(number, (answer, buffers) => {
        if (answer.problem) reject(Object.assign(new Error(answer.problem), { noBase: answer.no_base === true }));
        else resolve({ ...answer, buffers });
      });
    });
  }

  tell(scene) {
    this.#model.send({ kind: "arrived", view: this.#view, number: 0, scene: JSON.stringify(scene) });
  }

  async start() {
    return JSON.parse((await this.#ask("start", {})).text);
  }

  async completeScene(scene, choices = {}) {
    return JSON.parse((await this.#ask("complete", { scene: JSON.stringify(scene), choices })).text);
  }

  async fetchFrame(scene, { format = "jpeg", quality = 85, depth = 8, metadata = true, moving = false, lane = "" } = {}) {
    const asked = { format, quality, depth, metadata, moving, lane };
    const ask = (number, body, base) => this.#ask("frame", { ...asked, scene: body, ...(base === undefined ? {} : { base }) }, number);
    const { type, times, buffers } = await (lane === "" ? this.#held.send(scene, moving, ask) : ask(++this.#number, JSON.stringify(scene)));
    if (type === undefined) return null; // cancelled
    if (isStill(asked)) this.#model.set("still", buffers[0]); // this sets the page's copy of the trait; no message is sent
    return { blob: new Blob(buffers, { type }), times };
  }
}

// Returns whether a frame is a picture at rest, which is shown if no kernel answers.
const isStill = ({ format, depth, moving, lane }) => format === "png" && depth === 8 && !moving && lane === "";

// Shows the last picture at rest until the viewer has started. In a notebook that was exported to HTML, no
// kernel answers and this picture stays.
function showStill(model, cell) {
  const bytes = model.get("still");
  if (!bytes?.byteLength) return;
  const image = make("img", { class: "halflight-still", alt: "The last frame", src: URL.createObjectURL(new Blob([bytes], { type: "image/png" })) });
  image.addEventListener("load", () => URL.revokeObjectURL(image.src));
  cell.append(image);
}

export async function render({ model, el }) {
  const channel = new WidgetChannel(model), sheet = new CSSStyleSheet(), cell = document.createElement("div");
  const place = document.createElement("div"), shadow = place.attachShadow({ mode: "open" });
  // JupyterLab's keyboard shortcuts and context menu are switched off inside the viewer.
  place.setAttribute("data-lm-suppress-shortcuts", "true");
  place.setAttribute("data-jp-suppress-context-menu", "true");
  sheet.replaceSync(model.get("sheet"));
  shadow.adoptedStyleSheets = [sheet];
  cell.className = "halflight-cell";
  cell.style.height = `${model.get("height")}px`;
  shadow.append(cell);
  el.append(place);
  showStill(model, cell);
  const start = await channel.start();
  const viewer = mount(cell, channel, start);
  el.halflight = viewer; // for the browser's console, and for tests
  // Takes a scene from Python. The picture keeps the size that the page has given it.
  channel.onShow = (scene) => viewer.store.change("python", ({ image: { width, height } }) => (
    { ...scene, image: { ...scene.image, width, height } }));
  let timer = 0;
  viewer.store.listen(() => {
    clearTimeout(timer);
    timer = setTimeout(() => channel.tell(viewer.store.scene), TELL_AFTER);
  });
  return () => channel.close();
}
