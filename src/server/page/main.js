// The page: a viewer that fills the window and shows the server's open scene, with the changes that
// were made in this tab.

import { HttpChannel } from "./http_channel.js";
import { isLink } from "./link.js";
import { followTitle, isOfOpen, keepSession, keptSession, restoreFrom } from "./session.js";
import { mount } from "./viewer.js";

let channel = null, shown = { source: null, keeping: null };

// Shows an open scene in a new viewer, which replaces the present viewer. source: the path by which the
// scene was opened. kept: a session whose state the viewer takes.
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

// Shows the state in a link at the end of the address, and removes the link from the address. A reload then
// keeps the changes that were made after the link was followed.
function followAddress() {
  const { hash } = location;
  if (!isLink(hash)) return;
  history.replaceState(null, "", location.pathname);
  globalThis.halflight.followLink(hash);
}

// Opens the file of a session, and shows the session's state. Returns false if the file is not in the
// viewer's folder, or is another file.
async function reopen(session) {
  const opened = session.source === null ? null : await channel.open(session.source);
  if (opened === null || !isOfOpen(session.scene, opened)) return false;
  show(opened, session.source, session);
  return true;
}

// Opens the file that the tab had open before a reload, with the tab's changes. If the tab had no file
// open, the scene is opened with which the viewer began.
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
// A page that comes back from the browser's cache is loaded anew, because the server has released
// what it held for the page.
addEventListener("pageshow", (event) => { if (event.persisted) location.reload(); });

try {
  await begin();
} catch (error) {
  document.body.textContent = `The page cannot begin: ${error.message}`;
  throw error;
}
