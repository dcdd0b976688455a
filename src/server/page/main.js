// The page: a viewer over the whole window, of what the server has open.

import { HttpChannel } from "./http_channel.js";
import { mount } from "./viewer.js";

let channel = null;

// Shows what is open, in place of what was.
function show(start) {
  globalThis.halflight?.end();
  channel?.leave();
  channel = new HttpChannel(start.opened);
  document.title = `${start.title} · Halflight`;
  globalThis.halflight = mount(document.body, channel, start, { keyboard: document, reopen: show }); // for the console, and for tests
}

addEventListener("pagehide", () => channel?.leave());
addEventListener("pageshow", (event) => { if (event.persisted) location.reload(); }); // what it had is given back

try {
  show(await new HttpChannel().start());
} catch (error) {
  document.body.textContent = `The page cannot begin: ${error.message}`;
  throw error;
}
