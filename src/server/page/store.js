// A person's work and its history: the scene, the marks in it, and how the page shows them. The scene is the
// program's own scene file as an object. Exactly this object is sent for a frame, downloaded, and rendered
// elsewhere. Objects are never altered, only replaced.

import { reshaped } from "./camera.js";
import { KINDS } from "./current.js";
import { difference } from "./link.js";
import { readMarks } from "./marks.js";

const MOST_STEPS = 100; // the most steps that can be undone, for each history
const UNREMEMBERED = ["camera", "size", "time", "page"]; // names of changes that are no steps of the main history

// The settings of the page that are undone besides the film. The crosshair and which sections are unfolded are left as they are.
const KEPT = [...KINDS, "aside", "layout", "plane", "oblique", "windows", "thickness", "blend", "showLabels", "showIsolines", "bookmarks", "over", "unit"];

const keptOf = (page) => Object.fromEntries(KEPT.map((key) => [key, page[key]]));

// The number of the frame that a film shows.
const frameOf = (film) => film?.frame ?? 0;
const NO_FRAME = -1; // stands for a scene that is not the scene of the film's frame

// Returns the state that undo restores: the scene without the camera and the picture's size, the marks, the film, some settings of the
// page, and the source and the title of the scene's files.
function lasting({ scene: { camera, image: { width, height, ...image }, ...rest }, marks, page, source, title, isDue }) {
  return { rest, image, marks, film: page.film, frame: isDue ? NO_FRAME : frameOf(page.film), shown: keptOf(page), source, title };
}

// Returns whether two films have the same keys, length and format. The films may be at different frames, and may
// turn from different cameras.
const isSameFilm = (a, b) => ["tracks", "frames", "fps", "turns", "format"].every((key) => a?.[key] === b?.[key]);

// Returns a film of the history, with the frame of the present film and with the film's panel open
// or closed as it is now.
const filmAgain = (film, now) => ({ ...film, frame: film ? Math.min(frameOf(now), film.frames - 1) : 0, open: now?.open ?? false });

const isSame = (a, b) => Object.keys({ ...a, ...b }).every((key) => a[key] === b[key]);

// Returns whether two parts of a scene or of the page would be equal in a file.
const isAlike = (a, b) => a === b || difference(a, b) === undefined;

export class Store {
  #listeners = [];
  #undo = [];
  #redo = [];
  #undoCamera = []; // { camera, image: { width, height } }
  #redoCamera = [];
  #gesture = 0; // number of the present gesture, or of the last gesture if none is under way
  #holds = false; // a gesture is under way
  #last = { name: "", gesture: -1 };
  #lastCamera = -1; // number of the gesture in which the camera was last moved
  #shown = { scene: null, levels: [] }; // the resolutions of the volumes in the picture of this scene
  isDue = false; // the scene of the film's frame has been requested and has not arrived

  // scene: a scene file, which may have marks. marks: a person's measures and texts (marks.js) in place of those of the file. page: settings that are no part
  // of pictures: layout, crosshair, bookmarks, film. source: the argument with which open() of http_channel.js opens the scene's files, or null. title: the
  // name of the scene's files.
  constructor({ marks: own, ...scene }, { marks = readMarks(own), page = {}, history = null, source = null, title = "" } = {}) {
    this.scene = { volumes: [], ...scene }; // a scene may consist of meshes only
    this.marks = marks;
    this.page = page;
    this.source = source;
    this.title = title;
    if (history !== null) [this.#undo, this.#redo, this.#undoCamera, this.#redoCamera] = history;
  }

  // The scene file: the scene with its marks.
  get file() {
    return this.marks.length > 0 ? { ...this.scene, marks: this.marks } : this.scene;
  }

  // The scene file of the picture that is shown, whose volumes have the resolutions of the picture (frames.js).
  get shownFile() {
    const { file } = this, levels = this.#shown.scene === this.scene ? this.#shown.levels : [];
    return levels.some((level) => level >= 0) ? { ...file, volumes: file.volumes.map((volume, v) => (levels[v] >= 0 ? { ...volume, level: levels[v] } : volume)) } : file;
  }

  // Notes the resolutions that the shown picture has of the scene's volumes. A level below 0: the volume
  // has only one resolution.
  showsLevels(scene, levels) {
    this.#shown = { scene, levels };
  }

  // listener(scene, name, frame) is called after every change. frame: after undo or redo, the number of the film's frame whose scene was
  // restored; the film stays at its present frame.
  listen(listener) {
    this.#listeners.push(listener);
  }

  // Begins a gesture: all changes until endGesture() are undone together.
  beginGesture() {
    this.#gesture++;
    this.#holds = true;
  }

  endGesture() {
    this.#gesture++;
    this.#holds = false;
  }

  // Replaces the scene by change(scene), which must not alter its argument. `name` says what changes ("camera", "light 0").
  // Successive changes outside of gestures are undone together if they have the same name and no gesture lies between them.
  // A change that leaves the scene as it is makes no step.
  change(name, change) {
    const scene = change(this.scene);
    if (!isAlike(scene, this.scene)) {
      if (name === "camera") this.#rememberCamera();
      else this.#remember(name);
      this.scene = scene;
    }
    this.#tell(name);
  }

  setMarks(name, marks) {
    if (!isAlike(marks, this.marks)) {
      this.#remember(`marks ${name}`);
      this.marks = marks;
    }
    this.#tell("marks");
  }

  // Changes the film's keys, its length or its format.
  setFilm(film) {
    if (!isAlike(film, this.page.film)) this.#remember("film");
    this.setPage({ film });
  }

  // Changes parts of what the page shows besides pictures.
  setPage(part) {
    const changed = KEPT.filter((key) => key in part && !isAlike(part[key], this.page[key]));
    if (changed.length > 0) this.#remember(`page's ${changed}`);
    this.page = { ...this.page, ...part };
    this.#tell("page");
  }

  // Returns the part that a switch has taken out of the scene, so that the switch can put the part
  // back; undefined: there is no such part.
  aside(name) {
    return this.page.aside?.[name];
  }

  putAside(name, what) {
    this.setPage({ aside: { ...this.page.aside, [name]: what } });
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

  // Replaces the whole state by a session or a scene that was opened, as one step of the history. The
  // picture keeps its size.
  replace({ scene: { marks: own, ...scene }, marks = own === undefined ? this.marks : readMarks(own), page = this.page, source = this.source, title = this.title }) {
    const { width, height } = this.scene.image;
    this.beginGesture();
    this.#remember("replace");
    this.#rememberCamera();
    this.scene = { volumes: [], ...scene, camera: reshaped(scene.camera, scene.image, { width, height }), image: { ...scene.image, width, height } };
    this.marks = marks;
    this.page = page;
    this.source = source;
    this.title = title;
    this.endGesture();
    this.#tell("history");
  }

  // ---- the history ----

  #remember(name) {
    if (UNREMEMBERED.includes(name)) return;
    const same = this.#last.gesture === this.#gesture && (this.#holds || this.#last.name === name);
    this.#last = { name, gesture: this.#gesture };
    if (same) return;
    this.#push(this.#undo, lasting(this));
    this.#redo = [];
  }

  #view() {
    const { camera, image: { width, height } } = this.scene;
    return { camera, image: { width, height } };
  }

  #rememberCamera() {
    if (this.#lastCamera === this.#gesture) return;
    this.#lastCamera = this.#gesture;
    this.#push(this.#undoCamera, this.#view());
    this.#redoCamera = [];
  }

  #push(steps, step) {
    steps.push(step);
    if (steps.length > MOST_STEPS) steps.shift();
  }

  // The scene before the last step that changed it, with the present camera and picture size; null: there is no
  // such step.
  get before() {
    const now = lasting(this), step = this.#undo.findLast(({ rest, image }) => !isSame(rest, now.rest) || !isSame(image, now.image));
    if (step === undefined) return null;
    const { rest, image } = step, { camera, image: { width, height } } = this.scene;
    return { ...rest, camera, image: { ...image, width, height } };
  }

  get canUndo() { return this.#undo.length > 0; }
  get canRedo() { return this.#redo.length > 0; }
  get canUndoCamera() { return this.#undoCamera.length > 0; }
  get canRedoCamera() { return this.#redoCamera.length > 0; }
  // The history for a store that replaces this store; the replacement is the next step of the
  // history.
  get historyBefore() {
    const further = (steps, step) => [...steps, step].slice(-MOST_STEPS);
    return [further(this.#undo, lasting(this)), [], further(this.#undoCamera, this.#view()), []];
  }
  get history() { return [this.#undo, this.#redo, this.#undoCamera, this.#redoCamera]; }

  undo() { this.#step(this.#undo, this.#redo); }
  redo() { this.#step(this.#redo, this.#undo); }
  undoCamera() { this.#stepCamera(this.#undoCamera, this.#redoCamera); }
  redoCamera() { this.#stepCamera(this.#redoCamera, this.#undoCamera); }

  #step(from, to) {
    if (from.length === 0) return;
    const now = lasting(this), { rest, image, marks, film, frame = frameOf(film), shown = now.shown, source, title } = from.pop();
    to.push(now);
    this.marks = marks;
    this.page = { ...this.page, ...keptOf(shown), ...(isSameFilm(film, now.film) ? {} : { film: filmAgain(film, now.film) }) };
    this.source = source ?? null;
    this.title = title ?? this.title;
    this.#last = { name: "", gesture: -1 };
    // A step that changed only marks leaves the scene as it is, and so starts no new picture.
    if (!isSame(rest, now.rest) || !isSame(image, now.image)) {
      const { camera, image: { width, height } } = this.scene;
      this.scene = { ...rest, camera, image: { ...image, width, height } };
    }
    this.#tell("history", frame);
  }

  #stepCamera(from, to) {
    if (from.length === 0) return;
    const { camera, image } = from.pop();
    to.push(this.#view());
    this.#lastCamera = -1;
    this.scene = { ...this.scene, camera: reshaped(camera, image, this.scene.image) };
    this.#tell("camera");
  }

  #tell(name, frame) {
    for (const listener of this.#listeners) listener(this.scene, name, frame);
  }
}
