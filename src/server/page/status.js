// The line below the picture. The line says whether the picture shows the present scene. It shows the
// progress of the next picture, and names the other pictures that the server is making.

import { make } from "./controls.js";

// Milliseconds until the progress of a picture is first asked for, and between such questions.
const ASK_AFTER = 600, ASK_EVERY = 400;
// The texts about the work that comes before a picture, by the stage that the channel's progress()
// tells.
const AWAITED = { voxels: "finer voxels are being read", labels: "smoothing labels", sky: "light of the sky" };
// The names of the stages of frames.js. "coarse": the final picture of the present voxels, while finer
// voxels are still to be read.
const STAGES = { moving: "moving", settling: "refining", settled: "refining", refining: "refining", final: "final", coarse: "refining" };
// The fraction of the progress that is reached when the quick picture, the first picture at rest or the final picture is finished.
const ENDS = { moving: 0.2, settling: 0.4, refining: 1 };
const AHEAD = 0.5; // the fraction of a picture's remaining progress that each stage before the picture takes

// The progress to the final picture of one state of the scene. Up to three pictures are made on the way. The
// progress `done` never falls.
export class Way {
  done = 0;
  #from = 0; // the progress at which the present stage began
  #end = 0; // the progress at which the present picture will be finished
  #picture = "";
  #made = "";

  // Notes that a picture is begun. picture: a stage of frames.js.
  begin(picture) {
    if (!(picture in ENDS) || picture === this.#picture) return;
    [this.#picture, this.#made, this.#from] = [picture, "", this.done];
    this.#end = Math.max(this.done, ENDS[picture]);
  }

  // Takes the progress { part, stage } of the present picture, as the channel's progress() tells
  // it.
  go({ part, stage }) {
    if (stage !== this.#made) [this.#made, this.#from] = [stage, this.done];
    this.done = Math.max(this.done, this.#from + (this.#end - this.#from) * part * (stage in AWAITED ? AHEAD : 1));
  }
}

// find(id): returns an element of the viewer. Returns three functions. show(frame): takes a frame of frames.js. wait(promise): returns the
// promise; until the promise is settled, the page waits for a state that a person has requested, and no picture counts as final. end(): ends
// the line.
export function statusLine(find, channel) {
  const stage = find("stage"), progress = find("progress");
  let timer = 0, number = 0, state = null, way = new Way(), name = "", awaited = 0, ended = false;

  // Shows the progress as long as a picture is under way.
  async function ask(mine) {
    const told = await channel.progress().catch(() => ({ part: 0, stage: "picture", others: 0 }));
    if (mine !== number) return;
    way.go(told);
    const { part, stage: made, others } = told, before = part < 1 ? AWAITED[made] : undefined; // a finished stage (part = 1) is not shown
    const percent = Math.min(Math.floor(100 * way.done), 99);
    const line = [percent > 0 ? `${percent} %` : "", before].filter(Boolean).join(", ");
    progress.textContent = line + (others > 0 ? ` · with ${others} other ${others === 1 ? "picture" : "pictures"} under way` : "");
    timer = setTimeout(() => ask(mine), ASK_EVERY);
  }

  function stop() {
    number++;
    clearTimeout(timer);
    progress.textContent = "";
  }

  function tell() {
    if (name === "") return; // no picture has been begun
    stage.textContent = stage.dataset.stage = name === "final" && awaited > 0 ? "waiting" : name;
  }

  function wait(promise) {
    awaited++;
    tell();
    return promise.finally(() => {
      awaited--;
      tell();
    });
  }

  function show(frame) {
    if (ended) return; // a picture may still arrive after end()
    name = frame.error ? "failed" : STAGES[frame.stage];
    const isOver = !(frame.stage in ENDS) && frame.stage !== "settled";
    if (isOver || frame.state !== state) stop();
    if (!isOver && frame.state !== state) {
      way = new Way();
      if (channel.progress) timer = setTimeout(ask, ASK_AFTER, number);
    }
    state = isOver ? null : frame.state;
    way.begin(frame.stage);
    tell();
    if (frame.error || !(frame.bytes > 0)) return;
    const seconds = frame.milliseconds < 1000 ? `${Math.round(frame.milliseconds)} ms` : `${(frame.milliseconds / 1000).toFixed(1)} s`;
    const told = [`${frame.width} × ${frame.height}`, `step ${+frame.spacing.toPrecision(2)} voxels`, seconds, `${Math.ceil(frame.bytes / 1024)} KiB`];
    find("statistics").replaceChildren(...told.map((part) => make("span", {}, part)));
  }
  return { show, wait, end: () => { ended = true; stop(); } };
}
