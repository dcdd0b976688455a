#!/usr/bin/env python3
"""Stores of OME-Zarr on a server: the same pictures as of the store's folder, few bytes, and no picture where a server
fails.

usage: servers.py PROGRAM        (prints TAP)

The server runs in this process. It counts what it sends, and fails on request.
"""
import functools
import http.server
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import threading
import zlib

CHUNK = 16
LEVELS = 3


# ---- the store ----

def value(n, i, j, k):
    """A ball of radius .4 in the unit cube, brightest in its middle: of a level of n voxels an edge."""
    distance = sum(((c + 0.5) / n - 0.5) ** 2 for c in (i, j, k)) ** 0.5
    return int(max(0, 250 * (1 - distance / 0.4)))


def chunk_bytes(n, place):
    z, y, x = (c * CHUNK for c in place)
    return bytes(value(n, x + i, y + j, z + k) for k in range(CHUNK) for j in range(CHUNK) for i in range(CHUNK))


def levels_text(levels):
    scales = [{"path": str(level), "coordinateTransformations": [
        {"type": "scale", "scale": [2.0 ** level] * 3},
        {"type": "translation", "translation": [(2 ** level - 1) / 2] * 3}]} for level in range(levels)]
    return [{"axes": [{"name": name, "type": "space"} for name in "zyx"], "datasets": scales}]


def write_level(folder, n, version):
    folder.mkdir(parents=True)
    if version == 2:
        text = {"zarr_format": 2, "shape": [n] * 3, "chunks": [CHUNK] * 3, "dtype": "|u1", "order": "C", "filters": None,
                "compressor": {"id": "zlib", "level": 1}, "fill_value": 0, "dimension_separator": "/"}
        (folder / ".zarray").write_text(json.dumps(text))
    else:
        text = {"zarr_format": 3, "node_type": "array", "shape": [n] * 3, "data_type": "uint8", "fill_value": 0,
                "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [CHUNK] * 3}},
                "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}},
                "codecs": [{"name": "bytes"}]}
        (folder / "zarr.json").write_text(json.dumps(text))
    for z in range(n // CHUNK):
        for y in range(n // CHUNK):
            for x in range(n // CHUNK):
                data = chunk_bytes(n, (z, y, x))
                if not any(data):
                    continue  # absent: the fill value
                path = folder / ("" if version == 2 else "c") / str(z) / str(y) / str(x)
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(zlib.compress(data, 1) if version == 2 else data)


def write_store(folder, version):
    folder.mkdir(parents=True)
    if version == 2:
        (folder / ".zgroup").write_text('{"zarr_format": 2}')
        (folder / ".zattrs").write_text(json.dumps({"multiscales": levels_text(LEVELS)}))
    else:
        attributes = {"ome": {"version": "0.5", "multiscales": levels_text(LEVELS)}}
        (folder / "zarr.json").write_text(json.dumps({"zarr_format": 3, "node_type": "group", "attributes": attributes}))
    for level in range(LEVELS):
        write_level(folder / str(level), 64 >> level, version)


def crc32c(data):
    """The CRC32C of RFC 3720, bit by bit."""
    rest = 0xffffffff
    for byte in data:
        rest ^= byte
        for _ in range(8):
            rest = rest >> 1 ^ (0x82f63b78 if rest & 1 else 0)
    return rest ^ 0xffffffff


SHARDED, SHARDED_SIDE = "sharded.zarr", 32


def write_sharded(folder, index_location="end"):
    """An image of two channels, in two shards that hold chunks of both channels: first those of channel 0."""
    n, inner = SHARDED_SIDE, SHARDED_SIDE // CHUNK
    folder.joinpath("0").mkdir(parents=True)
    scale = [{"type": "scale", "scale": [1.0] * 4}]
    multiscales = [{"axes": [{"name": "c", "type": "channel"}] + [{"name": name, "type": "space"} for name in "zyx"],
                    "datasets": [{"path": "0", "coordinateTransformations": scale}]}]
    (folder / "zarr.json").write_text(json.dumps({"zarr_format": 3, "node_type": "group", "attributes": {
        "ome": {"version": "0.5", "multiscales": multiscales}}}))
    codec = {"name": "sharding_indexed", "configuration": {
        "chunk_shape": [1] + [CHUNK] * 3, "codecs": [{"name": "bytes"}], "index_location": index_location,
        "index_codecs": [{"name": "bytes", "configuration": {"endian": "little"}}, {"name": "crc32c"}]}}
    (folder / "0/zarr.json").write_text(json.dumps({
        "zarr_format": 3, "node_type": "array", "shape": [2] + [n] * 3, "data_type": "uint8", "fill_value": 0,
        "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [2, CHUNK] + [n] * 2}},
        "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}}, "codecs": [codec]}))
    for z in range(inner):
        index, data, index_bytes = b"", b"", 16 * 2 * inner * inner + 4
        for channel in range(2):
            for y in range(inner):
                for x in range(inner):
                    chunk = chunk_bytes(n, (z, y, x))[::-1 if channel == 1 else 1]
                    place = len(data) + (index_bytes if index_location == "start" else 0)
                    index += place.to_bytes(8, "little") + len(chunk).to_bytes(8, "little")
                    data += chunk
        index += crc32c(index).to_bytes(4, "little")
        shard = folder / f"0/c/0/{z}/0/0"
        shard.parent.mkdir(parents=True)
        shard.write_bytes(index + data if index_location == "start" else data + index)


# ---- the server ----

class Listener(http.server.ThreadingHTTPServer):
    daemon_threads = True
    request_queue_size = 128  # of connections that wait. Of five, the usual number, a client that opens sixteen waits a second to be let in


class Server:
    """Serves a folder. faults: by path, a list of faults, one for each request, of which "always" repeats the next. sends_ranges:
    whether a part of a file is sent where one is asked for."""

    def __init__(self, folder):
        self.folder, self.faults, self.key, self.sends_ranges = folder, {}, None, False
        self.sent, self.requests, self.answers, self.lock = 0, [], [], threading.Lock()
        self.hold = None  # called with the name of each file before it is sent
        self.released = threading.Event()
        self.http = Listener(("127.0.0.1", 0), functools.partial(Handler, self))
        threading.Thread(target=self.http.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self.http.server_address[1]}"

    def forget(self, **faults):
        self.sent, self.requests, self.answers, self.key = 0, [], [], None
        self.faults = {name.replace("__", "/"): list(kinds) for name, kinds in faults.items()}

    def fault(self, path):
        kinds = self.faults.get(path, [])
        if not kinds:
            return None
        return kinds[1] if kinds[0] == "always" else kinds.pop(0)


class Handler(http.server.BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"

    def __init__(self, server, *rest):
        self.store = server
        super().__init__(*rest)

    def log_message(self, *_):
        pass

    def answer(self, code, body=b"", headers=(), length=None):
        with self.store.lock:
            self.store.sent += len(body)
            self.store.answers.append(code)
        self.send_response(code)
        for name, text in headers:
            self.send_header(name, text)
        self.send_header("Content-Length", str(len(body) if length is None else length))
        self.end_headers()
        self.wfile.write(body)

    def do_GET(self):
        path, _, query = self.path.partition("?")
        name = path.lstrip("/")
        with self.store.lock:
            self.store.requests.append(name)
            fault = self.store.fault(name)
        if self.store.hold is not None:
            self.store.hold(name)
        file = self.store.folder / name.removeprefix("moved/")
        body = file.read_bytes() if file.is_file() else b""
        if self.store.key is not None and query != self.store.key:
            return self.answer(403, b"no")
        if fault is None and not file.is_file():
            return self.answer(404, b"<html>no such file</html>")
        if fault is None:
            tag = f'"{zlib.crc32(body)}"'
            if self.headers.get("If-None-Match") == tag:
                return self.answer(304)
            if self.store.sends_ranges and self.headers.get("Range"):
                return self.part(body, tag)
            return self.answer(200, body, [("ETag", tag)])
        return getattr(self, "fault_" + fault)(body)

    def place(self, body):
        """The first and the last byte of "Range", which names one range."""
        first, last = self.headers["Range"].removeprefix("bytes=").split("-")
        if first == "":
            return max(0, len(body) - int(last)), len(body) - 1
        return int(first), min(int(last), len(body) - 1)

    def part(self, body, tag, shift=0, cut=0, headers=None):
        first, last = self.place(body)
        told = [("Content-Range", f"bytes {first + shift}-{last + shift}/{len(body)}")] if headers is None else headers
        self.answer(206, body[first:last + 1 - cut], [("ETag", tag), *told])

    def fault_500(self, body):
        self.answer(500, b"<html>trouble</html>")

    def fault_403(self, body):
        self.answer(403, b"<html>forbidden</html>")

    def fault_moved(self, body):
        self.answer(307, b"", [("Location", f"/moved/{self.path.lstrip('/')}")])

    def fault_elsewhere(self, body):
        self.answer(302, b"", [("Location", f"http://{self.store.other}{self.path}?secret=1")])

    def fault_file(self, body):
        self.answer(301, b"", [("Location", f"file://{self.store.folder}{self.path}")])

    def fault_404(self, body):
        self.answer(404, b"<html>none</html>")

    def fault_cut(self, body):
        self.answer(200, body[:len(body) // 2], length=len(body))
        self.close_connection = True

    def fault_page(self, body):
        self.answer(200, b"<html>please sign in</html>")

    def fault_half(self, body):
        """Half of the file, which the server says is the whole."""
        self.answer(200, body[:len(body) // 2])

    def fault_flipped(self, body):
        """The file with one wrong bit in its middle."""
        middle = len(body) // 2
        self.answer(200, body[:middle] + bytes([body[middle] ^ 1]) + body[middle + 1:])

    def fault_shifted(self, body):
        """Another part of the file than the one that was asked for."""
        self.part(body, '"1"', shift=-1)

    def fault_bare(self, body):
        """A part, without a word of which."""
        self.part(body, '"1"', headers=())

    def fault_short(self, body):
        """Fewer bytes than the header tells."""
        self.part(body, '"1"', cut=1)

    def fault_416(self, body):
        self.answer(416, b"", [("Content-Range", f"bytes */{len(body)}")])

    def fault_noise(self, body):
        """Wrong bytes in the right place."""
        self.part(bytes(byte ^ 1 for byte in body), f'"{zlib.crc32(body)}"')

    def fault_new(self, body):
        """The part of a file that has just been written anew."""
        self.part(body, '"new"')

    def fault_stall(self, body):
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body[:1])
        self.wfile.flush()
        self.store.released.wait()
        self.close_connection = True

    def fault_endless(self, body):
        self.send_response(200)
        self.send_header("Connection", "close")
        self.end_headers()
        try:
            while True:
                self.wfile.write(bytes(1 << 16))
        except OSError:
            self.close_connection = True


# ---- the program ----

class Case:
    def __init__(self, program, folder):
        self.program, self.folder, self.number, self.failed = program, pathlib.Path(folder), 0, False
        self.cache = self.folder / "cache"
        self.environment = {**os.environ, "XDG_CACHE_HOME": str(self.cache), "no_proxy": "127.0.0.1"}
        self.environment.pop("http_proxy", None)

    def run(self, *words, **environment):
        return subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, cwd=self.folder,
                              env={**self.environment, **environment})

    def picture(self, store, *words, **environment):
        """(the picture's bytes or None, standard error)"""
        out = self.folder / "out.npy"
        out.unlink(missing_ok=True)
        done = self.run("render", store, "-o", out, "--size", "32x32", "--quiet", *words, **environment)
        return (out.read_bytes() if out.exists() else None) if done.returncode == 0 else None, done.stderr

    def fresh(self):
        shutil.rmtree(self.cache, ignore_errors=True)
        self.cache.mkdir()

    def ok(self, name, passed, said=""):
        self.number += 1
        self.failed |= not passed
        print(f"{'ok' if passed else 'not ok'} {self.number} - {name}")
        if not passed:
            print(f"# {said!r}")

    def refused(self, name, server, store, words, *options, **environment):
        """The program makes no picture, and says why in one line."""
        picture, said = self.picture(store, *options, **environment)
        out = self.folder / "out.npy"
        self.ok(name, picture is None and not out.exists() and said.count("\n") == 1 and words in said,
                (said, server.requests[-4:]))


def level_bytes(folder, level):
    return sum(path.stat().st_size for path in (folder / str(level)).rglob("*") if path.is_file())


def sound_servers(case, server, version):
    folder, store = server.folder / f"v{version}.zarr", f"{server.url}/v{version}.zarr"
    right, said = case.picture(folder)
    case.fresh()
    server.forget()
    picture, said = case.picture(store)
    case.ok(f"version {version}: the picture of the folder", picture is not None and picture == right, said)
    chunks = [name for name in server.requests if name.split("/")[-1].isdigit()]
    case.ok(f"version {version}: no chunk of another level than the picture's",
            bool(chunks) and all(name.startswith(f"v{version}.zarr/1/") for name in chunks), chunks)
    needed = level_bytes(folder, 1)
    case.ok(f"version {version}: at most 3 times the level's bytes", server.sent <= 3 * needed, (server.sent, needed))
    server.forget()
    picture, said = case.picture(store + "/")
    bodies = server.answers.count(200)
    case.ok(f"version {version}: nothing is sent twice", picture == right and bodies == 0, (said, server.answers))


def changed_files(case, server):
    """Not of the cache alone: the server is asked whether its files have changed."""
    folder, store = server.folder / "v2.zarr", f"{server.url}/v2.zarr"
    chunk = folder / "1/0/1/1"
    before, right = chunk.read_bytes(), case.picture(folder)[0]
    chunk.write_bytes(zlib.compress(bytes(reversed(zlib.decompress(before))), 1))
    changed = case.picture(folder)[0]
    case.ok("a changed chunk is fetched anew", changed != right and case.picture(store)[0] == changed)
    chunk.unlink()
    absent = case.picture(folder)[0]
    case.ok("a chunk that is gone is the fill value", absent not in (right, changed) and case.picture(store)[0] == absent)
    said = case.run("render", store, "-o", case.folder / "out.npy", "--size", "32x32").stderr
    case.ok("and the program says so", "the server has no file for 1 of 8 chunks" in said, said)
    chunk.write_bytes(before)
    copies = sorted((case.cache / "halflight/servers").iterdir())
    for copy in copies:
        copy.write_bytes(copy.read_bytes()[:-1])
    case.ok("copies that are cut short are not used", bool(copies) and case.picture(store)[0] == right)


def passing_faults(case, server):
    store = f"{server.url}/v2.zarr"
    right = case.picture(server.folder / "v2.zarr")[0]
    for fault, kinds in (("500", ["500", "500"]), ("cut", ["cut"]), ("stall", ["stall"])):
        case.fresh()
        server.forget(**{"v2.zarr__1__0__1__1": kinds, "v2.zarr__.zattrs": ["500"]})
        picture, said = case.picture(store)
        case.ok(f"{fault}, then the file: the right picture", picture == right,
                (said, server.requests.count("v2.zarr/1/0/1/1")))
    server.released.set()


def lasting_faults(case, server):
    for version, chunk, fault, words in (
            (2, "1__0__1__1", "500", "/v2.zarr/1/0/1/1: the server answers 500, also when asked again"),
            (2, "1__0__1__1", "cut", "/v2.zarr/1/0/1/1: it does not arrive, after 4 tries: "),
            (2, "1__0__1__1", "403", "/v2.zarr/1/0/1/1: the server answers 403: it wants a permission"),
            (2, "1__0__1__1", "page", "a chunk does not unpack"),
            (2, "1__0__1__1", "half", "a chunk does not unpack"),
            (2, "1__0__1__1", "flipped", "a chunk does not unpack"),
            (3, "1__c__0__1__1", "page", "a chunk of 27 bytes, its voxels have 4096"),
            (3, "1__c__0__1__1", "endless", "/v3.zarr/1/c/0/1/1: "),
            (2, "1__.zarray", "404", "there is no array, which a level names"),
            (2, ".zattrs", "page", ".zattrs, line 1"),
            (2, ".zattrs", "endless", "/v2.zarr/.zattrs: ")):
        case.fresh()
        server.forget(**{f"v{version}.zarr__{chunk}": ["always", fault]})
        case.refused(f"{fault} of {chunk.replace('__', '/')}: refused", server, f"{server.url}/v{version}.zarr", words)


def sharded(case, server):
    """Of shards that hold more than what is read, the index and the chunks that are read are fetched, and no more."""
    shards = [f"{SHARDED}/0/c/0/{z}/0/0" for z in range(SHARDED_SIDE // CHUNK)]
    folder, store = server.folder / SHARDED, f"{server.url}/{SHARDED}"
    whole = sum((server.folder / name).stat().st_size for name in shards)
    channel = ("--channel", 1)
    for location in ("start", "end"):
        shutil.rmtree(folder, ignore_errors=True)
        write_sharded(folder, location)
        right = case.picture(folder, *channel)[0]
        case.fresh()
        server.forget()
        server.sends_ranges = True
        picture, said = case.picture(store, *channel)
        case.ok(f"index at the {location}: the picture of the folder", picture is not None and picture == right and
                right != case.picture(folder)[0], said)
        parts = server.answers.count(206)
        case.ok(f"index at the {location}: an index and one part of each shard", parts == 2 * len(shards) and
                server.sent < whole / 2 + 8192, (server.answers, server.sent, whole))
        server.forget()
        picture, said = case.picture(store, *channel)
        case.ok(f"index at the {location}: no part is sent twice", picture == right and
                set(server.answers) <= {304, 404}, (said, server.answers))
        case.fresh()
        server.forget()
        server.sends_ranges = False
        picture, said = case.picture(store, *channel)
        sent = [server.requests.count(name) for name in shards]
        case.ok(f"index at the {location}: a server without ranges sends each shard once", picture == right and
                sent == [1] * len(shards), (said, sent))
    server.sends_ranges = True
    name = shards[0].replace("/", "__")
    for fault in ("500", "cut"):
        case.fresh()
        server.forget(**{name: [fault]})
        picture, said = case.picture(store, *channel)
        case.ok(f"a shard's {fault}, then the part: the right picture", picture == right, said)
    other = "the server sends other bytes than the part that it was asked for"
    changed = "the server's file has changed while it was read"
    for fault, kinds, words in (
            ("shifted index", ["shifted"], other), ("index of no place", ["bare"], other), ("short index", ["short"], other),
            ("416", ["416"], "the server answers 416"), ("damaged index", ["noise"], "the index of a shard is damaged"),
            ("shifted chunks", [None, "shifted"], other), ("short chunks", [None, "short"], other),
            ("shard that changes", [None, "new"], changed), ("shard that vanishes", [None, "404"], changed)):
        case.fresh()
        server.forget(**{name: kinds})
        case.refused(f"{fault}: refused", server, store, words, *channel)
    (server.folder / shards[0]).unlink()
    case.fresh()
    server.forget()
    absent = case.picture(folder, *channel)[0]
    case.ok("an absent shard is the fill value", absent not in (None, right) and case.picture(store, *channel)[0] == absent)
    server.sends_ranges = False


def who_is_asked(case, server):
    folder, store = server.folder / "v2.zarr", f"{server.url}/v2.zarr"
    case.fresh()
    scene = case.folder / "scene.json"
    scene.write_text(json.dumps({"halflight": 1, "volumes": [{"file": store}]}))
    server.forget()
    case.refused("a URL in a scene: refused", server, scene, "servers are asked for INPUTs of the command line alone")
    case.ok("a URL in a scene: no server is asked", server.requests == [], server.requests)
    done = case.run("render", store, "-o", case.folder / "out.png", "--size", "32x32", "--quiet")
    case.ok("a picture of a URL", done.returncode == 0 and done.stderr == "", done.stderr)
    server.forget()
    case.refused("a URL in a picture's scene: refused", server, case.folder / "out.png", "servers are asked for INPUTs")
    server.forget()
    server.key = "key=a%20b"
    case.refused("without the key: refused", server, store, "the server answers 403")
    right = case.picture(folder)[0]
    picture, said = case.picture(store + "?key=a%20b")
    case.ok("a URL's query goes with every request", picture == right, said)
    server.forget()
    case.refused("no store there: refused", server, server.url + "/none", "the server has no Zarr store there")
    for name in ("none.nrrd", "none.vtu", "none.ply"):  # single files, also of names that meshes have
        case.refused(f"{name}: refused", server, f"{server.url}/{name}", "the server has no Zarr store there: download other files")
        done = case.run("info", f"{server.url}/{name}")
        case.ok(f"info of {name}: refused", done.returncode != 0 and "the server has no Zarr store there: download other files" in done.stderr,
                (done.stdout, done.stderr))
    case.refused("no server there: refused", server, "http://127.0.0.1:9/v2.zarr", "it does not arrive, after 4 tries")
    case.refused("no curl: refused", server, store, "there is no program curl", PATH=str(case.folder))
    done = case.run("info", "--json", store)
    found = json.loads(done.stdout or "{}")
    case.ok("info of a URL", found.get("levels") == 3 and found.get("file") == store, (done.stdout, done.stderr))


def redirected(case, server):
    """A server may redirect to URLs of its own, and to no other server."""
    folder, store, chunk = server.folder / "v2.zarr", f"{server.url}/v2.zarr", "1/0/1/1"
    right = case.picture(folder)[0]
    case.fresh()
    server.forget(**{f"v2.zarr/{chunk}": ["500", "moved"], "v2.zarr/.zattrs": ["moved"]})
    picture, said = case.picture(store)
    case.ok("redirected to the same server: the same picture", picture == right and f"moved/v2.zarr/{chunk}" in server.requests, said)
    case.fresh()
    server.forget(**{f"{'moved/' * n}v2.zarr/{chunk}": ["always", "moved"] for n in range(9)})
    case.refused("redirected without end: refused", server, store, f"/v2.zarr/{chunk}: the server redirects more than 5 times")
    other = Server(server.folder)
    port = other.url.rsplit(":", 1)[1]
    for kind, place in (("elsewhere", f"127.0.0.1:{port}"), ("elsewhere", f"localhost:{port}"), ("elsewhere", f"{server.url[7:]}@localhost:{port}"),
                        ("file", "")):
        case.fresh()
        server.other = place
        server.forget(**{f"v2.zarr/{chunk}": ["always", kind]})
        case.refused(f"redirected to {place or 'a file'}: refused", server, store, f"/v2.zarr/{chunk}: the server redirects to ")
        case.ok("without the query, which may be a secret", "secret" not in case.picture(store)[1])
    case.ok("no other server was asked", other.requests == [], other.requests)


def new_home(case, server):
    """The folder of copies is made with the folders above it."""
    home = case.folder / "new home"
    home.mkdir()
    server.forget()
    picture, said = case.picture(f"{server.url}/v2.zarr", XDG_CACHE_HOME="", HOME=str(home))
    copies = home / ".cache/halflight/servers"
    case.ok("a home without a folder .cache", picture is not None and copies.is_dir(), said)
    case.ok("the folder is private", copies.is_dir() and (home / ".cache").stat().st_mode & 0o77 == 0)


def viewer(case, server):
    """The viewer opens a URL of its command line, and fails like `render` where the server does."""
    case.fresh()
    server.forget()
    words = [case.program, "view", "--no-browser", "--quiet", f"{server.url}/v2.zarr"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=case.environment,
                          cwd=case.folder) as process:
        line = process.stdout.readline()
        process.terminate()
        said = process.communicate()[1]
    chunks = [name for name in server.requests if name.split("/")[-1].isdigit()]
    case.ok("the viewer opens a URL", line.startswith("http://127.0.0.1:") and bool(chunks), (line, said, server.requests))
    case.fresh()
    server.forget(**{"v2.zarr__.zattrs": ["always", "403"]})
    done = subprocess.run(words, capture_output=True, text=True, env=case.environment, cwd=case.folder)
    case.ok("the viewer of a URL that a server refuses ends", done.returncode != 0 and done.stdout == "" and
            "the server answers 403" in done.stderr, (done.stdout, done.stderr))


def main():
    with tempfile.TemporaryDirectory() as folder:
        case = Case(os.path.abspath(sys.argv[1]), folder)
        if shutil.which("curl") is None:
            print("1..0 # SKIP there is no curl")
            return 0
        stores = pathlib.Path(folder, "stores")
        for version in (2, 3):
            write_store(stores / f"v{version}.zarr", version)
        write_sharded(stores / SHARDED)
        server = Server(stores)
        for version in (2, 3):
            sound_servers(case, server, version)
        sharded(case, server)
        changed_files(case, server)
        passing_faults(case, server)
        lasting_faults(case, server)
        who_is_asked(case, server)
        redirected(case, server)
        new_home(case, server)
        viewer(case, server)
        print(f"1..{case.number}")
        return 1 if case.failed else 0


if __name__ == "__main__":
    sys.exit(main())
