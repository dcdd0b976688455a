// The page: a viewer over the whole window, of what the server has open.

import { HttpChannel } from "./http_channel.js";
import { mount } from "./viewer.js";

try {
  const channel = new HttpChannel(), start = await channel.start();
  document.title = `${start.title} · Halflight`;
  globalThis.halflight = mount(document.body, channel, start, document); // for the browser's console, and for tests
} catch (error) {
  document.body.textContent = `The page cannot begin: ${error.message}`;
  throw error;
}
