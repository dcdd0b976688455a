// Renders scenes by the library as WebAssembly in node, as tests/web/equal.py asks.
//
// usage: node render.mjs ENGINE.js FILE.wasm FOLDER JOBS.json THREADS TAKEN
// TAKEN: bytes of the library's memory that nothing else may use, so that what it makes lies behind them. JOBS.json: [{ scene, files, out, size }], names in FOLDER; scene may be a volume, or a folder. Prints one line for each picture: "NAME MILLISECONDS", or "unfused".

import fs from "node:fs";
import path from "node:path";
import { Worker } from "node:worker_threads";

const [engineFile, wasm, folder, jobs, threads, taken] = process.argv.slice(2), engine = path.resolve(engineFile);
const { Engine } = await import(engine);
const bytes = fs.readFileSync(wasm);
if (!WebAssembly.validate(bytes)) {
  console.log("unknown");
  process.exit(0);
}
const help = (work) => new Promise((ready, failed) => {
  new Worker(new URL("helper.mjs", import.meta.url), { workerData: { engine, work } }).once("message", ready).once("error", failed);
});
const PIECE = 1 << 29; // one block is of less than two gibibytes
const Instance = WebAssembly.Instance;
WebAssembly.Instance = function (...of) {
  const made = new Instance(...of);
  for (let left = Number(taken); left > 0; left -= PIECE) if (made.exports.web_room(PIECE) === 0) throw new Error(`no ${taken} bytes of memory`);
  return made;
};
const library = await Engine.of(await WebAssembly.compile(bytes), { help }, Number(threads));
if (!library.fuses) {
  console.log("unfused");
  process.exit(0);
}
for (const { scene, files, out, size } of JSON.parse(fs.readFileSync(jobs))) {
  const contents = Object.fromEntries(files.map((name) => [name, new Uint8Array(fs.readFileSync(path.join(folder, name)))]));
  const start = await library.open(contents, scene);
  if (size) [start.scene.image.width, start.scene.image.height] = size;
  const began = performance.now();
  fs.writeFileSync(path.join(folder, out), await library.frame(start.scene, { format: "npy" }));
  console.log(scene, Math.round(performance.now() - began));
}
process.exit(0); // helpers wait for ever
