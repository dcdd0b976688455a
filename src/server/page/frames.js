// Frames: chooses the next picture, and its quality. While something moves, quick pictures follow each other;
// each is asked for when the last one has come. Their work fits into the time of a frame, by the clock and of the processors. Their
// sheets are as far apart as their pixels are long. The channel takes volumes whose voxels are about as long, so that thin surfaces
// stay whole. At rest a picture follows that is as fine as fits into half a second. Then the exact
// picture follows, which is the one that `halflight render` makes of the same scene.

import { worldHeight } from "./camera.js";
import { fit, follow, leastWork, workAt } from "./quality.js";
import { length } from "./vector.js";

const BUDGET = 1000 / 20; // milliseconds by the clock for a frame while something moves
const PROCESSOR_BUDGET = 80; // milliseconds of processor time for such a frame, however many cores there are
const REST_AFTER = 120; // milliseconds without a change, after which the scene is at rest
// Milliseconds for the first picture of full size, so that it is there half a second after the last change.
const SETTLED_WITHIN = 350;
// The number of voxels that a channel prepares in a few tenths of a second, unless it tells another number.
const SOON_PREPARED = 128 ** 3;
const SHADOW_PIXELS = 0.5; // the longer side of a shadow buffer, as a part of a moving picture's longer side
const ADAPTION = 0.6; // exponent: the part of an error in time that one frame corrects

// The distance of the first picture's sheets, such that the volumes of this picture are soon prepared.
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
  #work; // of a picture while something moves
  #timely; // the work that takes as long as the budget by the clock
  #voxel = 1; // the length of the voxels of the last picture while something moved
  #voxels;
  #scene = null; // the scene that the newest picture shows, or will show
  #animation = null; // { change, began: null until its first picture is shown, milliseconds }
  statistics = { previews: 0, cancelled: 0, finals: 0, stage: "start" };

  // report({ stage, state, width, height, spacing, milliseconds, bytes, scene, seen, error }) is told of every frame, and when a picture is begun of a
  // scene at rest. state: a number that is another one after each change. stage: "moving" at a change and with each quick picture; "settling"
  // and "refining" when the first and the final picture at rest are begun, "settled" and "final" when these are there; "failed". seen: with "final", of
  // fetchFrame().
  constructor({ store, start, channel }, canvas, report) {
    this.#measure(start);
    this.#store = store;
    this.#work = this.#timely = workAt(firstSpacing(start.volumes, channel.soonPrepared ?? SOON_PREPARED), this.#full());
    this.#channel = channel;
    this.#canvas = canvas;
    this.#report = report;
    // Marks and layouts change no picture.
    store.listen((scene) => { if (scene !== this.#scene) this.move(); });
  }

  #measure({ volumes }) {
    this.#voxels = volumes.map((volume) => Math.min(...volume.axes.map(length)));
  }

  // Volumes were replaced by finer resolutions of themselves.
  refine(start) {
    this.#measure(start);
    this.move();
  }

  // Asks for no more frames.
  end() {
    this.#ended = true;
    this.#changed = false;
    this.#animation = null;
    this.#generation++;
    clearTimeout(this.#timer);
  }

  // Tells that something has changed.
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

  // Shows change(scene, part) instead of the scene. The part grows from 0 to 1 in this time, or until
  // something changes.
  animate(change, milliseconds) {
    this.move();
    this.#animation = { change, began: null, milliseconds };
  }

  // A frame of the animation; the scene itself where there is no animation, or where it has ended. A frame shows the moment at which it is
  // seen, which comes BUDGET after the moment at which it is asked for.
  #animated(scene) {
    if (this.#animation === null) return scene;
    const { change, began, milliseconds } = this.#animation, part = began === null ? 0 : (performance.now() + BUDGET - began) / milliseconds;
    if (part >= 1) this.#animation = null;
    return part < 1 ? change(scene, part) : scene;
  }

  // Whether the final picture of this scene is there.
  hasFinal(scene) { return this.statistics.stage === "final" && scene === this.#scene; }

  // The picture at full size. voxels: the length of a pixel at the target, in voxels.
  #full() {
    const { camera, volumes, image: { width, height } } = this.#store.scene;
    const scale = volumes.map(({ transform }) => [transform?.scale ?? 1].flat().map(Math.abs));
    const voxel = Math.min(...volumes.map((_, v) => this.#voxels[v] * Math.min(...scale[v])));
    return { width, height, pixels: width * height, voxels: worldHeight(camera) / voxel / height };
  }

  // The scene in a picture of about this many pixels, with sheets at least this far apart.
  #scaled({ pixels, spacing }) {
    const scene = this.#store.scene, full = this.#full();
    const factor = Math.min(1, Math.sqrt(pixels / full.pixels));
    // The picture has the shape of the full one, as otherwise it would be stretched.
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

  // Adapts the work that fits into the budgets to the times that the last picture took by the clock, for all and for its rendering alone, and of the
  // processors; 0: not told. What a frame takes beside its rendering, as the way to a distant server, does not fall with the work: rendering has
  // the rest of the budget, and half of it at least.
  #learn(milliseconds, rendering, processor) {
    const full = this.#full().pixels, rendered = rendering > 0 ? Math.min(rendering, milliseconds) : milliseconds;
    const timely = (this.#work * Math.max(BUDGET - (milliseconds - rendered), BUDGET / 2)) / rendered;
    const adapted = (now, aim) => Math.min(Math.max(now * Math.min(Math.max(aim / now, 0.25), 2) ** ADAPTION, leastWork(full)), full);
    this.#timely = adapted(this.#timely, timely);
    this.#work = adapted(this.#work, Math.min(timely, (this.#work * PROCESSOR_BUDGET) / processor));
  }

  // The scene in a picture of the work that fits into the budgets.
  #affordable() {
    const quality = follow(this.#work, this.#full(), this.#voxel), scene = this.#scaled(quality);
    this.#voxel = quality.voxel;
    if (scene.render.shadow_resolution !== "auto") return scene;
    const { width, height } = scene.image;
    return { ...scene, render: { ...scene.render, shadow_resolution: Math.ceil(SHADOW_PIXELS * Math.max(width, height)) } };
  }

  // The picture at rest, in two steps, as long as nothing changes.
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

  // before: what is told when the picture is begun.
  async #step(generation, scene, stage, before) {
    const began = performance.now();
    const options = stage === "final" ? { format: "png", seen: true } : { quality: 92, moving: true };
    this.#tell(before, scene, began, null);
    const frame = await this.#channel.fetchFrame(scene, options);
    if (generation !== this.#generation) return;
    if (frame === null) {
      // The other end gave this frame up without a newer one, as a viewer that is ending does. Asking again shows whether it has
      // ended.
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
