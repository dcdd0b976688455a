// What a page without a server consists of, beside its script: files next to it, or, where it is one file, elements that
// hold them (src/web/assemble.py).

async function unpacked(element) {
  const packed = Uint8Array.from(atob(element.textContent.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Whether the parts are files beside the page.
export const isFolder = () => document.querySelector("script[data-part]") === null;

// The bytes of a part.
export async function part(name) {
  const element = document.querySelector(`script[data-part="${name}"]`);
  if (element !== null) return unpacked(element);
  const response = await fetch(name);
  if (!response.ok) throw new Error(`${name}: the page's server answered ${response.status}`);
  return new Uint8Array(await response.arrayBuffer());
}

// The files of the scene that the page holds, by name; empty where it holds none.
export async function heldFiles() {
  const elements = [...document.querySelectorAll("script[data-file]")];
  return Object.fromEntries(await Promise.all(elements.map(async (element) => [element.dataset.file, await unpacked(element)])));
}
