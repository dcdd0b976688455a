// Gives files to the library by the calls of WASI (WebAssembly System Interface, preview 1). The files form a tree of
// folders with the files that were dropped on the page. The library cannot write any file.

const SUCCESS = 0, BAD_DESCRIPTOR = 8, INVALID = 28, IS_FOLDER = 31, NO_FILE = 44, NO_CALL = 52, NO_FOLDER = 54, READ_ONLY = 69;
const FOLDER = 3, REGULAR = 4; // numbers of the types of files
const PIECE = 4 << 20; // the number of bytes of a file on the disk that are read at once
const ROOT = 3; // the descriptor of the folder "/"

// Converts a pointer to a positive number. Pointers beyond two gibibytes arrive as negative numbers.
const unsigned = (value) => (typeof value === "number" ? value >>> 0 : value);

// Makes a reader of the bytes of a Uint8Array or of a Blob. Only a worker can read a Blob at once.
function reader(content) {
  if (content instanceof Uint8Array) return { size: content.length, read: (at, count) => content.subarray(at, at + count) };
  let begin = 0, piece = new Uint8Array(0);
  return {
    size: content.size,
    read(at, count) {
      if (at < begin || at >= begin + piece.length) {
        begin = at;
        piece = new Uint8Array(new FileReaderSync().readAsArrayBuffer(content.slice(at, at + Math.max(count, PIECE))));
      }
      return piece.subarray(at - begin, at - begin + count);
    },
  };
}

export class Files {
  // For each folder's path, a Map from names to `true` for a folder, or to the reader of a file.
  #folders = new Map([["", new Map()]]);
  #open = new Map([[ROOT, { path: "" }]]); // the open files and folders by their descriptors
  #next = ROOT + 1;
  #memory = null;

  // Replaces all files. contents: { "folder/name": Uint8Array or Blob }.
  replace(contents) {
    this.#folders = new Map([["", new Map()]]);
    for (const [path, content] of Object.entries(contents)) {
      const parts = path.split("/");
      for (let n = 0; n < parts.length - 1; n++) {
        const above = parts.slice(0, n).join("/"), folder = parts.slice(0, n + 1).join("/");
        this.#folders.get(above).set(parts[n], true);
        if (!this.#folders.has(folder)) this.#folders.set(folder, new Map());
      }
      this.#folders.get(parts.slice(0, -1).join("/")).set(parts.at(-1), reader(content));
    }
  }

  // Finds the file or folder that lies at a path below the folder of a descriptor. Returns { path, entry }; entry is
  // `true` for a folder, the reader of a file, or undefined if there is neither.
  #find(descriptor, pointer, length) {
    const at = this.#open.get(descriptor), name = new TextDecoder().decode(this.#bytes(pointer, length).slice());
    const parts = [];
    for (const part of `${at?.path}/${name}`.split("/"))
      if (part === "..") parts.pop();
      else if (part !== "" && part !== ".") parts.push(part);
    const path = parts.join("/");
    if (parts.length === 0) return { path, entry: true };
    return { path, entry: this.#folders.get(parts.slice(0, -1).join("/"))?.get(parts.at(-1)) };
  }

  #bytes(pointer, length) { return new Uint8Array(this.#memory.buffer, pointer, length); }
  #view() { return new DataView(this.#memory.buffer); }

  #describe(entry, pointer) {
    this.#bytes(pointer, 64).fill(0);
    this.#view().setUint8(pointer + 16, entry === true ? FOLDER : REGULAR);
    this.#view().setBigUint64(pointer + 24, 1n, true);
    this.#view().setBigUint64(pointer + 32, BigInt(entry === true ? 0 : entry.size), true);
    return SUCCESS;
  }

  // Reads bytes from a place of a file into the buffers of a list. Returns the number of bytes.
  #scatter(file, list, count, at) {
    let done = 0;
    for (let n = 0; n < count; n++) {
      const pointer = this.#view().getUint32(list + 8 * n, true), length = this.#view().getUint32(list + 8 * n + 4, true);
      for (let filled = 0; filled < length;) {
        const piece = file.read(at + done, length - filled);
        if (piece.length === 0) return done;
        this.#bytes(pointer + filled, piece.length).set(piece);
        filled += piece.length;
        done += piece.length;
      }
    }
    return done;
  }

  #entry(descriptor) {
    const open = this.#open.get(descriptor);
    return open === undefined ? undefined : open.file ?? true;
  }

  // Makes the imports of the WebAssembly file. memory() returns the file's memory, which exists only after the file has
  // been loaded.
  imports(memory) {
    const calls = {
      environ_sizes_get: (count, bytes) => { this.#view().setUint32(count, 0, true); this.#view().setUint32(bytes, 0, true); return SUCCESS; },
      environ_get: () => SUCCESS,
      proc_exit: (code) => { throw new Error(`the library ended with ${code}`); },
      sched_yield: () => SUCCESS,
      random_get: (pointer, count) => { this.#bytes(pointer, count).set(crypto.getRandomValues(new Uint8Array(count))); return SUCCESS; },
      clock_time_get: (clock, precision, pointer) => {
        const milliseconds = clock === 0 ? Date.now() : performance.now();
        this.#view().setBigUint64(pointer, BigInt(Math.round(milliseconds * 1e6)), true);
        return SUCCESS;
      },
      fd_prestat_get: (descriptor, pointer) => {
        if (descriptor !== ROOT) return BAD_DESCRIPTOR;
        this.#view().setUint32(pointer, 0, true);
        this.#view().setUint32(pointer + 4, 1, true);
        return SUCCESS;
      },
      fd_prestat_dir_name: (descriptor, pointer) => { this.#view().setUint8(pointer, "/".charCodeAt(0)); return SUCCESS; },
      fd_fdstat_get: (descriptor, pointer) => {
        const entry = this.#entry(descriptor);
        if (entry === undefined) return BAD_DESCRIPTOR;
        this.#bytes(pointer, 24).fill(0);
        this.#view().setUint8(pointer, entry === true ? FOLDER : REGULAR);
        this.#bytes(pointer + 8, 16).fill(0xff); // the file has all rights
        return SUCCESS;
      },
      fd_filestat_get: (descriptor, pointer) => {
        const entry = this.#entry(descriptor);
        return entry === undefined ? BAD_DESCRIPTOR : this.#describe(entry, pointer);
      },
      path_filestat_get: (descriptor, flags, name, length, pointer) => {
        const { entry } = this.#find(descriptor, name, length);
        return entry === undefined ? NO_FILE : this.#describe(entry, pointer);
      },
      path_open: (descriptor, lookup, name, length, how, rights, inherited, flags, pointer) => {
        const { path, entry } = this.#find(descriptor, name, length);
        if (entry === undefined) return how & 1 ? READ_ONLY : NO_FILE;
        if ((how & 2) !== 0 && entry !== true) return NO_FOLDER;
        this.#open.set(this.#next, entry === true ? { path } : { path, file: entry, at: 0 });
        this.#view().setUint32(pointer, this.#next++, true);
        return SUCCESS;
      },
      fd_close: (descriptor) => (this.#open.delete(descriptor) ? SUCCESS : BAD_DESCRIPTOR),
      fd_read: (descriptor, list, count, pointer) => {
        const open = this.#open.get(descriptor);
        if (open === undefined) return BAD_DESCRIPTOR;
        if (open.file === undefined) return IS_FOLDER;
        const got = this.#scatter(open.file, list, count, open.at);
        open.at += got;
        this.#view().setUint32(pointer, got, true);
        return SUCCESS;
      },
      fd_pread: (descriptor, list, count, at, pointer) => {
        const file = this.#open.get(descriptor)?.file;
        if (file === undefined) return BAD_DESCRIPTOR;
        this.#view().setUint32(pointer, this.#scatter(file, list, count, Number(at)), true);
        return SUCCESS;
      },
      fd_seek: (descriptor, offset, from, pointer) => {
        const open = this.#open.get(descriptor);
        if (open?.file === undefined) return BAD_DESCRIPTOR;
        const at = Number(offset) + [0, open.at, open.file.size][from];
        if (!(at >= 0)) return INVALID;
        open.at = at;
        this.#view().setBigUint64(pointer, BigInt(at), true);
        return SUCCESS;
      },
      fd_readdir: (descriptor, pointer, length, cookie, used) => {
        const folder = this.#folders.get(this.#open.get(descriptor)?.path);
        if (folder === undefined) return NO_FOLDER;
        let at = 0;
        for (const [n, [name, entry]] of [...folder].entries()) {
          if (n < Number(cookie)) continue;
          const text = new TextEncoder().encode(name), record = new Uint8Array(24 + text.length), view = new DataView(record.buffer);
          view.setBigUint64(0, BigInt(n + 1), true);
          view.setUint32(16, text.length, true);
          view.setUint8(20, entry === true ? FOLDER : REGULAR);
          record.set(text, 24);
          const some = record.subarray(0, length - at);
          this.#bytes(pointer + at, some.length).set(some);
          at += some.length;
          if (at === length) break;
        }
        this.#view().setUint32(used, at, true);
        return SUCCESS;
      },
      poll_oneoff: (subscriptions, events, count, pointer) => { // every event of the list has occurred already
        for (let n = 0; n < count; n++) {
          const from = subscriptions + 48 * n, to = events + 32 * n;
          this.#bytes(to, 32).fill(0);
          this.#view().setBigUint64(to, this.#view().getBigUint64(from, true), true);
          this.#view().setUint8(to + 10, this.#view().getUint8(from + 8));
        }
        this.#view().setUint32(pointer, count, true);
        return SUCCESS;
      },
    };
    return new Proxy({}, {
      get: (_, name) => (...values) => {
        this.#memory = memory();
        return calls[name]?.(...values.map(unsigned)) ?? NO_CALL;
      },
    });
  }
}
