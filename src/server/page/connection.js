// The banner that says that the viewer does not answer. It stays until the viewer answers: the viewer is
// asked again and again, and at once by Retry. A viewer at another port is another site, to which the browser shows nothing of this
// tab's session: the banner also saves the session as a file.

import { button, make } from "./controls.js";

// The viewer does not answer, or it no longer knows this page. The requests of a channel fail with this
// error.
export class Lost extends Error {}

const ASK_EVERY = 2000; // milliseconds
const KEPT = "Nothing is lost: what you did is kept in this tab.";

// place: the element for the banner. onBack() is called when the viewer answers again; save() saves the session. Returns failed(error),
// which takes any error of a request, and end().
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
