// The viewer: the picture, what lies over it, and the panels beside it, in any element of a page or a notebook.

import { reshaped } from "./camera.js";
import { cutPanel, sceneCutPanel } from "./cut_panel.js";
import { copier, exportPanel } from "./export.js";
import { filmPanel } from "./film_panel.js";
import { Frames } from "./frames.js";
import { functionPanel } from "./function_panel.js";
import { labelPanel } from "./label_panel.js";
import { lightPanel, shadowPanel } from "./light_panel.js";
import { openPanel } from "./open_panel.js";
import { Overlay } from "./overlay.js";
import { Pointer } from "./pointer.js";
import { Probe } from "./probe.js";
import { helpSheet, installShortcuts } from "./shortcuts.js";
import { skyPanel } from "./sky_panel.js";
import { Store } from "./store.js";
import { surfacePanel } from "./surface_panel.js";
import { installTheme } from "./theme.js";
import { viewPanel } from "./view_panel.js";
import { volumeChooser, volumePanel } from "./volume_panel.js";

// One file each; in the order of the side bar.
const PANELS = [volumeChooser, functionPanel, labelPanel, surfacePanel, lightPanel, shadowPanel, skyPanel, volumePanel, cutPanel, sceneCutPanel, viewPanel, exportPanel, filmPanel, openPanel];

const MARKUP = `
  <div class="viewer">
    <header>
      <h1>Halflight</h1>
      <span id="title"></span>
      <nav aria-label="Tools">
        <button id="undo" type="button" title="Undo (ctrl + z)">Undo</button>
        <button id="redo" type="button" title="Redo (ctrl + shift + z)">Redo</button>
        <button id="reset" type="button" title="Frame everything (r)">Frame</button>
        <button id="show-lights" type="button" title="The lights' handles (l)">Lights</button>
        <button id="probe" type="button" aria-pressed="false" title="Value, opacity and light under the cursor (p)">Probe</button>
        <button id="theme" type="button" title="Dark or light (t)">Theme</button>
        <button id="sidebar" type="button" title="The side bar (b)">Panels</button>
        <button id="show-help" type="button" title="Mouse, fingers and keys (?)" aria-label="Help">?</button>
      </nav>
    </header>
    <main>
      <div id="view" tabindex="0" role="application" aria-label="The picture. Arrow keys turn, plus and minus zoom, question mark lists all keys.">
        <canvas id="picture" width="16" height="16"></canvas>
        <svg id="overlay" xmlns="http://www.w3.org/2000/svg"></svg>
        <p id="message" role="status" hidden></p>
      </div>
      <footer>
        <span id="stage" data-stage="refining">loading</span>
        <span id="statistics"></span>
      </footer>
    </main>
    <aside id="panels" aria-label="Settings"></aside>
    <dialog id="help" aria-labelledby="help-title"></dialog>
  </div>`;

const MOST_SIDE = 4096; // pixels of the picture
const MESSAGE_TIME = 5000, GREETING_TIME = 60000; // milliseconds

// Returns the function that shows a line over the picture for a while, in milliseconds.
function messageBox(box) {
  let timer = 0;
  return (text, time = MESSAGE_TIME) => {
    box.textContent = text;
    box.hidden = false;
    clearTimeout(timer);
    timer = setTimeout(() => { box.hidden = true; }, time);
  };
}

const STAGES = { moving: "moving", settled: "refining", refining: "refining", final: "final" };

// What the line at the bottom says of a frame.
function showFrame(find, report, frame) {
  const stage = find("stage");
  if (frame.error) {
    stage.textContent = "failed";
    stage.dataset.stage = "failed";
    report(frame.error.message === "Failed to fetch" ? "The viewer has ended: start it again." : frame.error.message);
    return;
  }
  stage.textContent = STAGES[frame.stage];
  stage.dataset.stage = STAGES[frame.stage];
  if (frame.bytes === 0) return;
  const seconds = frame.milliseconds < 1000 ? `${Math.round(frame.milliseconds)} ms` : `${(frame.milliseconds / 1000).toFixed(1)} s`;
  find("statistics").textContent = `${frame.width} × ${frame.height} · sheets ${+frame.spacing.toPrecision(2)} voxels · ${seconds} · ${Math.ceil(frame.bytes / 1024)} KiB`;
}

// The picture's size follows the window's.
function followSize(store, area, signal) {
  const measure = () => {
    const density = Math.min(devicePixelRatio || 1, 2);
    const [width, height] = [area.clientWidth, area.clientHeight].map((side) => Math.min(Math.max(Math.round(side * density), 16), MOST_SIDE));
    const { image } = store.scene;
    if (image.width !== width || image.height !== height)
      store.change("size", (scene) => ({
        ...scene, camera: reshaped(scene.camera, image, { width, height }), image: { ...scene.image, width, height },
      }));
  };
  const observer = new ResizeObserver(measure);
  observer.observe(area);
  signal.addEventListener("abort", () => observer.disconnect());
  measure();
}

// What is seen fits again, from the same side: only the distance and the target are the program's choice.
async function frameEverything({ store, channel, report }) {
  const { camera, ...rest } = store.scene;
  try {
    const complete = await channel.completeScene({ ...rest, camera: { type: camera.type, ...(camera.fovy_deg ? { fovy_deg: camera.fovy_deg } : {}) } });
    store.setCamera(complete.camera);
  } catch (error) {
    report(error.message);
  }
}

// What keys and buttons do besides moving the camera.
function actionsOf(viewer, find, root, update) {
  const { store, overlay } = viewer;
  return {
    reset: viewer.frameEverything,
    home: viewer.firstView,
    lights: () => { overlay.showsLights = !overlay.showsLights; update(); },
    shadows: () => {
      const kinds = ["off", "hard", "soft"];
      store.changeRender("shadows", kinds[(kinds.indexOf(store.scene.render.shadows) + 1) % 3]);
    },
    probe: () => {
      viewer.probe.on = !viewer.probe.on;
      find("probe").setAttribute("aria-pressed", String(viewer.probe.on));
    },
    statistics: () => { find("statistics").hidden = !find("statistics").hidden; },
    sidebar: () => { root.classList.toggle("bare"); },
    theme: installTheme(root, () => { update(); overlay.draw(); }),
    help: () => find("help").showModal(),
  };
}

// Fills an empty element with a viewer. channel: how pictures are asked for (http_channel.js); start: what is open;
// keyboard: where its keys are listened to; reopen(start): called where a person opens another file. Returns { store,
// frames, overlay, probe, end }; end() stops all of it.
export function mount(element, channel, start, { keyboard = element, reopen = () => {} } = {}) {
  element.innerHTML = MARKUP;
  const root = element.firstElementChild, find = (id) => root.querySelector(`#${id}`);
  const ended = new AbortController();
  const store = new Store(start.scene), report = messageBox(find("message"));
  const viewer = { store, start, channel, report, reopen, root, find, copy: copier(report, start.title), current: { volume: 0, light: 0 } };
  find("title").textContent = start.title;
  followSize(store, find("view"), ended.signal);
  viewer.overlay = new Overlay(find("overlay"), viewer);
  viewer.firstView = () => store.setCamera(reshaped(start.scene.camera, start.scene.image, store.scene.image));
  viewer.frameEverything = () => frameEverything(viewer);
  viewer.chooseVolume = (index) => {
    viewer.current.volume = index;
    panels.forEach((panel) => panel.rebuild?.());
  };
  const panels = PANELS.map((panel) => panel(viewer));
  find("panels").append(...panels.map((panel) => panel.element));
  const update = () => {
    panels.forEach((panel) => panel.update());
    find("undo").disabled = !store.canUndo;
    find("redo").disabled = !store.canRedo;
  };
  store.listen((_, name) => { if (name !== "camera") update(); });
  viewer.probe = new Probe(viewer, find("view"));
  const frames = new Frames(viewer, find("picture"), (frame) => {
    showFrame(find, report, frame);
    if (frame.stage === "final") viewer.probe.rest();
  });
  new Pointer(find("view"), store);
  const actions = actionsOf(viewer, find, root, update);
  helpSheet(find("help"), installShortcuts(store, { target: keyboard, signal: ended.signal }, find("view"), actions));
  const buttons = { undo: () => store.undo(), redo: () => store.redo(), "show-help": actions.help, theme: actions.theme, "show-lights": actions.lights, reset: actions.reset, probe: actions.probe, sidebar: actions.sidebar };
  for (const [id, action] of Object.entries(buttons)) find(id).addEventListener("click", action);
  viewer.overlay.showsLights = true;
  update();
  frames.move();
  report("Drag to turn. Drag the ringed dot to move the light, its ring to soften shadows. ? lists the rest.", GREETING_TIME);
  store.listen((_, name) => { if (name !== "size" && find("message").textContent.startsWith("Drag")) find("message").hidden = true; });
  return { store, frames, overlay: viewer.overlay, probe: viewer.probe, end: () => { ended.abort(); frames.end(); } };
}
