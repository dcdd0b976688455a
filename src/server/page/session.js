// The whole state of a page as one object, kept in the tab while it is open and saved as a file: the scene,
// the marks, the layout, the crosshair, bookmarks, the film, and the history. It holds a person's changes and the names
// of the volumes, but not their voxels.

import { readMarks } from "./marks.js";

const KEY = "halflight-session", VERSION = 1;
const KEEP_AFTER = 300; // milliseconds without a change

// source: the path, or the list of paths, that the viewer's own list has opened; null for the scene that the viewer began with. own: the
// paths of the files that the scene contains; this list is shorter than `source` after the addition of files was undone. title: the name
// of the scene's files; whole: the name of all open files.
export const sessionOf = (store, { title: whole }, source) =>
  ({ halflight_session: VERSION, title: store.title, whole, source, own: store.source, scene: store.scene, marks: store.marks, page: store.page });

// Returns whether a value is a source: a path, a path with one of its series, or a list of these
// that are opened together.
const isSource = (source) => [source].flat().every((one) => typeof one === "string" || (typeof one?.file === "string" && typeof one.series === "string"));

// Returns the session in an object. The parts on which the page relies are checked. Null: the
// object is no session.
export function readSession(object) {
  if (object === null || typeof object !== "object" || object.halflight_session !== VERSION || typeof object.scene?.camera !== "object") return null;
  const { source = null, own = null, title = "", whole = title, scene, page = {} } = object, marks = readMarks(object.marks);
  const known = typeof page === "object" && page !== null && !Array.isArray(page) ? page : {};
  return { source: isSource(source) ? source : null, own: isSource(own) ? own : null, title: String(title), whole: String(whole), scene, marks, page: known };
}

// Returns the names of a scene's files, as texts: [names of the volumes, names of the meshes].
const namesOf = (scene) => [
  (scene.volumes ?? []).map(({ file, shapes, array, component, series, time, channel, level, mask }) => [file, shapes, array, component, series, time, channel, level, mask?.file]),
  (scene.meshes ?? []).map(({ file }) => file ?? "")].map((names) => names.map((name) => JSON.stringify(name)));

const begins = (names, all) => names.every((name, n) => name === all[n]);

export const isOfSameFiles = (scene, other) => {
  const [names, others] = [namesOf(scene), namesOf(other)];
  return names.every((kind, k) => kind.length === others[k].length && begins(kind, others[k]));
};

// Returns the scene with the resolutions of the open volumes, for volumes whose resolution follows the view. A scene file has the
// resolutions of its picture instead.
export const atOpenLevels = (scene, { scene: { volumes: open = [] }, volumes: about }) => ({
  ...scene, volumes: (scene.volumes ?? []).map((volume, v) => (about[v]?.level_follows_view && open[v]?.file === volume.file ? { ...volume, level: open[v].level } : volume)),
});

// Returns whether a scene consists of the open files, or of the first of the open files. For volumes
// whose resolution follows the view, the resolutions need not agree.
export const isOfOpen = (scene, start) => {
  const [names, all] = [namesOf(atOpenLevels(scene, start)), namesOf(start.scene)];
  return names.flat().length > 0 && names.every((kind, k) => begins(kind, all[k]));
};

// Returns start.json with only the volumes and meshes that the scene has, as before further files
// were added.
export function startOf(scene, start) {
  const volumes = scene.volumes?.length ?? 0, meshes = scene.meshes?.length ?? 0, first = start.scene;
  if ((first.volumes?.length ?? 0) === volumes && (first.meshes?.length ?? 0) === meshes) return start;
  const { meshes: all, ...rest } = first;
  return { ...start, volumes: start.volumes.slice(0, volumes), scene: { ...rest, volumes: first.volumes.slice(0, volumes), ...(meshes > 0 ? { meshes: all.slice(0, meshes) } : {}) } };
}

// Keeps the session in the tab's storage. If the storage has no room for the whole session, the
// session is kept without its history.
function keep(store, start, source) {
  const session = sessionOf(store, start, source);
  for (const kept of [{ ...session, history: store.history }, session])
    try {
      sessionStorage.setItem(KEY, JSON.stringify(kept));
      return;
    } catch {
      // there is no room, or the browser keeps nothing
    }
}

// Sets the window's title to the name of the scene's files, also after changes.
export function followTitle(store) {
  const follow = () => { document.title = `${store.title} · Halflight`; };
  store.listen((_, name) => { if (name === "history") follow(); });
  follow();
}

export function keepSession(store, start, source, signal) {
  let timer = 0;
  const now = () => { clearTimeout(timer); keep(store, start, source); };
  const soon = () => { clearTimeout(timer); timer = setTimeout(now, KEEP_AFTER); };
  soon(); // the session is kept even before the first change, because a file may have just been opened or added
  store.listen(soon);
  addEventListener("pagehide", now, { signal });
  signal.addEventListener("abort", () => clearTimeout(timer));
}

// Returns the session that the tab has kept, with its history; null: the tab has kept no session.
export function keptSession() {
  try {
    const object = JSON.parse(sessionStorage.getItem(KEY)), session = readSession(object);
    return session && { ...session, history: Array.isArray(object.history) && object.history.length === 4 ? object.history : null };
  } catch {
    return null;
  }
}

// Shows the session or the scene in a file, if its volumes are open in the viewer (mount() of viewer.js). If the volumes of a
// session are not open, reopen(session) may open them and show the session; reopen() resolves to whether it has done so. Resolves to
// "opened", or to "other" for a scene of other files.
export async function restoreFrom(file, { store, start }, channel, reopen = () => false) {
  let object;
  try {
    object = JSON.parse(await file.text());
  } catch {
    throw new Error(`${file.name} is no JSON`);
  }
  const session = readSession(object), scene = session?.scene ?? object;
  if (session === null && object?.halflight === undefined) throw new Error(`${file.name} is neither a session nor a scene`);
  if (isOfOpen(scene, start)) store.replace({ ...session, source: session?.own ?? store.source, scene: await channel.completeScene(atOpenLevels(scene, start)) });
  else if (session === null) return "other";
  else if (!(await reopen(session))) throw new Error(`the session is of ${session.title}, and ${store.title} is open: open that first`);
  return "opened";
}
