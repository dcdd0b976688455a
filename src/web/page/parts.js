// Reads the parts of a page without a server: the files that the page needs beside its script. The parts are files next
// to the page. If the page is a single file, the parts are elements of the page (src/web/assemble.py).

async function unpacked(element) {
  const packed = Uint8Array.from(atob(element.textContent.trim()), (letter) => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Returns whether the parts are files next to the page.
export const isFolder = () => document.querySelector("script[data-part]") === null;

// Returns the bytes of a part.
export async function part(name) {
  const element = document.querySelector(`script[data-part="${name}"]`);
  if (element !== null) return unpacked(element);
  const response = await fetch(name);
  if (!response.ok) throw new Error(`${name}: the page's server answered ${response.status}`);
  return new Uint8Array(await response.arrayBuffer());
}

// Returns the files of the scene that the page contains, by their names; an empty object if the page contains none.
export async function heldFiles() {
  const elements = [...document.querySelectorAll("script[data-file]")];
  return Object.fromEntries(await Promise.all(elements.map(async (element) => [element.dataset.file, await unpacked(element)])));
}
