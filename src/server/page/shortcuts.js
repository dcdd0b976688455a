// Keyboard shortcuts, and the help sheet that lists the shortcuts and the uses of the mouse.

import { lookAlong, roll, turn, zoom } from "./camera.js";
import { make } from "./controls.js";

const STEP = Math.PI / 36;

const MOUSE = [
  ["left drag", "turn"], ["ctrl + left drag", "roll"], ["shift + left, or middle drag", "pan"],
  ["wheel, or right drag", "zoom"], ["click, with slices or a tool", "crosshair or point to what is seen"], ["one finger", "turn"], ["two fingers", "pan, zoom and roll"],
];

const TEXTS = "textarea, input:is([type=text], [type=number], [type=search])";
const TYPING = `${TEXTS}, select, dialog`;
// Controls that handle some keys (OF_CONTROLS) themselves and leave all other keys to the viewer.
const MOVED = "input, [role=slider], canvas.function, [role=radiogroup]";
const OF_CONTROLS = /^(Arrow.*|Page.*|Home|End|Insert|Delete|Backspace|Enter|Tab| |[+-])$/;

// keyboard: { target, signal }, the element or document whose keys are used, until `signal` is aborted.
// area: the picture's element. actions: functions, by name, for keys that do not move the camera. nearest:
// the least distance of the eye from its target.
export function installShortcuts(store, keyboard, area, actions, nearest) {
  const move = (change) => () => store.setCamera(change(store.scene.camera));
  const keys = [
    ["ArrowLeft", "←", "turn left", move((c) => turn(c, -STEP, 0))],
    ["ArrowRight", "→", "turn right", move((c) => turn(c, STEP, 0))],
    ["ArrowUp", "↑", "turn up", move((c) => turn(c, 0, STEP))],
    ["ArrowDown", "↓", "turn down", move((c) => turn(c, 0, -STEP))],
    ["+", "+", "zoom in", move((c) => zoom(c, 1.1, [0, 0], nearest))],
    ["-", "−", "zoom out", move((c) => zoom(c, 1 / 1.1, [0, 0], nearest))],
    ["[", "[", "roll left", move((c) => roll(c, STEP))],
    ["]", "]", "roll right", move((c) => roll(c, -STEP))],
    ["x", "x", "look along x (X: from the other end)", move((c) => lookAlong(c, 0, 1))],
    ["X", "", "", move((c) => lookAlong(c, 0, -1))],
    ["y", "y", "look along y (Y: from the other end)", move((c) => lookAlong(c, 1, 1))],
    ["Y", "", "", move((c) => lookAlong(c, 1, -1))],
    ["z", "z", "look along z (Z: from the other end)", move((c) => lookAlong(c, 2, 1))],
    ["Z", "", "", move((c) => lookAlong(c, 2, -1))],
    ["r", "r", "show all", actions.reset],
    ["Home", "Home", "the first view", actions.home],
    ["l", "l", "show the lights' handles", actions.lights],
    ["s", "s", "next kind of shadows: off, hard, soft", actions.shadows],
    ["k", "k", "all cuts on or off", actions.cuts],
    ["a", "a", "beside the picture without shadows", actions.compare],
    ["c", "c", "the view before (C: after)", () => store.undoCamera()],
    ["C", "", "", () => store.redoCamera()],
    ["1", "1", "the picture alone", actions.layout("picture")],
    ["2", "2", "a slice beside the picture", actions.layout("beside")],
    ["4", "4", "three slices and the picture", actions.layout("four")],
    ["u", "u", "undo (ctrl + z)", () => store.undo()],
    ["U", "U", "redo (ctrl + shift + z)", () => store.redo()],
    ["p", "p", "probe: value, opacity and light under the cursor", actions.probe],
    ["i", "i", "times and sizes of frames", actions.statistics],
    ["b", "b", "show or hide the side bar", actions.sidebar],
    ["f", "f", "full screen", actions.full],
    ["t", "t", "dark or light", actions.theme],
    ["Escape", "Esc", "ends a tool of measuring", actions.cancel],
    ["Enter", "Enter", "ends a line that is being measured", actions.finish],
    ["?", "?", "this sheet", actions.help],
  ];
  const byKey = new Map(keys.map(([key, , , action]) => [key, action]));
  keyboard.target.addEventListener("keydown", (event) => {
    const typing = event.target.closest?.(TYPING);
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === "z") {
      if (typing?.matches(TEXTS)) return; // the field has an undo of its own
      if (event.shiftKey) store.redo();
      else store.undo();
      event.preventDefault();
      return;
    }
    const taken = typing || (event.target.closest?.(MOVED) && OF_CONTROLS.test(event.key)) || (event.key === "Enter" && event.target.closest?.("button, summary, a"));
    if (taken || event.ctrlKey || event.metaKey || event.altKey || event.defaultPrevented) return;
    const arrows = event.key.startsWith("Arrow") && event.target !== area && event.target !== document.body;
    const action = arrows ? undefined : byKey.get(event.key);
    if (!action) return;
    action();
    event.preventDefault();
  }, { signal: keyboard.signal });
  return keys.filter(([, shown]) => shown !== "").map(([, shown, text]) => [shown, text]);
}

export function helpSheet(dialog, keys) {
  const all = [...MOUSE, ...keys], half = Math.ceil(all.length / 2);
  const table = (list) => make("table", {}, make("tbody", {}, ...list.map(([key, text]) => make("tr", {}, make("th", { scope: "row" }, make("kbd", {}, key)), make("td", {}, text)))));
  dialog.append(
    make("h2", { id: "help-title" }, "Mouse, fingers and keys"),
    make("div", { class: "sheet" }, table(all.slice(0, half)), table(all.slice(half))),
    make("p", {}, "While a light's handle has the focus, arrow keys move the light, and + and − change its size. In the drawing of the " +
      "transfer function they move the chosen point; Page Up and Page Down choose another."),
    make("form", { method: "dialog" }, make("button", { class: "primary", autofocus: true }, "Close")));
}
