// Frames: chooses the next picture, and its quality. While something moves, quick pictures follow each other; each quick picture is
// requested when the one before has arrived. The work of a quick picture is chosen so that its time by the clock and its processor
// time fit into budgets. The sheets of a quick picture are as far apart as its pixels are long. The channel renders coarser volumes
// whose voxels are about as long as the distance of the sheets, so that thin surfaces have no holes. At rest a picture follows that
// is as fine as fits into half a second. The exact picture comes last; `halflight render` makes the same picture of the scene.

import { worldHeight } from "./camera.js";
import { fit, follow, leastWork, workAt } from "./quality.js";
import { length } from "./vector.js";

const BUDGET = 1000 / 20; // milliseconds by the clock for a frame while something moves
const PROCESSOR_BUDGET = 80; // milliseconds of processor time for such a frame, however many cores there are
const REST_AFTER = 120; // milliseconds without a change, after which the scene is at rest
// The milliseconds that the first picture of full size may take. This picture is then finished half a
// second after the last change.
const SETTLED_WITHIN = 350;
// The number of voxels that a channel prepares in a few tenths of a second, unless it tells another number.
const SOON_PREPARED = 128 ** 3;
const SHADOW_PIXELS = 0.5; // the longer side of a shadow buffer, as a fraction of the longer side of a quick picture
const ADAPTION = 0.6; // exponent of the correction of the work: the fraction of an error in time, as a logarithm, that one frame corrects

// Returns the distance of the sheets of the first quick picture. The distance makes the channel take
// volumes so coarse that they are soon prepared.
function firstSpacing(volumes, soonPrepared) {
  const voxels = volumes.reduce((sum, { dimensions: [i, j, k] }) => sum + i * j * k, 0);
  return Math.max(Math.cbrt(voxels / soonPrepared), 1.5);
}

// The renderer computes blocks of 16 x 16 pixels.
const BLOCK = 16;

export class Frames {
  #store;
  #channel;
  #canvas;
  #report;
  #changed = false;
  #busy = false;
  #ended = false;
  #generation = 0;
  #timer = 0;
  #work; // the work of a quick picture (quality.js)
  #timely; // the work whose time by the clock equals BUDGET
  #voxel = 1; // the length of the voxels of the last quick picture
  #voxels;
  #scene = null; // the scene that the newest picture shows, or will show
  #animation = null; // { change, began: null until its first picture is shown, milliseconds }
  statistics = { previews: 0, cancelled: 0, finals: 0, stage: "start" };

  // report({ stage, state, width, height, spacing, milliseconds, bytes, scene, seen, error }) is called for every frame, and when a picture of a scene
  // at rest is begun. state: a number that differs after each change of the scene. stage: "moving" at a change and with each quick picture; "settling"
  // and "refining" when the first and the final picture at rest are begun, "settled" and "final" when these two pictures have arrived; "failed" after
  // an error. seen: the member `seen` of fetchFrame()'s result, given with "final".
  constructor({ store, start, channel }, canvas, report) {
    this.#measure(start);
    this.#store = store;
    this.#work = this.#timely = workAt(firstSpacing(start.volumes, channel.soonPrepared ?? SOON_PREPARED), this.#full());
    this.#channel = channel;
    this.#canvas = canvas;
    this.#report = report;
    // Changes of marks and of the layout leave the scene as it is, and so do not start a new
    // picture.
    store.listen((scene) => { if (scene !== this.#scene) this.move(); });
  }

  #measure({ volumes }) {
    this.#voxels = volumes.map((volume) => Math.min(...volume.axes.map(length)));
  }

  // Called when volumes were replaced by their finer resolutions.
  refine(start) {
    this.#measure(start);
    this.move();
  }

  // Ends the requests for frames.
  end() {
    this.#ended = true;
    this.#changed = false;
    this.#animation = null;
    this.#generation++;
    clearTimeout(this.#timer);
  }

  // Called when something has changed.
  move() {
    if (this.#ended) return;
    this.#scene = this.#store.scene;
    this.#animation = null;
    this.#changed = true;
    this.#generation++;
    clearTimeout(this.#timer);
    this.#tell("moving", this.#scene, performance.now(), null); // the picture no longer shows this scene
    if (this.statistics.stage === "refining") this.statistics.cancelled++;
    this.statistics.stage = "moving";
    if (!this.#busy) this.#preview();
  }

  // Shows change(scene, part) instead of the scene, as an animation. The number `part` grows from 0
  // to 1 during these milliseconds. A change of the scene ends the animation early.
  animate(change, milliseconds) {
    this.move();
    this.#animation = { change, began: null, milliseconds };
  }

  // Returns the animated scene, or the scene itself if no animation is running. The animated scene is computed for the moment at which the
  // frame will be visible, BUDGET milliseconds after its request.
  #animated(scene) {
    if (this.#animation === null) return scene;
    const { change, began, milliseconds } = this.#animation, part = began === null ? 0 : (performance.now() + BUDGET - began) / milliseconds;
    if (part >= 1) this.#animation = null;
    return part < 1 ? change(scene, part) : scene;
  }

  // Returns whether the final picture of this scene is shown.
  hasFinal(scene) { return this.statistics.stage === "final" && scene === this.#scene; }

  // Returns { width, height, pixels, voxels } of the picture at full size. voxels: the length of a
  // pixel at the target, in voxels.
  #full() {
    const { camera, volumes, image: { width, height } } = this.#store.scene;
    const scale = volumes.map(({ transform }) => [transform?.scale ?? 1].flat().map(Math.abs));
    const voxel = Math.min(...volumes.map((_, v) => this.#voxels[v] * Math.min(...scale[v])));
    return { width, height, pixels: width * height, voxels: worldHeight(camera) / voxel / height };
  }

  // Returns the scene for a picture of about this many pixels, with sheets at least `spacing`
  // apart.
  #scaled({ pixels, spacing }) {
    const scene = this.#store.scene, full = this.#full();
    const factor = Math.min(1, Math.sqrt(pixels / full.pixels));
    // The small picture has the aspect ratio of the full picture, as the page would otherwise
    // stretch the small picture.
    const width = factor === 1 ? full.width : Math.ceil((full.width * factor) / BLOCK) * BLOCK;
    const height = factor === 1 ? full.height : Math.max(1, Math.round((width * full.height) / full.width));
    const sheets = Math.max(spacing, scene.render.sheet_spacing);
    return {
      ...scene, image: { ...scene.image, width, height }, render: { ...scene.render, sheet_spacing: sheets, pixel_samples: 0 },
    };
  }

  async #preview() {
    this.#busy = true;
    while (this.#changed || this.#animation !== null) {
      this.#changed = false;
      const animation = this.#animation, scene = this.#animated(this.#affordable()), began = performance.now();
      try {
        const frame = await this.#channel.fetchFrame(scene, { quality: 80, moving: true });
        if (frame !== null) {
          await this.#show(frame.blob, scene.image);
          const { once = 0, render = 0, processor = 0 } = frame.times ?? {};
          this.#learn(performance.now() - began - once, render - once, processor);
          this.statistics.previews++;
          if (animation !== null) animation.began ??= performance.now();
          this.#tell("moving", scene, began, frame.blob);
        }
      } catch (error) {
        this.#animation = null;
        this.#fail(error);
        await new Promise((resolve) => setTimeout(resolve, 300));
      }
    }
    this.#busy = false;
    if (this.#ended || this.statistics.stage === "failed") return;
    this.#refineSoon();
  }

  #refineSoon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#refine(this.#generation), REST_AFTER);
  }

  // Adapts the work of quick pictures to the times of the last picture. milliseconds: time by the clock from request to arrival. rendering: time by
  // the clock of the rendering alone; processor: processor time; 0: not known. The rest of a frame's time, for example the way to a distant server,
  // does not fall with the work. Rendering therefore gets what is left of the budget, but at least half of the budget.
  #learn(milliseconds, rendering, processor) {
    const full = this.#full().pixels, rendered = rendering > 0 ? Math.min(rendering, milliseconds) : milliseconds;
    const timely = (this.#work * Math.max(BUDGET - (milliseconds - rendered), BUDGET / 2)) / rendered;
    const adapted = (now, aim) => Math.min(Math.max(now * Math.min(Math.max(aim / now, 0.25), 2) ** ADAPTION, leastWork(full)), full);
    this.#timely = adapted(this.#timely, timely);
    this.#work = adapted(this.#work, Math.min(timely, (this.#work * PROCESSOR_BUDGET) / processor));
  }

  // Returns the scene for a quick picture whose work fits into the budgets.
  #affordable() {
    const quality = follow(this.#work, this.#full(), this.#voxel), scene = this.#scaled(quality);
    this.#voxel = quality.voxel;
    if (scene.render.shadow_resolution !== "auto") return scene;
    const { width, height } = scene.image;
    return { ...scene, render: { ...scene.render, shadow_resolution: Math.ceil(SHADOW_PIXELS * Math.max(width, height)) } };
  }

  // Makes the picture at rest in two steps, unless something changes.
  async #refine(generation) {
    if (generation !== this.#generation) return;
    this.statistics.stage = "refining";
    const scene = this.#store.scene, quality = fit((this.#timely * SETTLED_WITHIN) / BUDGET, this.#full());
    try {
      if (quality.spacing > scene.render.sheet_spacing * 1.2 || quality.pixels < this.#full().pixels)
        await this.#step(generation, this.#scaled(quality), "settled", "settling");
      if (generation === this.#generation) await this.#step(generation, scene, "final", "refining");
    } catch (error) {
      if (generation === this.#generation) this.#fail(error);
    }
  }

  #fail(error) {
    this.statistics.stage = "failed";
    this.#report({ stage: "failed", error });
  }

  // Makes one picture at rest. before: the stage that is reported when the picture is begun.
  async #step(generation, scene, stage, before) {
    const began = performance.now();
    const options = stage === "final" ? { format: "png", seen: true } : { quality: 92, moving: true };
    this.#tell(before, scene, began, null);
    const frame = await this.#channel.fetchFrame(scene, options);
    if (generation !== this.#generation) return;
    if (frame === null) {
      // The channel's other end cancelled this frame although the page has requested no newer frame, as a server that is
      // shutting down does. A new request shows whether the server has ended.
      if (stage === "final") this.#refineSoon();
      return;
    }
    await this.#show(frame.blob, scene.image);
    if (generation !== this.#generation) return;
    if (stage === "final") {
      this.finalPicture = frame.blob;
      this.statistics.finals++;
      this.statistics.stage = "final";
    }
    this.#tell(stage, scene, began, frame.blob, frame.seen);
  }

  async #show(blob, { width, height }) {
    const bitmap = await createImageBitmap(blob, { premultiplyAlpha: "none", colorSpaceConversion: "none" });
    if (this.#canvas.width !== width) this.#canvas.width = width;
    if (this.#canvas.height !== height) this.#canvas.height = height;
    const context = this.#canvas.getContext("2d");
    context.globalCompositeOperation = "copy";
    context.drawImage(bitmap, 0, 0);
    bitmap.close();
  }

  #tell(stage, scene, began, blob, seen = null) {
    const { width, height } = scene.image;
    this.#report({
      stage, state: this.#generation, width, height, spacing: scene.render.sheet_spacing,
      milliseconds: performance.now() - began, bytes: blob?.size ?? 0, scene, seen,
    });
  }
}
