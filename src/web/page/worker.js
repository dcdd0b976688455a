// The worker of a page without a server. It holds an engine, and answers the requests of the page one after the other.
//
// From time to time, a call waits for the messages that have arrived meanwhile, because one of them may say that nobody
// wants the frame any more, or may request a slice. If the browser's WebAssembly cannot wait in the middle of a call,
// frames run to their end.
//

import { Engine } from "./engine.js";

const ASK_EVERY = 25; // the number of milliseconds between two such waits

let engine = null, current = 0, asked = 0;
const slices = []; // requests for slices that arrived in the middle of a frame
const gone = new Set(); // numbers of frames that nobody wants any more

// Lets the browser handle the messages that wait.
const messagesHandled = () => new Promise((resolve) => {
  const { port1, port2 } = new MessageChannel();
  port1.onmessage = resolve;
  port2.postMessage(null);
});

function cancelled() {
  if (!Engine.waits || current === 0 || performance.now() - asked < ASK_EVERY) return 0;
  return between().then(() => +gone.has(current));
}

// Handles messages in the middle of a frame, and answers requests for slices. A slice does not need anything of the
// unfinished frame.
async function between() {
  const frame = current;
  await messagesHandled();
  current = 0; // while a slice is made, the call does not wait for messages
  await answerSlices();
  current = frame;
  asked = performance.now();
}

// Makes a blob of a picture. JPEGs, which are only used for frames that are seen for a moment, are made by the
// browser's own encoder.
async function blobOf(bytes, format, { width, height }, quality) {
  if (format !== "rgba") return new Blob([bytes], { type: format === "png" ? "image/png" : "application/octet-stream" });
  const canvas = new OffscreenCanvas(width, height);
  canvas.getContext("2d").putImageData(new ImageData(new Uint8ClampedArray(bytes.buffer, bytes.byteOffset, bytes.length), width), 0, 0);
  return canvas.convertToBlob({ type: "image/jpeg", quality: quality / 100 });
}

const helpers = new Map(); // for the number of each helper that is not ready yet, { ready, failed }

// Asks the page for a helper for the library's threads. A helper is this script in a worker of its own. The page makes
// it, because a worker of Firefox sometimes waits for ever when it makes another worker.
const help = (work) => new Promise((ready, failed) => {
  helpers.set(work.number, { ready, failed });
  postMessage({ help: work });
});

function helped({ number, problem }) {
  const { ready, failed } = helpers.get(number);
  helpers.delete(number);
  if (problem === undefined) ready();
  else failed(new Error(problem));
}

const calls = {
  async begin({ modules }) {
    engine = await Engine.best(modules, { cancelled, help, progress: (part) => postMessage({ part }) });
    return { threads: engine?.threads ?? 0 };
  },
  open: async ({ contents, path, title }) => ({ start: await engine.open(contents, path, title) }),
  join: async ({ scene, contents, path, title }) => ({ start: await engine.join(scene, contents, path, title) }),
  slice: async (plane) => engine.slice(plane),
  depth: async ({ scene }) => ({ found: await engine.depth(scene) }),
  complete: async ({ scene, choices }) => ({ scene: await engine.complete(scene, choices) }),
  async frame({ scene, format, quality, depth, metadata, moving, number }) {
    await messagesHandled();
    if (gone.has(number)) return { blob: null };
    current = number;
    asked = performance.now();
    try {
      const began = performance.now(), wire = format === "jpeg" ? "rgba" : format;
      const bytes = await engine.frame(scene, { format: wire, depth, metadata, moving }), rendered = performance.now();
      if (bytes === null) return { blob: null };
      const blob = await blobOf(bytes, wire, scene.image, quality);
      return { blob, times: { render: rendered - began, encode: performance.now() - rendered } };
    } finally {
      current = 0;
    }
  },
};

async function answer({ number, kind, ...request }) {
  try {
    postMessage({ number, ...(await calls[kind]({ number, ...request })) });
  } catch (error) {
    postMessage({ number, problem: error.message });
  }
  gone.delete(number);
}

async function answerSlices() {
  while (slices.length > 0) await answer(slices.shift());
}

let last = Promise.resolve();
addEventListener("message", ({ data }) => {
  if (data.kind === "help") Engine.help(data.work, () => postMessage({}));
  else if (data.kind === "helped") helped(data);
  else if (data.kind === "cancel") gone.add(data.number);
  else if (data.kind === "slice" && current !== 0 && Engine.waits) slices.push(data);
  else last = last.then(() => answer(data)).then(answerSlices);
});
