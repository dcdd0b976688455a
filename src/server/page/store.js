// The scene that the page shows, and its history. The scene is the program's own scene file as an object: what is
// sent for a frame, downloaded and rendered elsewhere is this object and nothing else.

const MOST_STEPS = 100; // that can be undone
const SAME_GESTURE = 700; // milliseconds within which changes of one name are one step

// What is undone: everything but the camera and the picture's size.
function snapshot(scene) {
  const { camera, image: { width, height, ...image }, ...rest } = scene;
  return JSON.stringify({ ...rest, image });
}

function restored(scene, text) {
  const { image, ...rest } = JSON.parse(text), { width, height } = scene.image;
  return { ...rest, camera: scene.camera, image: { ...image, width, height } };
}

export class Store {
  #listeners = [];
  #undo = [];
  #redo = [];
  #last = { name: "", at: 0 };

  constructor(scene) {
    this.scene = { volumes: [], ...scene }; // a scene may be of meshes alone
  }

  // listener(scene, name) is called after every change.
  listen(listener) {
    this.#listeners.push(listener);
  }

  // Replaces the scene by change(scene), which must not alter its argument. `name` says what changes ("camera",
  // "light 0"); changes of one name that follow each other closely are undone together.
  change(name, change) {
    const before = this.scene;
    this.scene = change(before);
    if (!["camera", "size", "time"].includes(name)) this.#remember(name, before);
    this.#tell(name);
  }

  setCamera(camera) {
    this.change("camera", (scene) => ({ ...scene, camera }));
  }

  changeLight(index, name, change) {
    this.change(`light ${index} ${name}`, (scene) => ({
      ...scene, lights: scene.lights.map((light, l) => (l === index ? change(light) : light)),
    }));
  }

  changeVolume(index, name, change) {
    this.change(`volume ${index} ${name}`, (scene) => ({
      ...scene, volumes: scene.volumes.map((volume, v) => (v === index ? change(volume) : volume)),
    }));
  }

  changeRender(key, value) {
    this.change(`render ${key}`, (scene) => ({ ...scene, render: { ...scene.render, [key]: value } }));
  }

  #remember(name, before) {
    const now = performance.now();
    const same = name === this.#last.name && now - this.#last.at < SAME_GESTURE;
    this.#last = { name, at: now };
    if (same) return;
    this.#undo.push(snapshot(before));
    if (this.#undo.length > MOST_STEPS) this.#undo.shift();
    this.#redo = [];
  }

  get canUndo() { return this.#undo.length > 0; }
  get canRedo() { return this.#redo.length > 0; }

  undo() { this.#step(this.#undo, this.#redo); }
  redo() { this.#step(this.#redo, this.#undo); }

  #step(from, to) {
    if (from.length === 0) return;
    to.push(snapshot(this.scene));
    this.scene = restored(this.scene, from.pop());
    this.#last = { name: "", at: 0 };
    this.#tell("history");
  }

  #tell(name) {
    for (const listener of this.#listeners) listener(this.scene, name);
  }
}
