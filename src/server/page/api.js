// Requests to the server that sent this page. All of them stay below the page's own address, which holds the
// token.

export class Refused extends Error {}

async function check(response) {
  if (response.ok) return response;
  throw new Refused((await response.text()).trim() || `the viewer answered ${response.status}`);
}

export async function fetchStart() {
  return (await check(await fetch("start.json"))).json();
}

// The scene with its defaults written out: presets as points, a camera that frames everything.
export async function completeScene(scene) {
  return (await check(await fetch("scene", { method: "POST", body: JSON.stringify(scene) }))).json();
}

// "render;dur=12.5, encode;dur=3" as { render: 12.5, encode: 3 }, in milliseconds.
function parseTimes(header) {
  return Object.fromEntries((header ?? "").split(", ").map((part) => part.split(";dur=")).map(([k, v]) => [k, +v]));
}

let frameNumber = 0;
const pageName = crypto.getRandomValues(new Uint32Array(2)).reduce((name, n) => name + n.toString(36), "p");

// A picture of the scene: { blob, times }, or null where a newer frame of this page has cancelled it. `lane` sets
// frames apart that do not cancel each other.
export async function fetchFrame(scene, { format = "jpeg", quality = 85, depth = 8, lane = "" } = {}) {
  const query = new URLSearchParams({ page: pageName + lane, number: ++frameNumber, format, quality, depth });
  const response = await check(await fetch(`frame?${query}`, { method: "POST", body: JSON.stringify(scene) }));
  if (response.status === 204) return null;
  return { blob: await response.blob(), times: parseTimes(response.headers.get("Server-Timing")) };
}
