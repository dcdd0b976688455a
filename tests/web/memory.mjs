// Opens volumes one after the other in node, some of which are too large for the library, as tests/web/memory.py asks.
//
// usage: node memory.mjs ENGINE.js FILE.wasm FOLDER JOBS.json
// JOBS.json: [{ file, full, out, size }]. full: whether the library's memory is taken before, but for pieces of less than
// 64 MiB. Prints a line for each job: "shown", or the library's line.

import fs from "node:fs";
import path from "node:path";

const PIECE = 1 << 26;
const [engine, wasm, folder, jobs] = process.argv.slice(2), { Engine, EngineError } = await import(path.resolve(engine));
const Instance = WebAssembly.Instance;
let exports = null;
WebAssembly.Instance = function (...of) {
  const made = new Instance(...of);
  ({ exports } = made);
  return made;
};
const library = await Engine.of(await WebAssembly.compile(fs.readFileSync(wasm)), {}, 1);
if (!library.fuses) {
  console.log("unfused");
  process.exit(0);
}
for (const { file, full, out, size } of JSON.parse(fs.readFileSync(jobs))) {
  const pieces = [];
  for (let piece = full ? exports.web_room(PIECE) : 0; piece !== 0; piece = exports.web_room(PIECE)) pieces.push(piece);
  try {
    const start = await library.open({ [file]: new Uint8Array(fs.readFileSync(path.join(folder, file))) }, file);
    [start.scene.image.width, start.scene.image.height] = size;
    start.scene.render.sheet_spacing = 16;
    fs.writeFileSync(path.join(folder, `${out}.npy`), await library.frame(start.scene, { format: "npy" }));
    start.scene.volumes[0].file = file; // the library's name of it begins at its root
    fs.writeFileSync(path.join(folder, `${out}.json`), JSON.stringify(start.scene));
    console.log("shown");
  } catch (error) {
    if (!(error instanceof EngineError)) throw error;
    console.log(error.message);
  }
  pieces.forEach((piece) => exports.web_release(piece));
}
