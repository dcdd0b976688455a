// A viewer's requests to the server that sent its page. All of them stay below the page's own address, which holds
// the token. The widget of notebooks has a channel of its own with the same methods (widget.js).

export class Refused extends Error {}

async function check(response) {
  if (response.ok) return response;
  throw new Refused((await response.text()).trim() || `the viewer answered ${response.status}`);
}

// "render;dur=12.5, encode;dur=3" as { render: 12.5, encode: 3 }, in milliseconds.
function parseTimes(header) {
  return Object.fromEntries((header ?? "").split(", ").map((part) => part.split(";dur=")).map(([k, v]) => [k, +v]));
}

export class HttpChannel {
  #number = 0;
  #page = crypto.getRandomValues(new Uint32Array(2)).reduce((name, n) => name + n.toString(36), "p");

  // What is open, and what there is to choose from: start.json.
  async start() {
    return (await check(await fetch("start.json"))).json();
  }

  // The scene with its defaults written out: presets as points, a camera that frames everything.
  async completeScene(scene) {
    return (await check(await fetch("scene", { method: "POST", body: JSON.stringify(scene) }))).json();
  }

  // A picture of the scene: { blob, times }, or null where a newer frame of this page has cancelled it. `lane` sets
  // frames apart that do not cancel each other.
  async fetchFrame(scene, { format = "jpeg", quality = 85, depth = 8, lane = "" } = {}) {
    const query = new URLSearchParams({ page: this.#page + lane, number: ++this.#number, format, quality, depth });
    const response = await check(await fetch(`frame?${query}`, { method: "POST", body: JSON.stringify(scene) }));
    if (response.status === 204) return null;
    return { blob: await response.blob(), times: parseTimes(response.headers.get("Server-Timing")) };
  }
}
