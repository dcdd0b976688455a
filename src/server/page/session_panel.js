// The panel with bookmarks of views, and with buttons that save and open the session as a file.

import { reshaped } from "./camera.js";
import { button, isActive, make, row, section } from "./controls.js";
import { download, stem } from "./export.js";
import { follow, isLink, linkOf } from "./link.js";
import { sessionOf } from "./session.js";

const THUMBNAIL = 72; // pixels of height

// Returns a small copy of the shown picture.
function thumbnail(picture) {
  const canvas = document.createElement("canvas");
  canvas.height = THUMBNAIL;
  canvas.width = Math.round((THUMBNAIL * picture.width) / picture.height);
  canvas.getContext("2d").drawImage(picture, 0, 0, canvas.width, canvas.height);
  return canvas.toDataURL("image/jpeg", 0.7);
}

// The views that a person has marked, in store.page.bookmarks: { name, camera, image: { width, height }, cursor, thumbnail }.
function bookmarkList({ store, find }) {
  const list = make("ul", { class: "bookmarks", "aria-label": "Bookmarks" });
  const all = () => store.page.bookmarks ?? [], setAll = (bookmarks) => store.setPage({ bookmarks });
  const add = () => {
    const { camera, image: { width, height } } = store.scene;
    setAll([...all(), { name: `View ${all().length + 1}`, camera, image: { width, height }, cursor: store.page.cursor, thumbnail: thumbnail(find("picture")) }]);
  };
  const go = (n) => {
    const { camera, image, cursor } = all()[n];
    store.setCamera(reshaped(camera, image, store.scene.image));
    if (cursor) store.setPage({ cursor });
  };
  function item(n) {
    const mark = all()[n];
    const name = make("input", { type: "text", value: mark.name, "aria-label": `Name of view ${n + 1}`, onchange: () => setAll(all().map((one, m) => (m === n ? { ...one, name: name.value } : one))) });
    const shown = make("img", { src: /^data:image\/jpeg;base64,/.test(mark.thumbnail ?? "") ? mark.thumbnail : "data:,", alt: "", height: THUMBNAIL / 2 });
    return make("li", {}, make("button", { type: "button", class: "view", "aria-label": `Go to ${mark.name}`, onclick: () => go(n) }, shown), name,
      button("−", () => setAll(all().filter((_, m) => m !== n)), { "aria-label": `Remove ${mark.name}` }));
  }
  let shown = null;
  function update() {
    if (shown === all()) return;
    shown = all();
    if (![...list.querySelectorAll("input")].some(isActive)) list.replaceChildren(...shown.map((_, n) => item(n)));
  }
  return { element: list, add, update };
}

export function sessionPanel(viewer) {
  const { store, start, source, report, openSession } = viewer, { element, body } = section("Session", false);
  const bookmarks = bookmarkList(viewer);
  const save = () => {
    const name = `${stem(store.title)}-session.json`;
    download(new Blob([JSON.stringify(sessionOf(store, start, source ?? null), null, 1)], { type: "application/json" }), name);
    report(`saved ${name}`);
  };
  viewer.saveSession = save;
  const chooser = make("input", { type: "file", accept: ".json", hidden: true, "aria-label": "A session or a scene", onchange: async () => {
    const [file] = chooser.files;
    chooser.value = "";
    if (file) openSession(file);
  } });
  const copyLink = async () => viewer.copy(viewer.address + (await linkOf(store, start)), "the link");
  const pasted = make("input", { type: "text", placeholder: "#view=…", "aria-label": "A link to follow", onchange: async () => {
    const text = pasted.value;
    pasted.value = "";
    await viewer.followLink(text);
  } });
  viewer.followLink = (text) => (isLink(text) ? follow(text, viewer).catch(viewer.failed) : report("A link has #view= in it."));
  const backwards = button("camera back", () => store.undoCamera(), { title: "The view before (c)" }), forwards = button("camera on", () => store.redoCamera(), { title: "The view after (C)" });
  body.append(row(make("span", { class: "name" }, "View"), make("span", { class: "buttons" }, button("bookmark", bookmarks.add), backwards, forwards)), bookmarks.element,
    row(make("span", { class: "name" }, "Session"), make("span", { class: "buttons" }, button("save session", save),
      ...(openSession ? [button("open …", () => chooser.click(), { "aria-label": "Open a session or a scene" }), button("start afresh", () => viewer.startAfresh(), { title: "As the viewer began; Undo brings back what was done" })] : []))),
    row(make("span", { class: "name" }, "Link"), make("span", { class: "pair" }, pasted, button("copy link", copyLink, { title: "What you see now, as the end of an address: for whoever has the same file open" }))),
    chooser, ...(openSession ? [make("p", { class: "facts" }, "A session holds the scene, marks, bookmarks, film and layout, and names its volumes. This tab keeps it, for when the page is reloaded and the same files are open again.")] : []));
  function update() {
    bookmarks.update();
    backwards.disabled = !store.canUndoCamera;
    forwards.disabled = !store.canRedoCamera;
  }
  update();
  return { element, update, updateView: update };
}
