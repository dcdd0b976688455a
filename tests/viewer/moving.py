#!/usr/bin/env python3
"""The quality of moving pictures, chosen by the page's own code for machines of any number of cores: a frame takes no longer than the budgets,
by the clock and of the processors, and is as fine as they allow; so is the first picture at rest.

usage: moving.py PROGRAM BROWSER
"""
import os
import subprocess
import sys
import tempfile

import checks
from checks import check
from firefox import browser_named
from hands import PROGRAM, rest
from viewer import Viewer, need_viewer

# Moves a scene of 1280 x 800 pixels before a machine that takes `cost` milliseconds of processor time for each million pixels with sheets a
# voxel apart, on `cores` cores, and `rest` milliseconds for the rest of a frame. Resolves to the last moving frame and the first one at rest:
# { pixels, spacing, clock, processor }.
MACHINE = """(async (cores, cost, tells, rest) => {
  const { Frames } = await import('./frames.js'), { Store } = await import('./store.js');
  const scene = { ...halflight.store.scene, image: { ...halflight.store.scene.image, width: 1280, height: 800 } };
  const store = new Store({ ...scene, render: { ...scene.render, sheet_spacing: 1 } }), asked = [];
  const canvas = Object.assign(document.createElement('canvas'), { width: 8, height: 8 }), blob = await new Promise((done) => canvas.toBlob(done));
  let clock = 0; // the machine's own milliseconds: the page's clock does not go on while it waits
  performance.now = () => clock;
  const channel = { async fetchFrame({ image, render }, { moving = false }) {
    const processor = (cost * image.width * image.height) / 1e6 / render.sheet_spacing, time = rest + processor / cores;
    clock += time;
    asked.push({ pixels: image.width * image.height, spacing: render.sheet_spacing, clock: time, processor, moving });
    return { blob, times: tells ? { processor, render: processor / cores } : {} };
  } };
  const start = { volumes: halflight.start.volumes };
  const found = await new Promise((done, fail) => {
    const frames = new Frames({ store, start, channel }, canvas, ({ stage, bytes, error }) => {
      if (error) fail(error);
      if (bytes > 0 && asked.length < 40) frames.move();
      else if (bytes > 0 && stage !== 'moving') { frames.end(); done(stage); }
    });
    frames.move();
  });
  delete performance.now;
  const moving = asked[39], settled = asked.slice(40).find((frame) => frame.spacing > 1 || frame.pixels < 1280 * 800) ?? asked.at(-1);
  return { found, moving, settled };
})"""

# Moves a scene whose voxels are about as long as its pixels before a machine of two cores that takes `cost` milliseconds for each million of
# pixels with sheets a voxel apart, and for volumes of voxels twice as long a half of this. Resolves to 120 frames: { length, spacing, voxel }, the
# lengths of a pixel, between sheets and of the volumes' voxels, in voxels.
VOLUMES = """(async (cost) => {
  const { Frames } = await import('./frames.js'), { Store } = await import('./store.js'), { worldHeight } = await import('./camera.js');
  const scene = { ...halflight.store.scene, image: { ...halflight.store.scene.image, width: 1280, height: 800 } };
  const store = new Store({ ...scene, render: { ...scene.render, sheet_spacing: 0.5 } }), asked = [];
  const canvas = Object.assign(document.createElement('canvas'), { width: 8, height: 8 }), blob = await new Promise((done) => canvas.toBlob(done));
  const voxel = worldHeight(scene.camera) / 800;
  let clock = 0;
  performance.now = () => clock;
  const channel = { async fetchFrame({ image: { width, height }, render }) {
    const spacing = render.sheet_spacing, level = 2 ** Math.floor(Math.log2(Math.min(Math.max(spacing * Math.SQRT2, 1), 8)));
    const processor = (cost * width * height) / 1e6 / spacing / level;
    clock += 2 + processor / 2;
    asked.push({ length: 800 / height, spacing, voxel: level });
    return { blob, times: { processor } };
  } };
  const start = { volumes: halflight.start.volumes.map((volume) => ({ ...volume, axes: [[voxel, 0, 0], [0, voxel, 0], [0, 0, voxel]] })) };
  await new Promise((done, fail) => {
    const frames = new Frames({ store, start, channel }, canvas, ({ bytes, error }) => {
      if (error) fail(error);
      if (bytes > 0 && asked.length < 120) frames.move();
      else if (bytes > 0) { frames.end(); done(); }
    });
    frames.move();
  });
  delete performance.now;
  return asked.slice(0, 120);
})"""

# The voxels that the first picture of a volume of 256 x 256 x 256 voxels needs, for a channel that prepares this number of them soon.
FIRST = """(async (soonPrepared) => {
  const { Frames } = await import('./frames.js'), { Store } = await import('./store.js');
  const start = { volumes: halflight.start.volumes.map((volume) => ({ ...volume, dimensions: [256, 256, 256] })) };
  const { scene } = halflight.store, store = new Store({ ...scene, image: { ...scene.image, width: 1280, height: 800 }, render: { ...scene.render, sheet_spacing: 1 } });
  return new Promise((done) => {
    const channel = { soonPrepared, fetchFrame: async ({ render }) => { frames.end(); done(256 ** 3 / render.sheet_spacing ** 3); return null; } };
    const frames = new Frames({ store, start, channel }, document.createElement('canvas'), () => {});
    frames.move();
  });
})"""


def qualities(browser, cores, cost, tells=True, others=10):
    return browser.run(f"{MACHINE}({cores}, {cost}, {str(tells).lower()}, {others})", timeout=60)


def main():
    kind = browser_named(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        need_viewer(PROGRAM)
        subprocess.run([PROGRAM, "make", "rings", "--size", "32", "--quiet", "-o", "rings.nrrd"], check=True)
        with Viewer(PROGRAM, "rings.nrrd") as viewer, kind(size=(900, 620)) as browser:
            browser.open(viewer.url)
            rest(browser)
            for cores in (1, 2, 4, 8, 32):
                for cost in (20, 300, 1000):
                    made = qualities(browser, cores, cost)
                    moving, settled = made["moving"], made["settled"]
                    limit = min(80, 40 * cores)  # of processor time
                    aim = min(limit, cost * 1.024)
                    check(0.9 * aim < moving["processor"] < 1.1 * limit, f"{cores} cores, {cost} ms: {made}")
                    check(moving["clock"] < 55, f"{cores} cores, {cost} ms: by the clock: {made}")
                    check(settled["clock"] < 390 and (settled["clock"] > 250 or settled["pixels"] == 1280 * 800 and settled["spacing"] < 1.3), f"{cores} cores, {cost} ms: the first picture at rest: {made}")
            untold = qualities(browser, 8, 1000, tells=False)["moving"]
            check(45 < untold["clock"] < 55, f"a machine that does not tell its processors' time: the clock alone: {untold}")
            distant = qualities(browser, 2, 1000, others=300)["moving"]
            check(22 < distant["clock"] - 300 < 28, f"a distant server: rendering has half of the budget: {distant}")
            for cost in (80, 200, 500, 1000, 2000, 5000, 12000):
                frames = browser.run(f"{VOLUMES}({cost})", timeout=60)[40:]
                lengths = [frame["length"] / frame["spacing"] for frame in frames]
                # Where finer volumes wait for 2.5 times the work, pixels alone take it.
                check(min(lengths) > 0.98 / 2.5**0.5 and max(lengths) < 1.05, f"{cost} ms: sheets are about as far apart as pixels are long: {min(lengths)} to {max(lengths)}")
                check(len({frame["voxel"] for frame in frames}) == 1, f"{cost} ms: all frames have the same volumes: {frames}")
            whole, quarter = (browser.run(f"{FIRST}({soon})", timeout=60) for soon in (128**3, 128**3 / 4))
            check(abs(whole / quarter - 4) < 1e-9, f"the first picture waits for a quarter of the voxels where a quarter is soon prepared: {whole} and {quarter}")
            check(browser.problems == [], f"the console has errors: {browser.problems}")
    print(f"{checks.count} checks passed")


if __name__ == "__main__":
    main()
