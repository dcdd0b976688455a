// Renders scenes by the library as WebAssembly in node, as tests/web/equal.py asks.
//
// usage: node render.mjs ENGINE.js FILE.wasm FOLDER JOBS.json
// JOBS.json: [{ scene, files, out, size }], names in FOLDER; scene may be a volume, or a folder. Prints one line for each picture: "NAME MILLISECONDS", or "unfused".

import fs from "node:fs";
import path from "node:path";

const [engine, wasm, folder, jobs] = process.argv.slice(2);
const { Engine } = await import(path.resolve(engine));
const bytes = fs.readFileSync(wasm);
if (!WebAssembly.validate(bytes)) {
  console.log("unknown");
  process.exit(0);
}
const library = await Engine.of(await WebAssembly.compile(bytes));
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
