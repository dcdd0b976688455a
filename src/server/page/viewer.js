// The viewer: the picture, the overlays on it, and the panels beside it, in any element of a page or a
// notebook.

import { worldBox } from "./boxes.js";
import { reshaped } from "./camera.js";
import { make } from "./controls.js";
import { comparison } from "./comparison.js";
import { Current, KINDS } from "./current.js";
import { cutPanel, cutSwitch, sceneCutPanel } from "./cut_panel.js";
import { copier, exportPanel } from "./export.js";
import { filmPanel } from "./film_panel.js";
import { Frames } from "./frames.js";
import { watchConnection } from "./connection.js";
import { smallPictures } from "./gallery.js";
import { followGestures } from "./gestures.js";
import { functionPanel } from "./function_panel.js";
import { labelPanel } from "./label_panel.js";
import { sweptLight } from "./light.js";
import { lightPanel, shadowPanel } from "./light_panel.js";
import { lookPanel } from "./look_panel.js";
import { markPanel } from "./mark_panel.js";
import { meshPanel } from "./mesh_panel.js";
import { openPanel } from "./open_panel.js";
import { Overlay } from "./overlay.js";
import { Pointer } from "./pointer.js";
import { Probe } from "./probe.js";
import { followRefinement, resolutionLine } from "./refinement.js";
import { seriesOf } from "./series.js";
import { atOpenLevels, isOfSameFiles, startOf } from "./session.js";
import { helpSheet, installShortcuts } from "./shortcuts.js";
import { sessionPanel } from "./session_panel.js";
import { skyPanel } from "./sky_panel.js";
import { slicePanel } from "./slice_panel.js";
import { Slices } from "./slices.js";
import { statusLine } from "./status.js";
import { Store } from "./store.js";
import { surfacePanel } from "./surface_panel.js";
import { installTheme } from "./theme.js";
import { length, subtract } from "./vector.js";
import { viewPanel } from "./view_panel.js";
import { volumeChooser, volumePanel } from "./volume_panel.js";

// Each panel is a file. The panels are listed in their order in the side bar, under the names of
// the side bar's four parts.
const PARTS = {
  Look: [volumeChooser, lookPanel, functionPanel, labelPanel, surfacePanel, meshPanel, volumePanel], Light: [lightPanel, shadowPanel, skyPanel],
  Inside: [cutSwitch, cutPanel, sceneCutPanel, slicePanel, markPanel], "Picture and files": [viewPanel, openPanel, exportPanel, sessionPanel, filmPanel],
};

const MARKUP = `
  <div class="viewer">
    <header>
      <h1>Halflight</h1>
      <span id="title"></span>
      <nav aria-label="Tools">
        <button id="undo" type="button" title="Undo (ctrl + z)">Undo</button>
        <button id="redo" type="button" title="Redo (ctrl + shift + z)">Redo</button>
        <button id="open" type="button" title="Another volume or scene, or a session" hidden>Open</button>
        <button id="save" type="button" title="The picture, or the scene">Save</button>
        <button id="slices" type="button" title="Three slices beside the picture (4), or the picture alone (1)">Slices</button>
        <button id="reset" type="button" title="Move the camera back until all of it is seen (r)">Show all</button>
        <button id="show-lights" type="button" title="The lights' handles (l)">Lights</button>
        <button id="probe" type="button" aria-pressed="false" title="Value, opacity and light under the cursor (p)">Probe</button>
        <button id="theme" type="button" title="Dark or light (t)">Theme</button>
        <button id="full" type="button" title="Full screen (f)">Full screen</button>
        <button id="sidebar" type="button" title="The side bar (b)">Panels</button>
        <button id="show-help" type="button" title="Mouse, fingers and keys (?)" aria-label="Help">?</button>
      </nav>
    </header>
    <main>
      <div id="workspace" data-layout="picture">
      <div id="view" tabindex="0" role="application" aria-label="The picture. Arrow keys turn, plus and minus zoom, question mark lists all keys.">
        <canvas id="picture" width="16" height="16"></canvas>
        <svg id="overlay" xmlns="http://www.w3.org/2000/svg"></svg>
        <p id="message" role="status" hidden></p>
      </div>
      </div>
      <footer>
        <span id="stage" data-stage="refining">loading</span>
        <span id="progress"></span>
        <span id="resolution"></span>
        <span id="statistics"></span>
      </footer>
    </main>
    <aside id="panels" aria-label="Settings"></aside>
    <dialog id="help" aria-labelledby="help-title"></dialog>
  </div>`;

const MOST_SIDE = 4096; // the most pixels along a side of the picture
const NEAR = 0.02; // fraction of a volume's diagonal
const MESSAGE_TIME = 5000, WARNING_TIME = 15000; // milliseconds
const SWEEP_TIME = 1800; // milliseconds of the animation of a moving light, shown once when the viewer opens

// Returns a function that shows a line of text over the picture for some milliseconds.
function messageBox(box) {
  let timer = 0;
  return (text, time = MESSAGE_TIME) => {
    box.textContent = text;
    box.hidden = false;
    const top = box.parentElement.getBoundingClientRect().top;
    const lowest = Math.max(0, ...[...box.parentElement.querySelectorAll(".side")].map((name) => name.getBoundingClientRect().bottom - top));
    box.style.setProperty("--names", `${lowest}px`); // a comparison's names may take several lines
    clearTimeout(timer);
    timer = setTimeout(() => { box.hidden = true; }, time);
  };
}

// Makes the picture's size follow the window's size.
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

// Moves the camera so that everything visible fits into the picture. The direction of the camera stays the
// same; the program chooses the distance and the target.
async function frameEverything({ store, channel, failed, waits }) {
  const { camera, ...rest } = store.scene;
  try {
    const complete = await waits(channel.completeScene({ ...rest, camera: { type: camera.type, ...(camera.fovy_deg ? { fovy_deg: camera.fovy_deg } : {}) } }));
    store.setCamera(complete.camera);
  } catch (error) {
    failed(error);
  }
}

// Returns the least distance of the eye from its target: a small fraction of the largest volume's
// diagonal.
const nearestOf = ({ volumes }) => NEAR * Math.max(0, ...volumes.filter(Boolean).map((volume) => length(subtract(worldBox(volume).max, worldBox(volume).min))));

// The functions of keys and buttons that do not move the camera.
function actionsOf(viewer, find, root, update, signal) {
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
    full: () => (document.fullscreenElement ? document.exitFullscreen() : root.requestFullscreen().catch(() => viewer.report("This browser has no full screen here."))),
    cuts: () => viewer.toggleCuts(),
    compare: () => viewer.comparison.compare("off"),
    theme: installTheme(root, () => { update(); overlay.draw(); }, signal),
    help: () => {
      find("help").showModal();
      find("help").scrollTop = 0; // the focus lies on the button at the end
    },
    layout: (layout) => () => { if (viewer.slices.available) store.setPage({ layout }); },
    cancel: () => viewer.marking.cancel(),
    finish: () => viewer.marking.finish(),
  };
}

// Opens a session, or a scene of the open volumes; a scene of other files is opened as a file.
async function openSession(file, restore, viewer) {
  try {
    if ((await restore(file)) === "other") viewer.upload(file);
  } catch (error) {
    viewer.failed(error);
  }
}

// Unfolds and folds the sections of the side bar as they were before a reload or in a session's file. page.sections holds, by
// title, the sections whose state differs from the initial state.
function keepOpenSections(panels, store) {
  const titleOf = (element) => element.firstElementChild.textContent, all = [...panels.querySelectorAll(".section")].map((element) => ({ element, first: element.open }));
  let shown; // the value of page.sections that the side bar shows
  const show = () => {
    shown = store.page.sections;
    for (const { element, first } of all) element.open = shown?.[titleOf(element)] ?? first;
  };
  show();
  const keep = () => {
    const { sections = {} } = store.page, now = Object.fromEntries(all.filter(({ element, first }) => element.open !== first).map(({ element }) => [titleOf(element), element.open]));
    if (Object.keys({ ...sections, ...now }).some((title) => now[title] !== sections[title])) store.setPage({ sections: shown = now });
  };
  store.listen((_, name) => { if (name === "history" && store.page.sections !== shown) show(); });
  panels.addEventListener("toggle", keep, { capture: true }); // the event does not rise to the side bar
}

// Unfolds a section of the side bar, and moves the keyboard's focus there.
function revealIn(root) {
  return (title) => {
    const element = [...root.querySelectorAll(".section")].find((one) => one.firstElementChild.textContent === title);
    root.classList.remove("bare");
    element.open = true;
    element.scrollIntoView({ block: "nearest" });
    element.querySelector(".section-body :is(button, input, select):not([hidden])")?.focus();
  };
}

// If undo or redo reaches a scene with fewer or more of the open files, a new viewer replaces this viewer.
function followFiles(store, whole, source, reopen) {
  let before = store.scene;
  store.listen((scene, name) => {
    const same = name !== "history" || isOfSameFiles(scene, before);
    before = scene;
    if (!same) reopen(whole, source, { scene, marks: store.marks, page: store.page, history: store.history, own: store.source, title: store.title });
  });
}

// Fills an empty element with a viewer. channel: the way to ask for pictures (http_channel.js). whole: the open scene (start.json); kept.scene may contain only
// the first of its files. keyboard: the element or document whose keys are used. reopen(start, source, kept): called when a person opens another file. source:
// the path by which the present file was opened. kept: a session (session.js) to go on with. restore(file): opens a session or a scene. startAfresh(): forgets
// all changes. choose(files): opens files of a chooser, or adds them where adds() says so; null: there is no chooser. address: the part of a link before its
// end. Returns { store, start, frames, overlay, probe, slices, marking, report, adds, end }; end() stops all of it.
export function mount(element, channel, whole, { keyboard = element, reopen = () => {}, source = null, kept = null, restore = null, startAfresh = () => {}, choose = null, address = "" } = {}) {
  if (kept !== null) kept = { ...kept, scene: atOpenLevels(kept.scene, whole) };
  element.innerHTML = MARKUP;
  const root = element.firstElementChild, find = (id) => root.querySelector(`#${id}`);
  const ended = new AbortController();
  const start = startOf(kept?.scene ?? whole.scene, whole);
  const store = new Store(kept?.scene ?? start.scene, { ...kept, page: { ...(whole.unit ? { unit: whole.unit } : {}), ...kept?.page }, source: kept?.own ?? source, title: kept?.title ?? whole.title }), report = messageBox(find("message"));
  const viewer = { store, start, channel, smallPicture: smallPictures(channel, store), report, reopen, root, find, source, startAfresh, choose, copy: copier(report, store), current: new Current(store), address, atRest: [], frames: () => frames, waits: (promise) => status.wait(promise) };
  const connection = watchConnection(root.querySelector("main"), channel, report, { onBack: () => { frames.move(); viewer.slices.update(); }, save: () => viewer.saveSession() });
  viewer.failed = connection.failed;
  if (restore !== null) viewer.openSession = (file) => openSession(file, restore, viewer);
  followGestures(root, store, ended.signal);
  viewer.overlay = new Overlay(find("overlay"), viewer);
  viewer.slices = new Slices(viewer, find("workspace"), find("view"));
  viewer.comparison = comparison(viewer);
  viewer.atRest.push(viewer.comparison.atRest);
  viewer.firstView = () => store.setCamera(reshaped(start.scene.camera, start.scene.image, store.scene.image));
  viewer.frameEverything = () => frameEverything(viewer);
  const parts = Object.entries(PARTS).map(([name, files]) => [name, files.map((panel) => panel(viewer))]), panels = parts.flatMap(([, made]) => made);
  find("panels").append(...parts.map(([name, made]) => make("section", { class: "part", "aria-label": name }, make("h2", {}, name), ...made.map((panel) => panel.element))));
  const followHistory = () => {
    find("undo").disabled = !store.canUndo;
    find("redo").disabled = !store.canRedo;
  };
  const followLayout = () => {
    find("slices").hidden = !viewer.slices.available;
    find("slices").setAttribute("aria-pressed", String(viewer.slices.layout !== "picture"));
  };
  const update = () => {
    panels.forEach((panel) => panel.update());
    find("title").textContent = find("title").title = store.title; // where there is no room for all of it, the cursor shows it
    followHistory();
  };
  // The overlays follow the camera and the layout at every change, because this takes little time.
  let shown = viewer.current.volume, page = store.page; // the volume and the page's state for which the panels were made
  store.listen((_, name) => {
    const isOther = KINDS.some((kind) => store.page[kind] !== page[kind]);
    page = store.page;
    if (viewer.current.volume !== shown) {
      shown = viewer.current.volume;
      panels.forEach((panel) => panel.rebuild?.());
    }
    if (isOther || (name !== "camera" && name !== "page")) update();
    else panels.forEach((panel) => panel.updateView?.());
    followHistory(); // changes of the page's state may be steps of the history, too
    followLayout();
  });
  viewer.probe = new Probe(viewer, find("view"));
  viewer.slices.update();
  followLayout();
  followSize(store, find("view"), ended.signal); // the size is measured after all elements have their places
  const status = statusLine(find, channel), resolution = resolutionLine(find("resolution"), { warn: (line) => report(line, WARNING_TIME), failed: viewer.failed });
  const frames = new Frames(viewer, find("picture"), (frame) => {
    // A picture is not final while finer voxels are still to be read.
    status.show(frame.stage === "final" && whole.refining ? { ...frame, stage: "coarse" } : frame);
    if (frame.error) viewer.failed(frame.error);
    resolution.seen(frame);
    if (frame.stage === "final") {
      store.showsLevels(frame.scene, (frame.seen?.volumes ?? []).map(({ level }) => level));
      viewer.probe.rest();
      viewer.atRest.forEach((rest) => rest());
    }
  });
  new Pointer(find("view"), store, nearestOf(start));
  const reveal = revealIn(root), actions = actionsOf(viewer, find, root, update, ended.signal);
  helpSheet(find("help"), installShortcuts(store, { target: keyboard, signal: ended.signal }, find("view"), actions, nearestOf(start)));
  const buttons = { undo: () => store.undo(), redo: () => store.redo(), "show-help": actions.help, theme: actions.theme, "show-lights": actions.lights, slices: () => actions.layout(viewer.slices.layout === "picture" ? "four" : "picture")(), reset: actions.reset, probe: actions.probe, sidebar: actions.sidebar, full: actions.full, open: () => reveal("Open"), save: () => reveal("Save") };
  for (const [id, action] of Object.entries(buttons)) find(id).addEventListener("click", action);
  keepOpenSections(find("panels"), store);
  find("open").hidden = !channel.open && choose === null;
  viewer.overlay.showsLights = true;
  followFiles(store, whole, source, reopen);
  update();
  const endRefinement = followRefinement(whole, channel, {
    tell: resolution.of, warn: (line) => report(line, WARNING_TIME), failed: viewer.failed,
    renew: () => {
      frames.refine(start);
      viewer.slices.refine();
      panels.forEach((panel) => panel.rebuild?.());
    },
  });
  const series = start.volumes.map((volume) => volume && seriesOf(volume)).filter(Boolean).join("; ");
  const first = series !== "" ? `${series}. The panel “Volume” tells them.` : (whole.note ?? "").replace(/^\.(?=[:/])/, whole.title); // the note names an opened folder by "."
  if (kept === null && first !== "") report(first, WARNING_TIME);
  if (kept === null && !matchMedia("(prefers-reduced-motion: reduce)").matches) frames.animate(sweptLight, SWEEP_TIME);
  else frames.move();
  return { store, start: whole, frames, overlay: viewer.overlay, probe: viewer.probe, slices: viewer.slices, marking: viewer.marking, report, adds: viewer.adds, upload: viewer.upload, followLink: viewer.followLink, end: () => { ended.abort(); frames.end(); status.end(); connection.end(); endRefinement(); } };
}
