// The comparison of two pictures: a line that can be dragged divides the picture. To the left of the line is the same view
// with other shadows, with the scene that the user kept earlier, or with the scene before the last step of the history.

import { make, row, button, select } from "./controls.js";
import { followDrag } from "./drag.js";

const KEY_STEP = 0.05; // how far an arrow key moves the line, as a fraction of the picture's width
const CHOICES = ["off", "hard", "soft", "before", "kept"];
const NAMES = { off: "without shadows", hard: "hard shadows", soft: "soft shadows", kept: "kept before", before: "before" };

const withShadows = (scene, shadows) => ({ ...scene, render: { ...scene.render, shadows }, lights: scene.lights.map((light) => (light.shadows === "off" ? light : (({ shadows: _, ...rest }) => rest)(light))) });

// Returns { elements, update, atRest, compare, compareButton }: elements are rows of the panel of shadows; compare(what) chooses what is
// shown; compareButton() makes a row for another panel.
export function comparison({ store, channel, failed, find, report }) {
  const canvas = make("canvas", { class: "compared", "aria-hidden": "true", hidden: true });
  const left = make("span", { class: "side" }), right = make("span", { class: "side" });
  const line = make("div", {
    class: "divider", tabindex: 0, role: "slider", "aria-label": "Where the compared pictures meet", "aria-valuemin": 0, "aria-valuemax": 100, hidden: true,
    onpointerdown: grab, onkeydown: key,
  }, left, right);
  const view = find("view");
  let what = "", kept = null, before = null, part = 0.5, asked = null;
  find("picture").after(canvas);
  find("overlay").after(line);

  function place() {
    left.toggleAttribute("data-making", canvas.hidden); // while the canvas is hidden, both sides of the line show the present picture
    canvas.style.clipPath = `inset(0 ${100 * (1 - part)}% 0 0)`;
    line.style.left = `${100 * part}%`;
    line.style.setProperty("--part", part);
    line.setAttribute("aria-valuenow", Math.round(100 * part));
  }

  function grab(event) {
    event.stopPropagation();
    event.preventDefault();
    line.focus({ preventScroll: true });
    const box = view.getBoundingClientRect();
    followDrag(event, line, (moved) => {
      part = Math.min(Math.max((moved.clientX - box.left) / box.width, 0), 1);
      place();
    });
  }

  function key(event) {
    const step = { ArrowLeft: -KEY_STEP, ArrowRight: KEY_STEP }[event.key];
    if (event.key === "Escape") compare("");
    else if (step) part = Math.min(Math.max(part + step, 0), 1);
    else return;
    place();
    event.preventDefault();
    event.stopPropagation();
  }

  // Returns the scene that is shown to the left of the line.
  function other(scene) {
    const past = { kept, before }[what];
    if (past === undefined) return withShadows(scene, what);
    const { width, height } = scene.image;
    return { ...past, camera: scene.camera, image: { ...past.image, width, height } };
  }

  async function atRest() {
    const { scene } = store;
    if (what === "" || asked === scene) return;
    asked = scene;
    try {
      const frame = await channel.fetchFrame(other(scene), { quality: 92, lane: "-compared", seen: true });
      if (frame === null || store.scene !== scene || what === "") return;
      const bitmap = await createImageBitmap(frame.blob);
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
      canvas.getContext("2d").drawImage(bitmap, 0, 0);
      bitmap.close();
      canvas.hidden = false;
      place();
    } catch (error) {
      failed(error);
    } finally {
      if (canvas.hidden) asked = null;
    }
  }

  function compare(wanted) {
    if (wanted === "before" && store.before === null) {
      report("There is nothing before: nothing has been changed.");
      wanted = "";
    }
    what = wanted === what ? "" : wanted;
    if (what === "before") before = store.before;
    line.hidden = what === "";
    canvas.hidden = true;
    asked = null;
    update();
    place();
    atRest();
  }

  store.listen(() => {
    if (asked === null || store.scene === asked) return;
    asked = null;
    canvas.hidden = true; // the canvas shows another view until the picture has come to rest
    place();
  });
  const choice = select({
    label: "Compare", choices: [["", "nothing"], ...CHOICES.map((name) => [name, NAMES[name]])], get: () => what,
    set: (name) => {
      if (name === "kept" && kept === null) report("Keep this picture first: “keep” remembers it.");
      else if (name !== what) compare(name);
      update();
    }, title: "Left of the line in the picture",
  });
  // Makes a button for other panels: it compares the picture with the picture before the last
  // change.
  const buttons = [];
  function compareButton() {
    const made = button("compare with before", () => compare("before"), { title: "Beside the picture as it was before the last change; drag the line between them" });
    buttons.push(made);
    update();
    return row("", made);
  }
  const keep = button("keep", () => { kept = store.scene; report("This look and light is kept: change them, then compare."); }, { title: "Remembers the look and the light of this picture, to compare with later" });
  function update() {
    choice.update();
    buttons.forEach((one) => {
      one.setAttribute("aria-pressed", String(what === "before"));
      one.disabled = what !== "before" && store.before === null;
    });
    left.textContent = NAMES[what] ?? "";
    right.textContent = what === "kept" || what === "before" ? "now" : NAMES[store.scene.render.shadows] ?? "";
  }
  update();
  return { elements: [choice.element, row("", keep)], update, atRest, compare, compareButton };
}
