// The line below the picture. It says whether the picture shows the present scene, the progress of the next
// picture, and which other pictures are waited for.

import { make } from "./controls.js";

// Milliseconds until the progress of a picture is first asked for, and between such questions.
const ASK_AFTER = 600, ASK_EVERY = 400;
// What is waited for before the picture is begun, for each stage of progress() of the channel.
const AWAITED = { labels: "smoothing labels", sky: "light of the sky" };
const STAGES = { moving: "moving", settled: "refining", refining: "refining", final: "final", waiting: "waiting" };

// find(id): an element of the viewer. Returns show(frame), of frames.js, and end().
export function statusLine(find, channel) {
  const stage = find("stage"), progress = find("progress");
  let timer = 0, number = 0;

  // Shows the progress as long as the picture is under way.
  async function ask(mine) {
    const { part, stage: of, others } = await channel.progress().catch(() => ({ part: 0, stage: "picture", others: 0 }));
    if (mine !== number) return;
    const awaited = AWAITED[of], isDone = awaited !== undefined && part >= 1; // the picture has not begun
    const told = [awaited, part > 0 ? `${Math.round(100 * part)} %` : ""].filter(Boolean).join(", ");
    progress.textContent = (isDone ? "" : told) + (others > 0 ? ` · with ${others} other ${others === 1 ? "picture" : "pictures"} under way` : "");
    timer = setTimeout(() => ask(mine), ASK_EVERY);
  }

  function show(frame) {
    const name = frame.error ? "failed" : STAGES[frame.stage];
    if (name !== stage.dataset.stage || frame.stage === "settled") {
      number++;
      clearTimeout(timer);
      progress.textContent = "";
      if ((name === "refining" || name === "moving") && channel.progress) timer = setTimeout(ask, ASK_AFTER, number);
    }
    stage.textContent = name;
    stage.dataset.stage = name;
    if (frame.error || !(frame.bytes > 0)) return;
    const seconds = frame.milliseconds < 1000 ? `${Math.round(frame.milliseconds)} ms` : `${(frame.milliseconds / 1000).toFixed(1)} s`;
    const told = [`${frame.width} × ${frame.height}`, `step ${+frame.spacing.toPrecision(2)} voxels`, seconds, `${Math.ceil(frame.bytes / 1024)} KiB`];
    find("statistics").replaceChildren(...told.map((part) => make("span", {}, part)));
  }
  return { show, end: () => { number++; clearTimeout(timer); } };
}
