// The page: a viewer over the whole window that shows the server's open scene, as this tab has left it.

import { HttpChannel } from "./http_channel.js";
import { isLink } from "./link.js";
import { followTitle, isOfOpen, keepSession, keptSession, restoreFrom } from "./session.js";
import { mount } from "./viewer.js";

let channel = null, shown = { source: null, keeping: null };

// Shows the open scene, and replaces the viewer before. source: the path by which it was opened; kept: a
// session to go on with.
function show(start, source = null, kept = null) {
  const focused = document.activeElement?.id;
  globalThis.halflight?.end();
  shown.keeping?.abort();
  if (channel?.opened !== start.opened) {
    channel?.leave();
    channel = new HttpChannel(start.opened, source, start.refined);
  }
  shown = { source, keeping: new AbortController() };
  const viewer = mount(document.body, channel, start, { keyboard: document, reopen: show, source, kept, restore: (file) => restoreFrom(file, viewer, channel, reopen), startAfresh: () => show(start, source, { scene: start.scene, page: {}, history: viewer.store.historyBefore }) });
  globalThis.halflight = viewer; // for the console, and for tests
  followTitle(viewer.store);
  keepSession(viewer.store, start, source, shown.keeping.signal);
  if (focused) document.getElementById(focused)?.focus();
  followAddress();
  return viewer;
}

// Shows the state in a link at the end of the address, and removes it from there: a reload then goes on with
// the changes since.
function followAddress() {
  const { hash } = location;
  if (!isLink(hash)) return;
  history.replaceState(null, "", location.pathname);
  globalThis.halflight.followLink(hash);
}

// Opens the file of a session, and goes on with the session. False: the file is not in the viewer's folder,
// or is another file.
async function reopen(session) {
  const opened = session.source === null ? null : await channel.open(session.source);
  if (opened === null || !isOfOpen(session.scene, opened)) return false;
  show(opened, session.source, session);
  return true;
}

// Opens the file that the tab had open, with the changes; where there is none, the scene that the viewer
// began with.
async function begin() {
  const kept = keptSession(), first = new HttpChannel();
  if (kept?.source) {
    try {
      const start = await first.open(kept.source);
      if (isOfOpen(kept.scene, start)) return show(start, kept.source, kept);
    } catch (error) {
      return show(await first.start()).report(`${kept.whole} cannot be opened again: ${error.message}`);
    }
  }
  const start = await first.start(), goesOn = kept !== null && isOfOpen(kept.scene, start);
  return show(start, null, goesOn ? kept : null);
}

addEventListener("hashchange", followAddress);
addEventListener("pagehide", () => channel?.leave());
// The server has given back what the page had.
addEventListener("pageshow", (event) => { if (event.persisted) location.reload(); });

try {
  await begin();
} catch (error) {
  document.body.textContent = `The page cannot begin: ${error.message}`;
  throw error;
}
