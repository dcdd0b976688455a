// The page: what the server has open, the picture, and the panels beside it.

import { completeScene, fetchStart } from "./api.js";
import { exportPanel } from "./export.js";
import { Frames } from "./frames.js";
import { functionPanel } from "./function_panel.js";
import { lightPanel, shadowPanel } from "./light_panel.js";
import { Overlay } from "./overlay.js";
import { Pointer } from "./pointer.js";
import { helpSheet, installShortcuts } from "./shortcuts.js";
import { Store } from "./store.js";
import { installTheme } from "./theme.js";
import { viewPanel } from "./view_panel.js";
import { volumePanel } from "./volume_panel.js";

const MOST_SIDE = 4096; // pixels of the picture
const MESSAGE_TIME = 5000; // milliseconds

const find = (id) => document.getElementById(id);

function message(text) {
  const box = find("message");
  box.textContent = text;
  box.hidden = false;
  clearTimeout(message.timer);
  message.timer = setTimeout(() => { box.hidden = true; }, MESSAGE_TIME);
}

const STAGES = { moving: "moving", settled: "refining", refining: "refining", final: "final" };

// What the line at the bottom says of a frame.
function showFrame(frame) {
  const stage = find("stage");
  if (frame.error) {
    stage.textContent = "failed";
    stage.dataset.stage = "failed";
    message(frame.error.message === "Failed to fetch" ? "The viewer has ended: start it again." : frame.error.message);
    return;
  }
  stage.textContent = STAGES[frame.stage];
  stage.dataset.stage = STAGES[frame.stage];
  if (frame.bytes === 0) return;
  const seconds = frame.milliseconds < 1000 ? `${Math.round(frame.milliseconds)} ms` : `${(frame.milliseconds / 1000).toFixed(1)} s`;
  find("statistics").textContent = `${frame.width} × ${frame.height} · sheets ${+frame.spacing.toPrecision(2)} voxels · ${seconds} · ${Math.ceil(frame.bytes / 1024)} KiB`;
}

// The picture's size follows the window's.
function followSize(store) {
  const area = find("view");
  const measure = () => {
    const density = Math.min(devicePixelRatio || 1, 2);
    const [width, height] = [area.clientWidth, area.clientHeight].map((side) => Math.min(Math.max(Math.round(side * density), 16), MOST_SIDE));
    const { image } = store.scene;
    if (image.width !== width || image.height !== height)
      store.change("size", (scene) => ({ ...scene, image: { ...scene.image, width, height } }));
  };
  new ResizeObserver(measure).observe(area);
  measure();
}

// What is seen fits again, from the same side: only the distance and the target are the program's choice.
async function frameEverything(store) {
  const { camera, ...rest } = store.scene;
  try {
    const complete = await completeScene({ ...rest, camera: { type: camera.type, ...(camera.fovy_deg ? { fovy_deg: camera.fovy_deg } : {}) } });
    store.setCamera(complete.camera);
  } catch (error) {
    message(error.message);
  }
}

function begin(start) {
  const store = new Store(start.scene), current = { volume: 0, light: 0 };
  document.title = `${start.title} · Halflight`;
  find("title").textContent = start.title;
  followSize(store);
  const overlay = new Overlay(find("overlay"), store, start);
  const chooseVolume = (index) => {
    current.volume = index;
    panels.forEach((panel) => panel.rebuild?.());
  };
  const panels = [
    functionPanel(store, start, current, message), lightPanel(store, current, overlay), shadowPanel(store),
    volumePanel(store, start, current, chooseVolume), viewPanel(store, () => frameEverything(store)),
    exportPanel(store, start, message),
  ];
  const box = panels[3].element;
  box.addEventListener("toggle", () => { overlay.showsBox = box.open; });
  find("panels").append(...panels.map((panel) => panel.element));
  const updatePanels = () => {
    panels.forEach((panel) => panel.update());
    find("undo").disabled = !store.canUndo;
    find("redo").disabled = !store.canRedo;
  };
  store.listen((_, name) => { if (name !== "camera") updatePanels(); });
  const frames = new Frames(store, start, find("picture"), showFrame);
  new Pointer(find("view"), store);

  const help = find("help");
  const changeTheme = installTheme(() => { updatePanels(); overlay.draw(); });
  const actions = {
    reset: () => frameEverything(store),
    lights: () => { overlay.showsLights = !overlay.showsLights; updatePanels(); },
    shadows: () => {
      const kinds = ["off", "hard", "soft"];
      store.changeRender("shadows", kinds[(kinds.indexOf(store.scene.render.shadows) + 1) % 3]);
    },
    statistics: () => { find("statistics").hidden = !find("statistics").hidden; },
    sidebar: () => { document.body.classList.toggle("bare"); },
    theme: changeTheme,
    help: () => help.showModal(),
  };
  helpSheet(help, installShortcuts(store, find("view"), actions));
  const buttons = { undo: () => store.undo(), redo: () => store.redo(), "show-help": actions.help, theme: changeTheme, "show-lights": actions.lights, reset: actions.reset, sidebar: actions.sidebar };
  for (const [id, action] of Object.entries(buttons)) find(id).addEventListener("click", action);
  overlay.showsLights = true;
  updatePanels();
  frames.move();
  globalThis.halflight = { store, frames, overlay }; // for the browser's console, and for tests
}

try {
  begin(await fetchStart());
} catch (error) {
  message(`The page cannot begin: ${error.message}`);
  throw error;
}
