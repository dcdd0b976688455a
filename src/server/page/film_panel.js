// The panel of films. A film consists of a turn of the camera and of keys, which the timeline shows. Keys set the
// camera, or numbers and vectors of the scene. `halflight animate` makes the same film. "Pictures" are numbered PNGs
// in a zip archive, which need no ffmpeg.

import { reshaped } from "./camera.js";
import { button, isActive, make, row, section, select, toggle } from "./controls.js";
import { download, fileWord, quoted, sceneText, stem } from "./export.js";
import { placesOf } from "./light.js";
import { difference } from "./link.js";
import { CAMERA, FORMATS, MOST_FPS, MOST_FRAMES, isKeyable, joined, keyTexts, readFilm, stretched, trackName, trackOf, valueAt, withKey, withValue } from "./timeline.js";
import { timelineStrip } from "./timeline_strip.js";

const ASK_EVERY = 300; // milliseconds between questions for the film's progress

// The paths of all numbers of a scene, as keys name them.
export function numberPaths(value, path = "") {
  if (typeof value === "number") return [path];
  if (value === null || typeof value !== "object") return [];
  return Object.entries(value).flatMap(([key, part]) => numberPaths(part, path ? `${path}.${key}` : key));
}

// Returns whether the scene has, or may have, the value at a track's path. A missing member of an object may be added, because
// members have defaults; a missing element of a list may not.
function hasPlace(scene, path) {
  const names = path.split("."), present = names.findIndex((_, n) => valueAt(scene, names.slice(0, n + 1).join(".")) === undefined);
  return present < 0 || !names.slice(present).some((name) => /^\d+$/.test(name));
}

export const animateCommand = (scene, title, { turntable, frames, keys, fps, format }) =>
  [`halflight animate - --frames ${frames} ${turntable > 0 ? `--turntable ${turntable} ` : ""}`, ...keys.map((key) => `--key ${quoted(key)} `),
    `--fps ${fps} -o ${fileWord(title, format === "zip" ? "" : `.${format}`)} <<'END'\n${sceneText(scene)}END\n`].join("");

function timeLeft(seconds) {
  return seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.ceil(seconds / 60)} min`;
}

const NEW = { tracks: [], frames: 120, fps: 30, turns: false, frame: 0, format: "mp4", open: false };

// The film that a person makes: its tracks and length, the frame that the page shows, and the scene without
// the changes of this frame. The film is kept in store.page.film, so that the session contains the film.
class Film {
  playing = false;
  scene;
  changed = () => {};
  taken = () => {}; // called when a session has replaced the film
  #kept; // the value of store.page.film when this film was last stored there or read from there
  #viewer;
  #edits = 0; // number of changes by a person; a new size of the window does not count
  #asking = false;
  #again = false;
  #seen; // the store's scene at its last change
  #own = new Set(); // paths of values that the film changes and that a person has changed since the frame's scene was requested

  constructor(viewer) {
    this.#viewer = viewer;
    this.#seen = viewer.store.scene;
    this.#take();
    viewer.store.listen((...change) => this.#follow(...change));
  }

  // Reads the film from the page's state. The turn of a film starts from the stored camera `from`, because the shown frame's
  // camera has been turned already.
  #take() {
    const { scene, page } = this.#viewer.store, { from, ...film } = readFilm(page.film);
    this.#kept = page.film;
    Object.assign(this, NEW, film, { tracks: joined(film.tracks, scene) });
    this.scene = this.turns && from !== undefined ? { ...scene, camera: reshaped(from.camera, from.image, scene.image) } : scene;
  }

  // Stores the film in the page's state. edits: whether the change is a step that can be undone;
  // going to a frame is not such a step.
  #keep(edits) {
    const { tracks, frames, fps, turns, frame, format, open, scene } = this, { camera, image: { width, height } } = scene;
    this.#kept = { tracks, frames, fps, turns, frame, format, open, ...(turns ? { from: { camera, image: { width, height } } } : {}) };
    if (edits) this.#viewer.store.setFilm(this.#kept);
    else this.#viewer.store.setPage({ film: this.#kept });
  }

  // A track whose path the scene does not have any more, for example because a light was removed;
  // undefined if there is no such track.
  get #gone() { return this.tracks.find(({ path }) => path !== CAMERA && !hasPlace(this.scene, path)); }

  // The paths of all values of the scene that the film changes.
  get #changes() { return [...this.tracks.map(({ path }) => path), ...(this.turns ? [CAMERA] : [])]; }

  get #isEmpty() { return this.tracks.length === 0 && !this.turns; }

  // A turn starts from the camera that a person has chosen, not from the turned camera of the shown frame.
  #follow(scene, name, frame) {
    const before = this.#seen;
    this.#seen = scene;
    if (frame !== undefined) {
      this.#followHistory(scene, frame);
      return;
    }
    if (this.#viewer.store.page.film !== this.#kept) {
      this.#edits++;
      this.#take();
      this.taken();
      return;
    }
    if (name === "time" || name === "page") return;
    if (name !== "size") {
      this.#edits++;
      this.playing = false;
      this.#changes.filter((path) => difference(valueAt(before, path), valueAt(scene, path)) !== undefined).forEach((path) => this.#own.add(path));
    }
    this.scene = !this.turns || name === "camera" ? scene : { ...scene, camera: this.scene.camera };
    this.changed();
  }

  // Follows a step of the history, whose scene is that of a frame of the film. The history does not contain cameras, so that a turn starts
  // from the same camera as before the step.
  #followHistory(scene, frame) {
    const { turns, scene: { camera } } = this, isOther = this.#viewer.store.page.film !== this.#kept;
    this.#edits++;
    this.playing = false;
    if (isOther) this.#take();
    else this.scene = scene;
    if (turns || this.turns) this.scene = { ...this.scene, camera };
    if (isOther && this.turns) this.#keep(false);
    if (isOther) this.taken();
    else this.changed();
    if (turns !== this.turns || (frame !== this.frame && !this.#isEmpty)) this.#showScene();
  }

  get wanted() {
    const { frames, fps, format } = this;
    return { turntable: this.turns ? frames : 0, frames, fps, format, keys: keyTexts(this.tracks, this.scene.camera.type) };
  }

  set(part) {
    const before = this.frames;
    Object.assign(this, part);
    if (this.frames !== before) {
      this.tracks = stretched(this.tracks, before, this.frames);
      this.frame = Math.round((this.frame * (this.frames - 1)) / (before - 1));
    }
    const edits = ["tracks", "frames", "fps", "turns", "format"].some((key) => key in part);
    if (edits || !this.playing) this.#keep(edits); // frames that are shown while the film plays are not stored
    this.changed();
  }

  // Changes the film, and shows the changed scene of its present frame.
  edit(part) {
    const wasEmpty = this.#isEmpty;
    this.set(part);
    if (!wasEmpty || !this.#isEmpty) this.#showScene();
  }

  // Goes to a frame.
  async show(frame) {
    this.set({ frame });
    if (!this.#isEmpty) await this.#showScene();
  }

  // Shows the scene of the film's frame. If several frames are requested before the scene arrives, only the
  // last frame is shown.
  async #showScene() {
    const { channel, store, waits } = this.#viewer;
    if (!channel.sceneAt) return;
    this.#own.clear();
    this.#again = store.isDue = true;
    if (this.#asking) return;
    this.#asking = true;
    await waits(this.#takeScenes());
  }

  // Requests the scene of the frame. The request is repeated if another frame is wanted, or the scene was changed, before the answer came.
  // No picture counts as final until the scene has been taken.
  async #takeScenes() {
    const { channel, store, report } = this.#viewer;
    while (this.#again) {
      this.#again = false;
      const before = this.#edits, gone = this.#gone;
      try {
        if (gone !== undefined) throw new Error(`The scene no longer has what this track of the film changes: ${trackName(gone.path)}.`);
        const at = await channel.sceneAt(this.scene, this.wanted, this.frame);
        if (this.#edits === before) store.change("time", (scene) => this.#withOwn({ volumes: [], ...at }, scene));
        else this.#again = true;
      } catch (error) {
        this.playing = false;
        report(error.message);
      }
    }
    this.#asking = store.isDue = false;
    this.changed();
  }

  // Returns the frame's scene with the picture's present size and with the changes that a person has made since the scene was requested.
  // These changes stay visible until the next frame is shown, as do all changes between keys.
  #withOwn(at, now) {
    const { width, height } = now.image, sized = { ...at, image: { ...at.image, width, height } };
    return [...this.#own].filter((path) => valueAt(now, path) !== undefined).reduce((scene, path) => withValue(scene, path, valueAt(now, path)), sized);
  }

  async play() {
    this.set({ playing: !this.playing });
    const began = performance.now() - (1000 * this.frame) / this.fps;
    while (this.playing) {
      await this.show(Math.floor(((performance.now() - began) / 1000) * this.fps) % this.frames);
      await new Promise((resolve) => requestAnimationFrame(resolve));
    }
  }
}

// The buttons that make the film, its progress, and a button that ends it.
function maker(film, { store, channel }) {
  const bar = make("progress", { max: 1, value: 0, hidden: true, "aria-label": "The film" }), told = make("p", { class: "facts", role: "status" });
  const go = button("make film", run, { class: "primary" }), stop = button("stop", () => channel.cancel("-film"), { hidden: true });

  async function tellProgress(began) {
    const { done, frames } = await channel.filmProgress().catch(() => ({ done: 0, frames: 0 }));
    if (frames === 0) return;
    bar.value = done / frames;
    const left = done > 0 ? `, ${timeLeft(((performance.now() - began) / 1000 / done) * (frames - done))} left` : "";
    told.textContent = done < frames ? `frame ${done + 1} of ${frames}${left}` : `all ${frames} frames are made; the file is being written`;
  }

  async function run() {
    const began = performance.now(), wanted = film.wanted, name = `${stem(store.title)}.${wanted.format}`;
    film.playing = false;
    go.hidden = true;
    stop.hidden = bar.hidden = false;
    told.textContent = "begins …";
    const asking = setInterval(() => tellProgress(began), ASK_EVERY);
    try {
      const made = await channel.film(film.scene, wanted);
      if (made !== null) download(made, name);
      told.textContent = made === null ? "stopped" : `saved ${name}`;
    } catch (error) {
      told.textContent = error.message;
    }
    clearInterval(asking);
    stop.hidden = bar.hidden = true;
    go.hidden = false;
  }
  return [row("", make("span", { class: "buttons" }, go, stop)), bar, told];
}

export function filmPanel(viewer) {
  const { store, current, channel, report, copy, find, root } = viewer, film = new Film(viewer);
  const { element, body } = section("Film", false);
  const number = (label, key, low, high) => make("input", {
    type: "number", min: low, max: high, step: 1, value: film[key], "aria-label": label,
    onchange: (event) => film[key === "frames" ? "edit" : "set"]({ [key]: Math.min(Math.max(Math.round(+event.target.value) || film[key], low), high) }),
  });
  const lengths = [number("Frames of the film", "frames", 2, MOST_FRAMES), number("Frames a second", "fps", 1, MOST_FPS)];
  const names = make("datalist", { id: "film-paths" });
  const path = make("input", { type: "text", list: "film-paths", "aria-label": "A number of the scene", placeholder: "lights.0.intensity" });
  const turn = toggle({ label: "Whole turn", get: () => film.turns, set: (turns) => film.edit({ turns }) });
  const kind = select({
    label: "Format", choices: FORMATS, get: () => film.format, set: (format) => film.set({ format }),
  });
  const strip = timelineStrip({ get: () => film, setTracks: (tracks) => film.edit({ tracks }), show: (frame) => film.show(frame), play: () => film.play(), canShow: channel.sceneAt !== undefined });

  const addKey = (name, value) => film.set({ tracks: withKey(film.tracks, name, film.frame, value) });
  function addKeys({ paths, write }) {
    const isThere = () => paths.every((name) => isKeyable(valueAt(store.scene, name)));
    if (!isThere()) write?.();
    if (isThere()) paths.forEach((name) => addKey(name, valueAt(store.scene, name)));
    else report("This number is not in the scene yet: change it first.");
  }
  root.addEventListener("halflight-key", ({ detail }) => addKeys(detail)); // a button beside a slider (controls.js)
  function addLight() {
    const light = store.scene.lights[current.light];
    if (light) addKeys({ paths: placesOf(light, current.light) });
    else report("The scene has no light.");
  }
  function addNumber() {
    const name = trackOf(store.scene, path.value.trim()), value = valueAt(store.scene, name);
    if (isKeyable(value)) addKey(name, value);
    else report("Choose a number of the scene first: the list has all of them.");
  }

  function unfold() {
    strip.element.hidden = !element.open;
    root.classList.toggle("filming", element.open);
    if (element.open) names.replaceChildren(...[...new Set(numberPaths(store.scene).map((one) => trackOf(store.scene, one)))].map((value) => make("option", { value })));
    strip.update();
  }
  element.addEventListener("toggle", () => {
    unfold();
    if (element.open !== film.open) film.set({ open: element.open });
  });
  find("workspace").after(strip.element);
  body.append(
    row(make("span", { class: "name" }, "Length"), make("span", { class: "pair" }, lengths[0], "frames, at", lengths[1], "/ s")),
    turn.element,
    row(make("span", { class: "name" }, "Keys"), button("key of the camera now", () => addKey(CAMERA, store.scene.camera))),
    row("", button("key of the light's place now", addLight)),
    names, row("", path), row("", button("key of this number now", addNumber)),
    ...(channel.film ? [kind.element, ...maker(film, viewer)] : []),
    row("", button("copy animate command", () => copy(animateCommand(film.scene, store.title, film.wanted), "the command"))),
    make("p", { class: "facts" }, "Choose a frame below the picture. Turn the camera, drag a light or move a slider. Then add a key: a button above for the camera or the chosen light, ◆ in the row of the slider."));
  film.changed = () => {
    strip.update();
    turn.update();
    kind.update();
    lengths.forEach((one, n) => { if (!isActive(one)) one.value = film[["frames", "fps"][n]]; });
  };
  film.taken = () => {
    element.open = film.open;
    unfold();
    film.changed();
  };
  film.taken();
  return { element, update: () => {}, film };
}
