// Several threads allocate and release memory of the library at once in node, as tests/web/equal.py asks.
//
// usage: node heap.mjs FILE.wasm THREADS
// Prints the number of blocks whose first, middle or last byte another block has overwritten, and the number of pages by
// which the memory grew although as many pages were free; or "unknown".

import fs from "node:fs";
import { isMainThread, parentPort, Worker, workerData } from "node:worker_threads";

const STACK = 1 << 20, BLOCKS = 100000, MOST_HELD = 40, MOST_BITS = 18, BAD_DESCRIPTOR = 8;

function load(module, memory) {
  const none = new Proxy({}, { get: () => () => BAD_DESCRIPTOR }); // the library finds no files
  return new WebAssembly.Instance(module, { env: { memory }, wasi_snapshot_preview1: none, page: { cancelled: () => 0, progress: () => {} } }).exports;
}

// Allocates and releases blocks of random sizes. Each block is filled with a byte that another thread does not use.
function countBroken(library, memory, thread) {
  const held = [];
  let broken = 0;
  for (let n = 0; n < BLOCKS; n++) {
    const size = 1 + Math.floor(2 ** (Math.random() * MOST_BITS)), pointer = library.web_room(size) >>> 0, mark = 1 + 50 * thread + n % 50;
    if (pointer === 0) throw new Error(`no memory for ${size} bytes`);
    new Uint8Array(memory.buffer, pointer, size).fill(mark);
    held.push({ pointer, size, mark });
    if (held.length < MOST_HELD) continue;
    const [old] = held.splice(Math.floor(Math.random() * MOST_HELD), 1), bytes = new Uint8Array(memory.buffer, old.pointer, old.size);
    if ([0, old.size >> 1, old.size - 1].some((place) => bytes[place] !== old.mark)) broken++;
    library.web_release(old.pointer);
  }
  return broken;
}

// Returns the number of pages by which the memory grows when blocks take the place of released blocks of other sizes.
function countGrown(library, memory) {
  const MEBIBYTE = 1 << 20, take = (sizes) => sizes.map((size) => library.web_room(size * MEBIBYTE));
  const release = (blocks) => blocks.forEach((block) => library.web_release(block));
  const [first, second, third] = take([40, 50, 30]), before = memory.buffer.byteLength;
  release([first, third, second]);
  for (const sizes of [[119], [20, 99], [70, 5, 5, 30]]) release(take(sizes));
  return (memory.buffer.byteLength - before) >> 16;
}

if (isMainThread) {
  const [file, threads] = process.argv.slice(2), bytes = fs.readFileSync(file);
  if (!WebAssembly.validate(bytes)) {
    console.log("unknown");
    process.exit(0);
  }
  const module = new WebAssembly.Module(bytes);
  const memory = new WebAssembly.Memory({ initial: 512, maximum: 65535, shared: true }), library = load(module, memory);
  library._initialize();
  const others = Array.from({ length: threads - 1 }, (_, other) => new Promise((told, failed) => {
    const stack = (library.web_room(STACK + 64 + library.__tls_size.value) + STACK + 63) & -64;
    new Worker(new URL(import.meta.url), { workerData: { module, memory, stack, thread: 1 + other } }).once("message", told).once("error", failed);
  }));
  // The workers start only when this thread waits for an event.
  await new Promise((done) => setTimeout(done, 200));
  const own = countBroken(library, memory, 0);
  console.log((await Promise.all(others)).reduce((sum, count) => sum + count, own), countGrown(library, memory));
} else {
  const { module, memory, stack, thread } = workerData, library = load(module, memory);
  library.__stack_pointer.value = stack;
  library.__wasm_init_tls(stack);
  parentPort.postMessage(countBroken(library, memory, thread));
}
