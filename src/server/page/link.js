// Links: a person's changes as a short text for the end of an address. The text holds the differences of the
// scene, the marks and the layout from their state when the viewer began. The text contains no file names,
// so that the link works in any viewer of the same file.

import { reshaped } from "./camera.js";
import { readMarks } from "./marks.js";

const MARK = "#view=";
const MOST_BYTES = 1 << 20; // the greatest number of bytes of a link's text after it is decompressed

// Returns the difference between two values: { to: value }, { gone: 1 }, or { in: { key: difference } } for two objects or two arrays of the same length.
// Undefined: the values are equal; the order of keys does not matter.
export function difference(from, to) {
  if (from === to || JSON.stringify(from) === JSON.stringify(to)) return undefined;
  const both = (test) => test(from) && test(to), isObject = (x) => x !== null && typeof x === "object" && !Array.isArray(x);
  if (!both(isObject) && !(both(Array.isArray) && from.length === to.length && from.length > 0)) return { to };
  const keys = [...new Set([...Object.keys(from), ...Object.keys(to)])];
  const parts = keys.map((key) => [key, key in to ? (Object.hasOwn(from, key) ? difference(from[key], to[key]) : { to: to[key] }) : { gone: 1 }]);
  const left = parts.filter(([, part]) => part !== undefined);
  return left.length > 0 ? { in: Object.fromEntries(left) } : undefined;
}

export function changed(from, part) {
  if (part === undefined) return from;
  if (part.in === undefined) return part.to;
  const entries = Array.isArray(from) ? from.map((value, n) => [n, value]) : Object.entries(from ?? {});
  const values = new Map(entries.map(([key, value]) => [String(key), value]));
  for (const [key, inner] of Object.entries(part.in)) {
    if (inner?.gone) values.delete(key);
    else values.set(key, changed(values.get(key), inner));
  }
  return Array.isArray(from) ? [...values.values()] : Object.fromEntries(values);
}

const streamed = (bytes, stream) => new Response(new Blob([bytes]).stream().pipeThrough(stream)).arrayBuffer();

async function packed(text) {
  const bytes = new Uint8Array(await streamed(new TextEncoder().encode(text), new CompressionStream("deflate-raw")));
  return btoa(String.fromCharCode(...bytes)).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

async function unpacked(word) {
  const bytes = Uint8Array.from(atob(word.replaceAll("-", "+").replaceAll("_", "/")), (c) => c.charCodeAt(0));
  const reader = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader(), pieces = [];
  for (let size = 0; ;) {
    const { done, value } = await reader.read();
    if (done) return new Blob(pieces).text();
    size += value.length;
    if (size > MOST_BYTES) throw new Error("it is too long");
    pieces.push(value);
  }
}

// Returns the state that links compare. Its scene has the size of the picture with which the viewer
// began, so that a link does not contain the window's size.
function comparable(store, start) {
  const { scene, marks, page: { bookmarks: _, film: __, ...page } } = store, { width, height } = start.scene.image;
  return { scene: { ...scene, camera: reshaped(scene.camera, scene.image, { width, height }), image: { ...scene.image, width, height } }, marks, page };
}

function beginning({ scene: { marks, ...scene } }) {
  return { scene: { volumes: [], ...scene }, marks: readMarks(marks), page: {} };
}

export async function linkOf(store, start) {
  return MARK + (await packed(JSON.stringify(difference(beginning(start), comparable(store, start)) ?? {})));
}

export const isLink = (text) => text.includes(MARK);

// Shows the state in a link, as one step of the history. Throws an error if the text is no link or does not
// fit the open scene.
export async function follow(text, { store, start, channel, waits }) {
  let told;
  try {
    told = changed(beginning(start), JSON.parse(await unpacked(text.slice(text.indexOf(MARK) + MARK.length))));
  } catch (error) {
    throw new Error(`this link cannot be read: ${error.message || "it is cut short"}`);
  }
  const marks = readMarks(told?.marks), page = told?.page;
  const scene = await waits(channel.completeScene(told?.scene ?? {}));
  store.replace({
    scene, marks, page: { ...(page !== null && typeof page === "object" && !Array.isArray(page) ? page : {}), bookmarks: store.page.bookmarks, ...(store.page.film ? { film: store.page.film } : {}) },
  });
}
