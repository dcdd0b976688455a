// The page: a viewer over the whole window, of what the server has open.

import { HttpChannel } from "./http_channel.js";
import { mount } from "./viewer.js";

// Shows what is open, in place of what was.
function show(start) {
  globalThis.halflight?.end();
  document.title = `${start.title} · Halflight`;
  globalThis.halflight = mount(document.body, new HttpChannel(start.opened), start, { keyboard: document, reopen: show }); // for the console, and for tests
}

try {
  show(await new HttpChannel().start());
} catch (error) {
  document.body.textContent = `The page cannot begin: ${error.message}`;
  throw error;
}
