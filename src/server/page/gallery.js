// A gallery of choices, such as looks: for each choice, a small picture shows the open scene with that choice from the present view.
// The small pictures are made while the main picture is at rest. A click takes a choice.

import { reshaped } from "./camera.js";
import { make } from "./controls.js";
import { difference } from "./link.js";

const SIDES = { width: 112, height: 80 }; // pixels
const STEP = 2; // voxels between sheets
const LEAST_WIDTH = 76; // pixels of a choice on the page, with the gap beside it

const LANE = "-small";

// The small pictures of all galleries are made one after the other, in one lane of the channel. The server keeps one renderer for
// the lane, which is released after the last small picture. Returns a function of a scene, which asks for a picture as a channel's
// fetchFrame() does, if isWanted() still holds when the picture's turn comes; it resolves to null otherwise. A small picture that
// is being made when the scene changes is cancelled.
export function smallPictures(channel, store) {
  let last = Promise.resolve(), shown = store.scene, underWay = 0;
  store.listen((scene) => {
    if (scene !== shown && underWay > 0) channel.cancel?.(LANE).catch(() => {}); // the page already shows an error if the server is lost
    shown = scene;
  });
  return (scene, isWanted) => {
    underWay++;
    const picture = last.then(() => (isWanted() ? channel.fetchFrame(scene, { quality: 85, moving: true, lane: LANE }) : null)).finally(() => { underWay--; });
    last = picture.catch(() => {}); // the caller that has requested the picture gets the error
    return picture;
  };
}

// Returns the number of columns such that the choices need as few rows as the width allows and fill these rows
// as evenly as possible.
export function evenColumns(count, width) {
  const most = Math.max(1, Math.floor(width / LEAST_WIDTH)), rows = Math.max(1, Math.ceil(count / most));
  return Math.max(1, Math.ceil(count / rows));
}

// names: the names of the choices. made(name) resolves to the scene with the choice. take(name, scene) makes the choice. isTaken(scene): whether the viewer
// shows the choice's scene now. seen(scene): returns the part of a scene on whose change a small picture is made anew. Returns { element, update, atRest }:
// atRest() is called when the picture has come to rest.
export function gallery({ label, names, viewer: { store, smallPicture, failed, frames, waits }, made, take, isTaken, seen }) {
  const canvases = new Map(), scenes = new Map(), pictured = new Map(); // three maps by name; pictured: the part of the scene, as seen() returns it, that the small picture shows
  const buttons = names.map((name) => {
    const canvas = make("canvas", { "aria-hidden": "true", ...SIDES });
    canvases.set(name, canvas);
    return make("button", { type: "button", class: "choice", "aria-pressed": "false", onclick: () => choose(name) }, canvas, make("span", {}, name));
  });
  const element = make("div", { class: "gallery", role: "group", "aria-label": label }, ...buttons);
  new ResizeObserver(([{ contentRect: { width } }]) => { element.style.gridTemplateColumns = `repeat(${evenColumns(names.length, width)}, minmax(0, 1fr))`; }).observe(element);
  let busy = false, shown = null, drawn = 0; // drawn: number of small pictures of the scene `shown` that are finished

  async function choose(name) {
    try {
      const scene = await waits(made(name));
      scenes.set(name, scene);
      take(name, scene);
    } catch (error) {
      failed(error);
    }
  }

  const isResting = () => frames().statistics.stage === "final" && element.checkVisibility();

  async function draw(name) {
    const scene = await made(name), image = { ...scene.image, ...SIDES };
    scenes.set(name, scene);
    const small = { ...scene, image, camera: reshaped(store.scene.camera, store.scene.image, image), render: { ...scene.render, sheet_spacing: Math.max(STEP, scene.render.sheet_spacing), pixel_samples: 0 } };
    if (pictured.has(name) && difference(pictured.get(name), seen(scene)) === undefined) return true;
    const frame = await smallPicture(small, () => isResting() && shown === store.scene);
    if (frame === null) return false;
    pictured.set(name, seen(scene));
    const bitmap = await createImageBitmap(frame.blob), canvas = canvases.get(name);
    canvas.getContext("2d").drawImage(bitmap, 0, 0);
    canvas.dataset.drawn = "";
    bitmap.close();
    return true;
  }

  async function atRest() {
    if (busy) return;
    busy = true;
    element.dataset.busy = ""; // tests wait until this attribute is gone
    const follow = () => {
      if (shown !== store.scene) [shown, drawn] = [store.scene, 0];
      return drawn < names.length;
    };
    try {
      while (isResting() && follow()) if (await draw(names[drawn])) drawn++;
    } catch {
      drawn = names.length; // after an error, the choices are shown by their names, without pictures
    }
    busy = false;
    delete element.dataset.busy;
    update();
  }

  function update() {
    names.forEach((name, n) => buttons[n].setAttribute("aria-pressed", String(scenes.has(name) && isTaken(scenes.get(name)))));
  }
  return { element, update, atRest };
}
