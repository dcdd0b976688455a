// The files of a drop or of a file chooser, and which of them is opened.

const HEADERS = [".json", ".nhdr", ".nrrd", ".mhd", ".mha", ".vgi", ".hdr", ".pvti", ".vti", ".dat"]; // files that name others, first

const readEntries = (reader) => new Promise((resolve, reject) => reader.readEntries(resolve, reject));
const fileOf = (entry) => new Promise((resolve, reject) => entry.file(resolve, reject));

async function collect(entry, at, contents) {
  if (entry.isFile) {
    contents[at + entry.name] = await fileOf(entry);
    return;
  }
  const reader = entry.createReader();
  for (let entries; (entries = await readEntries(reader)).length > 0;) // some at a time
    for (const one of entries) await collect(one, `${at}${entry.name}/`, contents);
}

// Of several files the one that names the others; else the folder that they lie in: DICOM, or slices.
function chosen(names, folder) {
  if (names.length === 1) return names[0];
  return HEADERS.map((ending) => names.find((name) => name.toLowerCase().endsWith(ending))).find((name) => name !== undefined) ?? folder;
}

// { contents: { "folder/name": Blob }, path, title }: what WorkerChannel.open() takes.
export async function droppedFiles(transfer) {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter((entry) => entry); // before the first wait
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
