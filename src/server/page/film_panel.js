// The panel of films: a turn, and numbers of the scene that go from value to value. The film is what `halflight
// animate` makes; "Pictures" are numbered PNGs in a zip archive, which need no ffmpeg.

import { button, make, row, section, select } from "./controls.js";
import { download, quoted, sceneText, stem } from "./export.js";

const ASK_EVERY = 300; // milliseconds, for how far the film is
const TURNS = { "camera.azimuth": 0, "camera.elevation": 0, "camera.roll": 0, "camera.zoom": 1 };

// The paths of all numbers of a scene, as keys name them.
export function numberPaths(value, path = "") {
  if (typeof value === "number") return [path];
  if (value === null || typeof value !== "object") return [];
  return Object.entries(value).flatMap(([key, part]) => numberPaths(part, path ? `${path}.${key}` : key));
}

export const numberAt = (scene, path) => TURNS[path] ?? path.split(".").reduce((at, key) => at?.[key], scene);

export const animateCommand = (scene, title, { turntable, keys, fps, format }) =>
  [`halflight animate - ${turntable > 0 ? `--turntable ${turntable} ` : ""}`, ...keys.map((key) => `--key ${quoted(key)} `),
    `--fps ${fps} -o ${quoted(format === "zip" ? stem(title) : `${stem(title)}.${format}`)} <<'END'\n${sceneText(scene)}END\n`].join("");

function timeLeft(seconds) {
  return seconds < 90 ? `${Math.ceil(seconds)} s` : `${Math.ceil(seconds / 60)} min`;
}

export function filmPanel({ store, start, channel, report, copy }) {
  const { element, body } = section("Film", false);
  const number = (label, value, low, high) => make("input", { type: "number", min: low, max: high, step: 1, value, "aria-label": label });
  const turn = number("Frames of a whole turn; 0 for none", 120, 0, 100000), fps = number("Frames a second", 30, 1, 240);
  const keys = make("textarea", { rows: 2, spellcheck: "false", "aria-label": "Keys, one on each line: path=frame:value,frame:value", placeholder: "lights.0.intensity=0:1,60:3" });
  const names = make("datalist", { id: "film-paths" });
  const path = make("input", { type: "text", list: "film-paths", "aria-label": "A number of the scene", placeholder: "a number of the scene" });
  const at = number("Frame", 0, 0, 100000);
  let format = "mp4";
  const kind = select({
    label: "Format", choices: [["mp4", "MP4"], ["webm", "WebM"], ["gif", "GIF"], ["zip", "Pictures"]], get: () => format, set: (value) => { format = value; },
  });
  const bar = make("progress", { max: 1, value: 0, hidden: true, "aria-label": "The film" }), told = make("p", { class: "facts", role: "status" });

  // The path's value now, at the frame: appended to the path's line, or on a new one.
  function addKey() {
    const value = numberAt(store.scene, path.value.trim());
    if (typeof value !== "number") {
      report("choose a number of the scene first");
      return;
    }
    const lines = keys.value.split("\n").filter((line) => line.trim()), found = lines.findIndex((line) => line.startsWith(`${path.value.trim()}=`));
    const point = `${+at.value}:${value}`;
    if (found >= 0) lines[found] += `,${point}`;
    else lines.push(`${path.value.trim()}=${point}`);
    keys.value = lines.join("\n");
  }

  const wanted = () => ({
    turntable: Math.max(0, Math.round(+turn.value) || 0), fps: Math.round(+fps.value) || 30, format,
    keys: keys.value.split("\n").map((line) => line.trim()).filter(Boolean),
  });

  async function run() {
    const began = performance.now(), name = `${stem(start.title)}.${format}`;
    go.hidden = true;
    stop.hidden = bar.hidden = false;
    told.textContent = "begins …";
    const asking = setInterval(async () => {
      const { done, frames } = await channel.filmProgress().catch(() => ({ done: 0, frames: 0 }));
      if (frames === 0) return;
      bar.value = done / frames;
      const left = done > 0 ? `, ${timeLeft(((performance.now() - began) / 1000 / done) * (frames - done))} left` : "";
      told.textContent = `frame ${done + 1} of ${frames}${left}`;
    }, ASK_EVERY);
    try {
      const film = await channel.film(store.scene, wanted());
      if (film !== null) download(film, name);
      told.textContent = film === null ? "stopped" : `saved ${name}`;
    } catch (error) {
      told.textContent = error.message;
    }
    clearInterval(asking);
    stop.hidden = bar.hidden = true;
    go.hidden = false;
  }

  const go = button("make film", run, { class: "primary" });
  const stop = button("stop", () => channel.stopFilm(), { hidden: true });
  element.addEventListener("toggle", () => {
    if (element.open) names.replaceChildren(...[...Object.keys(TURNS), ...numberPaths(store.scene)].map((value) => make("option", { value })));
  });
  body.append(
    row(make("span", { class: "name" }, "Turn"), make("span", { class: "pair" }, turn, "frames at", fps, "a second")),
    row(make("span", { class: "name" }, "Keys"), keys), names,
    row("", path), row("", make("span", { class: "pair" }, button("add its value now", addKey), "at frame", at)),
    ...(channel.film ? [kind.element, row("", make("span", { class: "buttons" }, go, stop)), bar, told] : []),
    row("", button("copy animate command", () => copy(animateCommand(store.scene, start.title, wanted()), "the command"))));
  kind.update();
  return { element, update: () => {} };
}
