// Collects the files of a drop or of a file chooser, and chooses the file that is opened.

// Endings of files that name other files; the first one in this list is opened.
const HEADERS = [".json", ".nhdr", ".nrrd", ".mhd", ".mha", ".vgi", ".hdr", ".pvti", ".vti", ".dat"];

const readEntries = (reader) => new Promise((resolve, reject) => reader.readEntries(resolve, reject));
const fileOf = (entry) => new Promise((resolve, reject) => entry.file(resolve, reject));

async function collect(entry, at, contents) {
  if (entry.isFile) {
    contents[at + entry.name] = await fileOf(entry);
    return;
  }
  const reader = entry.createReader();
  for (let entries; (entries = await readEntries(reader)).length > 0;) // readEntries() gives only some of the entries at a time
    for (const one of entries) await collect(one, `${at}${entry.name}/`, contents);
}

// Chooses the file that is opened. Of several files it is the one that names the others. If there is none, the folder
// of the files is opened, as DICOM or as slices.
function chosen(names, folder) {
  if (names.length === 1) return names[0];
  return HEADERS.map((ending) => names.find((name) => name.toLowerCase().endsWith(ending))).find((name) => name !== undefined) ?? folder;
}

// Returns { contents: { "folder/name": Blob }, path, title }, which WorkerChannel.open() takes.
export async function droppedFiles(transfer) {
  // This must come before the first wait, because the browser then empties the list.
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter((entry) => entry);
  if (entries.length === 1 && entries[0].isDirectory) {
    const contents = {};
    await collect(entries[0], "", contents);
    return { contents, path: entries[0].name, title: entries[0].name };
  }
  return chosenFiles([...transfer.files]);
}

export function chosenFiles(files) {
  const folder = "files", contents = Object.fromEntries(files.map((file) => [`${folder}/${file.name}`, file]));
  const path = chosen(Object.keys(contents), folder);
  return { contents, path, title: path === folder ? `${files.length} files` : path.slice(folder.length + 1) };
}
