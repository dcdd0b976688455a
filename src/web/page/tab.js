// Runs the page without a server: the viewer fills the whole window, and shows files that are dropped on the page or
// that the page contains. The files do not leave the machine.

import { chosenFiles, droppedFiles } from "./dropped.js";
import { heldFiles, isFolder, part } from "./parts.js";
import { followTitle, isOfOpen, keepSession, keptSession, restoreFrom } from "./session.js";
import { mount } from "./viewer.js";
import { WorkerChannel } from "./worker_channel.js";

const HELD_SCENE = "scene.json";
// A WebAssembly module of one function, which takes three vectors of zeros, and rounds their product and sum once
// (f32x4.relaxed_madd).
const RELAXED_SIMD = Uint8Array.of(0, 0x61, 0x73, 0x6d, 1, 0, 0, 0, 1, 4, 1, 0x60, 0, 0, 3, 2, 1, 0, 0x0a, 0x14, 1, 0x12, 0,
  0x41, 0, 0xfd, 0x0f, 0x41, 0, 0xfd, 0x0f, 0x41, 0, 0xfd, 0x0f, 0xfd, 0x85, 2, 0x1a, 0x0b);

const make = (name, properties, ...children) => {
  const element = Object.assign(document.createElement(name), properties);
  element.append(...children);
  return element;
};

const message = make("p", { className: "tab-message", role: "status" });
const choose = make("input", { type: "file", multiple: true, ariaLabel: "Files to open" });
const welcome = make("section", { className: "tab-welcome" },
  make("h1", { textContent: "Halflight" }),
  make("p", { textContent: "Drop a volume here: NIfTI, NRRD, MetaImage, VTI, a folder of DICOM, a zip of OME-Zarr, a mesh, or a scene with its files." }),
  make("label", { textContent: "or choose files " }, choose),
  make("p", { textContent: "They stay on this machine: the page renders them itself, with soft shadows." }), message);

let channel = null;

// Returns the names of the library's files that this browser may take, beginning with the fastest. The page asks its
// server for the next file only if one does not suit the machine.
function modulesFor() {
  // Workers can share memory only if the server of the page isolates the page. A page in a single file always uses one
  // thread.
  const threads = globalThis.crossOriginIsolated && isFolder() ? ["halflight-threads.wasm"] : [];
  return [...(WebAssembly.validate(RELAXED_SIMD) ? [...threads, "halflight-relaxed.wasm"] : []), "halflight.wasm"];
}

async function begin() {
  const [first, ...others] = modulesFor(), [script, fastest] = await Promise.all(["worker.js", first].map(part));
  const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  channel = new WorkerChannel(url);
  channel.onProgress = (fraction) => { message.textContent = `reading: ${Math.round(100 * fraction)} %`; };
  if (await channel.begin(fastest)) return;
  for (const name of others) if (await channel.begin(await part(name))) return;
  throw new Error("this browser has no WebAssembly with SIMD: use a newer one");
}

// Makes the channel to the open scene. The viewer's panel with the files of a server has no use here.
const viewerChannel = () => ({
  soonPrepared: channel.soonPrepared,
  ...Object.fromEntries(["completeScene", "fetchFrame", "slice", "depth"].map((name) => [name, (...values) => channel[name](...values)])),
});

function say(text) {
  if (globalThis.halflight) globalThis.halflight.report(text);
  else {
    message.textContent = text;
    if (!message.isConnected) document.body.replaceChildren(welcome); // a viewer that could not be made
  }
}

let kept = keptSession(), keeping = null; // kept: the session of this tab before the page was loaded again

// Shows the open scene. session: the session that continues, or null.
function show(start, session = null) {
  const focused = document.activeElement?.id;
  globalThis.halflight?.end();
  keeping?.abort();
  keeping = new AbortController();
  globalThis.halflight = mount(document.body, viewerChannel(), start, { keyboard: document, kept: session, address: location.href.split("#")[0], restore: openSession, startAfresh: () => show(start), reopen: (whole, _, state) => show(whole, state), choose: (files) => take(chosenFiles(files)) });
  followTitle(globalThis.halflight.store);
  keepSession(globalThis.halflight.store, start, null, keeping.signal);
  if (focused) document.getElementById(focused)?.focus();
}

// Returns the session of this tab before the page was loaded again, if all of its files are open again; otherwise null.
function keptOf(start) {
  if (kept === null || kept.whole !== start.title || !isOfOpen(kept.scene, start)) return null;
  const session = kept;
  kept = null;
  return session;
}

async function open({ contents, path, title }) {
  say(`opening ${title} …`);
  try {
    await begun;
    const start = await channel.open(contents, path, title);
    show(start, keptOf(start));
  } catch (error) {
    say(error.message);
  }
}

// Adds files to the open scene.
async function add({ contents, path, title }) {
  const { store } = globalThis.halflight;
  say(`opening ${title} …`);
  try {
    const both = await channel.join(store.scene, contents, path, `${store.title} + ${title}`);
    show(both, keptOf(both) ?? { scene: both.scene, marks: store.marks, page: store.page, history: store.historyBefore });
  } catch (error) {
    say(error.message);
  }
}

// Opens a file with a session or a scene. If it belongs to the open files, it is restored, and otherwise opened as a
// new file.
async function openSession(file) {
  if ((await restoreFrom(file, globalThis.halflight, channel)) === "other") await open(chosenFiles([file]));
}

async function take(files) {
  const contents = Object.values(files.contents);
  if (globalThis.halflight?.adds()) return add(files);
  if (globalThis.halflight === undefined || contents.length !== 1 || !files.path.endsWith(".json")) return open(files);
  return openSession(contents[0]).catch((error) => say(error.message));
}

addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", async (event) => {
  event.preventDefault();
  try {
    const dropped = droppedFiles(event.dataTransfer);
    say("listing what was dropped …");
    await take(await dropped);
  } catch (error) {
    say(error.message);
  }
});
choose.addEventListener("change", () => { if (choose.files.length > 0) open(chosenFiles([...choose.files])); });

document.body.replaceChildren(welcome);
const begun = begin();
begun.catch((error) => say(`The page cannot begin: ${error.message}`));
const held = await heldFiles();
if (HELD_SCENE in held) await open({ contents: held, path: HELD_SCENE, title: document.title });
else if (kept !== null) say(`Drop ${kept.whole} again to go on with what you did.`);
