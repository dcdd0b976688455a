// The panel that opens another file. The panel lists the folder in which the viewer was started; a page without a
// server has a file chooser in place of the list. Files can also be dropped anywhere on the viewer. The panel is
// hidden where no files can be opened, as in notebooks.

import { button, make, section, toggle } from "./controls.js";

const ASK_EVERY = 250; // milliseconds between questions for the progress of reading a file

const size = (bytes) => (bytes < 1 << 20 ? `${Math.ceil(bytes / 1024)} KiB` : `${Math.round(bytes / (1 << 20))} MiB`);

// Returns the source with which the page opens the present files and the added file after a reload. Null:
// one of these files was dropped, so that the page cannot open it again.
function sourceOfBoth({ store, start }, added) {
  const own = store.source ?? (start.opened === 0 ? "" : null);
  return own === null || added === null ? null : [own, added].flat();
}

export function openPanel(viewer) {
  const { store, start, channel, report, failed, reopen, root } = viewer;
  const { element, body } = section("Open", false);
  element.hidden = !channel.open && !viewer.choose;
  const list = make("ul", { class: "files", "aria-label": "Files and folders" }), bar = make("progress", { max: 1, hidden: true, "aria-label": "Reading the file" });
  const where = make("p", { class: "facts" });
  let adds = false;
  const add = toggle({ label: "Add to what is open", get: () => adds, set: (on) => { adds = on; } });
  const chooser = make("input", { type: "file", multiple: true, hidden: true, "aria-label": "Files to open", onchange: () => {
    if (chooser.files.length > 0) viewer.choose([...chooser.files]);
  } });
  const choose = button("choose files …", () => chooser.click(), { hidden: !viewer.choose });
  if (viewer.choose) where.textContent = "or drop files anywhere on the page";

  // Returns the folder of the open file, as a path below the viewer's folder; "": the file lies in
  // the viewer's folder.
  function folderOf(source) {
    const path = [source].flat().at(-1);
    return typeof path === "string" && path.includes("/") ? path.slice(0, path.lastIndexOf("/")) : "";
  }

  async function show(at) {
    try {
      const folder = await channel.folder(at), up = at.includes("/") ? at.slice(0, at.lastIndexOf("/")) : "";
      const inside = (name) => (at ? `${at}/${name}` : name);
      where.textContent = at ? `in ${at}` : "Files in the folder that the viewer was started in. You can also drop a file anywhere.";
      const opener = (path, name, text, more) => button(text, () => openListed(path, name), { class: "file", ...more });
      list.replaceChildren(
        ...(at ? [make("li", {}, button("‹ back", () => show(up)), opener(at, at, "open as one volume", { title: "DICOM, slices or Zarr" }))] : []),
        ...folder.entries.map((entry) => make("li", {}, entry.folder && !entry.name.endsWith(".zarr")
          ? button(`${entry.name} ›`, () => show(inside(entry.name)), { class: "file" })
          : opener(inside(entry.name), entry.name, entry.name, entry.folder ? {} : { title: size(entry.bytes) }))));
      if (folder.entries.length === 0) list.append(make("li", {}, at ? "No file here has an ending that tells what it is. As one volume the folder may hold DICOM." : "nothing here that can be opened"));
    } catch (error) {
      report(error.message);
    }
  }

  // Reads a file while the bar shows the progress; then the viewer shows the file. path: the file's path
  // in the viewer's folder; null: the file was dropped. Resolves to the viewer that shows the file, or
  // to null after an error.
  async function load(open, name, path = null, added = adds) {
    element.open = true;
    bar.hidden = false;
    bar.removeAttribute("value");
    report(`opening ${name} …`);
    const asking = setInterval(async () => {
      const { part } = await channel.opening().catch(() => ({ part: 0 }));
      if (part > 0) bar.value = part;
    }, ASK_EVERY);
    try {
      const opened = await open();
      if (!added) return reopen(opened, path);
      const both = await channel.add(store.scene, opened, store.title);
      return reopen(both, sourceOfBoth(viewer, path), { scene: both.scene, marks: store.marks, page: store.page, history: store.historyBefore });
    } catch (error) {
      failed(error);
    } finally {
      clearInterval(asking);
      bar.hidden = true;
    }
    return null;
  }

  // Opens a file of the list. A JSON file may be a session.
  async function openListed(path, name) {
    const session = name.endsWith(".json") ? await channel.session(path).catch(() => null) : null;
    return session === null ? load(() => channel.open(path), name, path) : viewer.openSession(session);
  }

  // Opens another DICOM series of a file, in place of the one that is open.
  viewer.openSeries = (file, series) => load(() => channel.open({ file, series }), file.split("/").pop(), { file, series }, false);
  viewer.upload = (file, added = adds) => load(() => channel.upload(file), file.name, null, added);
  // Opens dropped files. If several files are dropped, all but the first are added to the first.
  async function drop([first, ...others]) {
    if (others.length === 0 && first?.name.endsWith(".json") && viewer.openSession) return viewer.openSession(first);
    let shown = first ? await viewer.upload(first) : null;
    for (const file of others) if (shown !== null) shown = await shown.upload(file, true);
  }
  if (channel.open) {
    root.addEventListener("dragover", (event) => event.preventDefault());
    root.addEventListener("drop", (event) => {
      event.preventDefault();
      drop([...event.dataTransfer.files]);
    });
    element.addEventListener("toggle", async () => {
      if (!element.open || list.childElementCount > 0) return;
      await show(folderOf(store.source));
      element.scrollIntoView({ block: "nearest" }); // the new list may lie below the visible part of the side bar
    });
  }
  body.append(add.element, choose, chooser, where, bar, list);
  viewer.adds = () => adds;
  return { element, update: () => {} };
}
