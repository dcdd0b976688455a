// The timeline under the picture: a row for each track, with keys that can be dragged, and below the rows a slider of frames. The slider keeps
// its place when tracks are added.

import { button, make, shortNumber } from "./controls.js";
import { followDrag } from "./drag.js";
import { CAMERA, trackName, withMovedKey, withoutKey } from "./timeline.js";

// The page shows frame numbers that begin at 1. In keys, as in commands, the first frame is 0. get() returns
// { tracks, frames, frame, fps }; setTracks(tracks) takes changed tracks; show(frame) goes to a frame; play()
// begins or ends playing; canShow: whether frames can be shown at all. Returns { element, update }.
export function timelineStrip({ get, setTracks, show, play, canShow }) {
  const slider = make("input", { type: "range", min: 0, step: 1, "aria-label": "Frame", oninput: () => show(+slider.value) });
  const told = make("span", {}), seconds = make("span", {});
  const player = button("play", play, { disabled: !canShow, title: "Plays the film in small pictures" });
  const rows = make("div", {});
  const element = make("div", { class: "timeline", hidden: true }, rows, make("div", { class: "track frame" }, player, slider, make("output", { class: "time" }, told, seconds)));

  const left = (frame) => `${(100 * frame) / Math.max(get().frames - 1, 1)}%`;

  function drag(event, path, from) {
    const area = event.currentTarget.parentNode.getBoundingClientRect();
    let at = from;
    followDrag(event, window, (moved) => {
      const part = (moved.clientX - area.left) / area.width, last = get().frames - 1;
      const to = Math.min(Math.max(Math.round(part * last), 0), last);
      if (to === at) return;
      const { tracks } = get(), points = tracks.find((track) => track.path === path).points;
      if (points.some(([frame]) => frame === to)) return; // keys do not pass over each other
      setTracks(withMovedKey(tracks, path, at, to));
      at = to;
    });
  }

  function onKey(event, path, frame) {
    const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key] * (event.shiftKey ? 10 : 1);
    const to = Math.min(Math.max(frame + step, 0), get().frames - 1);
    if (event.key === "Delete" || event.key === "Backspace") setTracks(withoutKey(get().tracks, path, frame));
    else if (step) {
      if (to !== frame) setTracks(withMovedKey(get().tracks, path, frame, to));
      rows.querySelector(`[data-path="${CSS.escape(path)}"][data-frame="${to}"]`)?.focus();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  }

  const keyMark = (path, [frame, value]) => {
    const mark = button("", () => show(frame), {
      class: "key", "data-path": path, "data-frame": frame, title: path === CAMERA ? `frame ${frame + 1}` : `frame ${frame + 1}: ${[value].flat().map(shortNumber).join(", ")}`,
      "aria-label": `Key of ${trackName(path)} at frame ${frame + 1}. Arrow keys move it, Delete removes it.`,
      onpointerdown: (event) => drag(event, path, frame), onkeydown: (event) => onKey(event, path, frame),
    });
    mark.style.left = left(frame);
    return mark;
  };

  // Moves the keyboard's focus after the rows were drawn anew: to the nearest key of the same track, or to the slider.
  function focusNear({ path, frame }) {
    const away = (key) => Math.abs(key.dataset.frame - frame);
    const keys = [...rows.querySelectorAll(".key")].filter((key) => key.dataset.path === path).sort((a, b) => away(a) - away(b));
    (keys[0] ?? slider).focus();
  }

  let drawn = null;
  function update() {
    const { tracks, frames, frame, fps, playing } = get();
    slider.max = frames - 1;
    slider.value = frame;
    slider.style.setProperty("--filled", left(frame));
    told.textContent = `${frame + 1} of ${frames}`;
    seconds.textContent = ` · ${(frame / fps).toFixed(2)} s`;
    slider.setAttribute("aria-valuetext", `frame ${frame + 1} of ${frames}`);
    player.textContent = playing ? "stop playing" : "play";
    if (drawn?.tracks === tracks && drawn.frames === frames) return;
    drawn = { tracks, frames };
    const { activeElement } = rows.getRootNode(), focused = rows.contains(activeElement) ? { ...activeElement.dataset } : null;
    rows.replaceChildren(...tracks.map(({ path, points }) => make("div", { class: "track" },
      make("span", { class: "track-name", title: path }, trackName(path)), make("span", { class: "track-keys" }, ...points.map((point) => keyMark(path, point))),
      button("−", () => setTracks(get().tracks.filter((track) => track.path !== path)), { "aria-label": `Remove the keys of ${trackName(path)}` }))));
    if (focused !== null) focusNear(focused);
  }
  return { element, update };
}
