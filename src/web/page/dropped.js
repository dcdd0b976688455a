// Collects the files of a drop or of a file chooser, and chooses the file that is opened.

// Endings of files that name other files; the first one in this list is opened.
const HEADERS = [".json", ".nhdr", ".nrrd", ".mhd", ".mha", ".vgi", ".hdr", ".pvti", ".vti", ".dat"];

const readEntries = (reader) => new Promise((resolve, reject) => reader.readEntries(resolve, reject));
const fileOf = (entry) => new Promise((resolve, reject) => entry.file(resolve, reject));

async function collectEntry(entry, at, contents) {
  if (entry.isFile) {
    contents[at + entry.name] = await fileOf(entry);
    return;
  }
  const reader = entry.createReader();
  for (let entries; (entries = await readEntries(reader)).length > 0;) // readEntries() gives only some of the entries at a time
    for (const one of entries) await collectEntry(one, `${at}${entry.name}/`, contents);
}

async function collectHandle(handle, at, contents) {
  if (handle.kind === "file") contents[at + handle.name] = await handle.getFile();
  else for await (const one of handle.values()) await collectHandle(one, `${at}${handle.name}/`, contents);
}

// Collects the files of a folder. In a page from a disk, Chromium refuses to read the entries of a folder, and reads its
// handle. Firefox has no handles of items. Entries are read wherever they can be: for the handle of a folder such as
// /dev/shm, Chromium first asks the user.
async function folderOf(item, entry) {
  const contents = {};
  if (globalThis.origin === "null" && item.getAsFileSystemHandle) await collectHandle(await item.getAsFileSystemHandle(), "", contents);
  else await collectEntry(entry, "", contents);
  return { contents, path: entry.name, title: entry.name };
}

// Chooses the file that is opened. Of several files it is the one that names the others. If there is none, the folder
// of the files is opened, as DICOM or as slices.
function chosen(names, folder) {
  if (names.length === 1) return names[0];
  return HEADERS.map((ending) => names.find((name) => name.toLowerCase().endsWith(ending))).find((name) => name !== undefined) ?? folder;
}

// Returns { contents: { "folder/name": Blob }, path, title }, which WorkerChannel.open() takes.
export async function droppedFiles(transfer) {
  // Nothing may wait before the items are asked, because the browser then empties the list.
  const items = [...transfer.items].filter(({ kind }) => kind === "file"), entry = items[0]?.webkitGetAsEntry?.();
  if (items.length === 1 && entry?.isDirectory) return folderOf(items[0], entry);
  return chosenFiles([...transfer.files]);
}

export function chosenFiles(files) {
  const folder = "files", contents = Object.fromEntries(files.map((file) => [`${folder}/${file.name}`, file]));
  const path = chosen(Object.keys(contents), folder);
  return { contents, path, title: path === folder ? `${files.length} files` : path.slice(folder.length + 1) };
}
