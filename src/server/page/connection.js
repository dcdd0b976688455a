// The banner that says that the viewer does not answer. The banner stays until the viewer answers. The page asks the viewer at
// regular intervals, and at once when Retry is pressed. A browser treats a viewer at another port as another site, which cannot
// read this tab's session. The banner therefore also offers to save the session as a file.

import { button, make } from "./controls.js";

// The error with which the requests of a channel fail if the viewer does not answer or no longer
// knows this page.
export class Lost extends Error {}

const ASK_EVERY = 2000; // milliseconds
const KEPT = "Nothing is lost: what you did is kept in this tab.";

// place: the element for the banner. onBack() is called when the viewer answers again. save() saves the session. Returns two functions:
// failed(error), which handles the error of any request, and end().
export function watchConnection(place, channel, report, { onBack, save }) {
  const text = make("span"), retry = button("Retry", () => ask(), { class: "primary" });
  const banner = make("div", { class: "banner", role: "alert", hidden: true }, text, make("span", { class: "buttons" }, retry, button("save session", save)));
  let timer = 0, ended = false;
  place.prepend(banner);

  async function ask() {
    clearTimeout(timer);
    retry.disabled = true;
    try {
      await channel.answers();
      banner.hidden = true;
      onBack();
    } catch (error) {
      text.textContent = `${error.message} ${KEPT}`;
      if (!ended && error instanceof Lost) timer = setTimeout(ask, ASK_EVERY);
    }
    retry.disabled = false;
  }

  function failed(error) {
    if (!(error instanceof Lost) || !channel.answers) {
      report(error.message);
      return;
    }
    text.textContent = `${error.message} ${KEPT}`;
    if (!banner.hidden) return;
    banner.hidden = false;
    timer = setTimeout(ask, ASK_EVERY);
  }

  return { failed, get isLost() { return !banner.hidden; }, end: () => { ended = true; clearTimeout(timer); } };
}
