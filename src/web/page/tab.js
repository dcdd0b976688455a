// The page without a server: the viewer over the whole window, of files that are dropped on it or that it holds. They
// do not leave the machine.

import { chosenFiles, droppedFiles } from "./dropped.js";
import { heldFiles, part } from "./parts.js";
import { mount } from "./viewer.js";
import { WorkerChannel } from "./worker_channel.js";

const HELD_SCENE = "scene.json";

const make = (name, properties, ...children) => {
  const element = Object.assign(document.createElement(name), properties);
  element.append(...children);
  return element;
};

const message = make("p", { className: "tab-message", role: "status" });
const choose = make("input", { type: "file", multiple: true, ariaLabel: "Files to open" });
const welcome = make("section", { className: "tab-welcome" },
  make("h1", { textContent: "Halflight" }),
  make("p", { textContent: "Drop a volume here: NIfTI, NRRD, MetaImage, VTI, a folder of DICOM, a zip of OME-Zarr, or a scene with its files." }),
  make("label", { textContent: "or choose files " }, choose),
  make("p", { textContent: "They stay on this machine: the page renders them itself, with soft shadows." }), message);

let channel = null;

async function begin() {
  const [script, ...modules] = await Promise.all(["worker.js", "halflight-relaxed.wasm", "halflight.wasm"].map(part));
  const url = URL.createObjectURL(new Blob([script], { type: "text/javascript" }));
  channel = new WorkerChannel(new Worker(url));
  channel.onProgress = (fraction) => { message.textContent = `reading: ${Math.round(100 * fraction)} %`; };
  await channel.begin(modules);
}

// The channel of what is open now. The viewer's panel of a server's files has no use here.
const viewerChannel = () => ({ completeScene: (scene) => channel.completeScene(scene), fetchFrame: (scene, options) => channel.fetchFrame(scene, options) });

function say(text) {
  if (globalThis.halflight) globalThis.halflight.report(text);
  else message.textContent = text;
}

async function open({ contents, path, title }) {
  say(`opening ${title} …`);
  try {
    await begun;
    const start = await channel.open(contents, path, title);
    globalThis.halflight?.end();
    document.title = `${start.title} · Halflight`;
    globalThis.halflight = mount(document.body, viewerChannel(), start, { keyboard: document });
  } catch (error) {
    say(error.message);
  }
}

addEventListener("dragover", (event) => event.preventDefault());
addEventListener("drop", async (event) => {
  event.preventDefault();
  open(await droppedFiles(event.dataTransfer));
});
choose.addEventListener("change", () => { if (choose.files.length > 0) open(chosenFiles([...choose.files])); });

document.body.replaceChildren(welcome);
const begun = begin();
begun.catch((error) => say(`The page cannot begin: ${error.message}`));
const held = await heldFiles();
if (HELD_SCENE in held) await open({ contents: held, path: HELD_SCENE, title: document.title });
