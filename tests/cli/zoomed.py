#!/usr/bin/env python3
"""Pictures of a part of a pyramid: the chunks that the picture sees are fetched, and the picture is that of all chunks.

usage: zoomed.py PROGRAM        (prints TAP)
"""
import array
import json
import os
import pathlib
import random
import shutil
import sys
import tempfile
import zlib

import servers

STORE, SHARDED, FIRST, SECOND, TIMES, CHANNELS, LEVEL_CHUNKS = "v2.zarr", "v3.zarr", "first.zarr", "second.zarr", "times.zarr", "channels.zarr", 64
ZOOM = ("--zoom", 4)


def write_store(folder):
    """As servers.py writes it, but with noise, so that no level follows from another one."""
    servers.write_store(folder, 2)
    for level in range(servers.LEVELS):
        for path in sorted((folder / str(level)).rglob("*")):
            if path.is_file() and path.name != ".zarray":
                voxels = bytearray(zlib.decompress(path.read_bytes()))
                state = zlib.crc32(str(path.relative_to(folder)).encode())
                for n, voxel in enumerate(voxels):
                    state = (1664525 * state + 1013904223) % 2**32
                    voxels[n] = max(0, min(255, voxel + (state >> 27) - 16)) if voxel else 0
                path.write_bytes(zlib.compress(bytes(voxels), 1))


def write_sharded(folder):
    """The same pyramid, in Zarr 3: each level is one shard."""
    folder.mkdir(parents=True)
    attributes = {"ome": {"version": "0.5", "multiscales": servers.levels_text(servers.LEVELS)}}
    (folder / "zarr.json").write_text(json.dumps({"zarr_format": 3, "node_type": "group", "attributes": attributes}))
    for level in range(servers.LEVELS):
        n = 64 >> level
        codec = {"name": "sharding_indexed", "configuration": {
            "chunk_shape": [servers.CHUNK] * 3, "codecs": [{"name": "bytes"}], "index_location": "end",
            "index_codecs": [{"name": "bytes", "configuration": {"endian": "little"}}, {"name": "crc32c"}]}}
        array = folder / str(level)
        (array / "c/0/0").mkdir(parents=True)
        (array / "zarr.json").write_text(json.dumps({
            "zarr_format": 3, "node_type": "array", "shape": [n] * 3, "data_type": "uint8", "fill_value": 0,
            "chunk_grid": {"name": "regular", "configuration": {"chunk_shape": [n] * 3}},
            "chunk_key_encoding": {"name": "default", "configuration": {"separator": "/"}}, "codecs": [codec]}))
        side = range(n // servers.CHUNK)
        chunks = [servers.chunk_bytes(n, (z, y, x)) for z in side for y in side for x in side]
        index = b"".join((number * len(chunk)).to_bytes(8, "little") + len(chunk).to_bytes(8, "little")
                         for number, chunk in enumerate(chunks))
        (array / "c/0/0/0").write_bytes(b"".join(chunks) + index + servers.crc32c(index).to_bytes(4, "little"))


def write_several(of, folder, axis):
    """The pyramid twice, along an axis of its own: t or c."""
    shutil.copytree(of, folder)
    text = json.loads((folder / ".zattrs").read_text())
    text["multiscales"][0]["axes"].insert(0, {"name": axis, "type": {"t": "time", "c": "channel"}[axis]})
    for level in text["multiscales"][0]["datasets"]:
        for change in level["coordinateTransformations"]:
            change[change["type"]].insert(0, 1 if change["type"] == "scale" else 0)
    (folder / ".zattrs").write_text(json.dumps(text))
    for level in range(servers.LEVELS):
        array = json.loads((folder / str(level) / ".zarray").read_text())
        array["shape"].insert(0, 2)
        array["chunks"].insert(0, 1)
        (folder / str(level) / ".zarray").write_text(json.dumps(array))
        slices = sorted(path for path in (folder / str(level)).iterdir() if path.is_dir())
        (folder / str(level) / "moved").mkdir()
        for path in slices:
            path.rename(folder / str(level) / "moved" / path.name)
        (folder / str(level) / "moved").rename(folder / str(level) / "0")
        shutil.copytree(folder / str(level) / "0", folder / str(level) / "1")


def write_small_chunks(stores):
    """Two pyramids of smaller chunks, one that moves, and one of two channels."""
    servers.CHUNK //= 2
    write_store(stores / FIRST)
    write_store(stores / SECOND)
    servers.CHUNK *= 2
    write_several(stores / FIRST, stores / TIMES, "t")
    write_several(stores / FIRST, stores / CHANNELS, "c")


def finest_alone(store):
    """A store of the finest level alone, which is read whole."""
    alone = store.with_suffix(".alone")
    if not alone.exists():
        shutil.copytree(store, alone)
        for name in (".zattrs", "zarr.json"):
            if (alone / name).exists():
                text = json.loads((alone / name).read_text())
                for image in (text if name == ".zattrs" else text["attributes"]["ome"])["multiscales"]:
                    image["datasets"] = image["datasets"][:1]
                (alone / name).write_text(json.dumps(text))
    return alone


def of_all_chunks(case, text):
    """The scene file of a scene's text whose volumes' finest levels are read whole."""
    scene = json.loads(text)
    for volume in scene["volumes"]:
        volume["file"] = str(finest_alone(pathlib.Path(case.folder, volume["file"])))
        assert volume.pop("level") == 0
    file = case.folder / "whole.json"
    file.write_text(json.dumps(scene))
    return file


def whole_picture(case, store, *words):
    """The picture of the same scene, with its camera and look, for which all chunks are read."""
    done = case.run("render", store, "--size", "32x32", "--quiet", "--print-scene", *words)
    return case.picture(of_all_chunks(case, done.stdout))[0]


def levels_asked(server):
    found = {}
    for name in server.requests:
        parts = name.split("/")
        if parts[-1].isdigit():
            found.setdefault(parts[1], set()).add(name)
    return found


def parts(case, server):
    folder, store = server.folder / STORE, f"{server.url}/{STORE}"
    for shadows in ("off", "soft"):
        words = (*ZOOM, "--shadows", shadows)
        case.fresh()
        server.forget()
        picture, said = case.picture(store, *words)
        asked = levels_asked(server)
        case.ok(f"shadows {shadows}: the picture of the folder", picture is not None and picture == case.picture(folder, *words)[0], said)
        case.ok(f"shadows {shadows}: chunks of the first level and a part of the finest one", sorted(asked) == ["0", "1"] and
                0 < len(asked["0"]) < LEVEL_CHUNKS * 2 // 3, {level: len(names) for level, names in asked.items()})
        whole = whole_picture(case, folder, *words)
        case.ok(f"shadows {shadows}: {'the bytes' if shadows == 'off' else 'within .002'} of the picture of all chunks",
                whole == picture if shadows == "off" else 0 < greatest_difference(whole, picture) < 2e-3 or whole == picture,
                greatest_difference(whole, picture))
    done = case.run("render", store, "-o", case.folder / "out.npy", "--size", "32x32", *ZOOM)
    case.ok("the program says so", f"of {LEVEL_CHUNKS} chunks (array \"0/\") lie out of sight, and are taken from a coarser level" in
            done.stderr, done.stderr)
    return asked["0"]


def shards(case, server):
    """Of a shard the chunks that are seen are fetched."""
    folder, store = server.folder / SHARDED, f"{server.url}/{SHARDED}"
    words = (*ZOOM, "--shadows", "off")
    case.fresh()
    server.forget()
    server.sends_ranges = True
    picture, said = case.picture(store, *words)
    sizes = [(folder / str(level) / "c/0/0/0").stat().st_size for level in (0, 1)]
    case.ok("a part of a shard is fetched", sizes[1] < server.sent < sizes[1] + sizes[0] * 3 / 4, (server.sent, sizes))
    case.ok("shards: the bytes of the picture of all chunks", picture is not None and picture == whole_picture(case, folder, *words), said)
    server.sends_ranges = False


def faults(case, server, seen):
    """A chunk out of sight is not asked for, and one that is seen must be right."""
    store = f"{server.url}/{STORE}"
    right = case.picture(store, *ZOOM)[0]
    every = {f"{STORE}/0/{z}/{y}/{x}" for z in range(4) for y in range(4) for x in range(4)}
    case.fresh()
    server.forget(**{name.replace("/", "__"): ["always", "403"] for name in every - seen})
    picture, said = case.picture(store, *ZOOM)
    case.ok("faults out of sight change nothing", picture is not None and picture == right, said)
    there = sorted(name for name in seen if (server.folder / name).exists())[0]
    for fault, words in (("403", "the server answers 403"), ("half", "a chunk does not unpack")):
        case.fresh()
        server.forget(**{there.replace("/", "__"): ["always", fault]})
        case.refused(f"{fault} of a chunk that is seen: refused", server, store, words, *ZOOM)


def read_once(case, server):
    """What is asked for is read as it was asked for."""
    store = f"{server.url}/{STORE}"
    for words in (("--zoom", 1), (*ZOOM, "--level", 0), (*ZOOM, "--slice", "z=0.5")):
        case.fresh()
        server.forget()
        picture, said = case.picture(store, *words)
        asked = levels_asked(server)
        case.ok(f"{' '.join(map(str, words))}: one level, and all of it", picture is not None and len(asked) == 1 and
                len(next(iter(asked.values()))) in (LEVEL_CHUNKS, LEVEL_CHUNKS // 8), (said, asked.keys()))


def write_beam(folder):
    """A beam of noise, 1024 voxels long, at two resolutions, of which none follows from the other one."""
    noise = random.Random(1)
    folder.mkdir()
    (folder / ".zgroup").write_text('{"zarr_format": 2}')
    (folder / ".zattrs").write_text(json.dumps({"multiscales": servers.levels_text(2)}))
    for level in range(2):
        side = 16 >> level
        text = {"zarr_format": 2, "shape": [side, side, 1024 >> level], "chunks": [side] * 3, "dtype": "|u1", "order": "C", "filters": None,
                "compressor": {"id": "zlib", "level": 1}, "fill_value": 0, "dimension_separator": "/"}
        (folder / str(level) / "0/0").mkdir(parents=True)
        (folder / str(level) / ".zarray").write_text(json.dumps(text))
        for x in range(64):
            (folder / str(level) / "0/0" / str(x)).write_bytes(zlib.compress(noise.randbytes(side**3), 1))


BEAM = {"halflight": 1, "image": {"width": 32, "height": 32}, "render": {"shadows": "off"}, "volumes": [{
            "file": "", "level": 0, "transfer_function": {"opacity": [[0, 0], [255, 0.1]], "color": [[0, 1, 0, 0], [255, 0, 0, 1]]}}],
        "camera": {"type": "orthographic", "position": [500, -90, 60], "target": [512, 8, 8], "up": [0, 0, 1], "height": 64}}


def scenes(case, folder):
    """A scene file reads what its camera sees of the level that it names. Chunks out of sight may be anything."""
    damaged, file = folder.with_name("damaged.zarr"), case.folder / "scene.json"
    write_beam(folder)

    def picture(store, *words, **change):
        scene = json.loads(json.dumps({**BEAM, **change}))
        scene["volumes"][0]["file"] = str(store)
        file.write_text(json.dumps({key: value for key, value in scene.items() if value is not None}))
        return case.picture(file, *words)

    right = case.picture(of_all_chunks(case, json.dumps({**BEAM, "volumes": [{**BEAM["volumes"][0], "file": str(folder)}]})))[0]
    case.ok("a scene file: the picture of all chunks", right is not None and picture(folder)[0] == right)
    shutil.copytree(folder, damaged)
    for x in (*range(24), *range(40, 64)):
        (damaged / "0/0/0" / str(x)).write_bytes(b"damaged")
    made, said = picture(damaged)
    case.ok("a scene file: chunks out of sight are not read", made == right, said)
    made, said = picture(damaged, "--shadows", "soft")
    case.ok("a scene file: other shadows, the same voxels", made is not None and made != right, said)
    film = case.folder / "film"
    film.mkdir()
    done = case.run("animate", file, "--key", "camera.height=0:64,1:66", "--frames", 2, "-o", film)
    case.ok("a film of a scene file: what its frames see", done.returncode == 0 and len(list(film.iterdir())) == 2, done.stderr)
    done = case.run("animate", file, "--key", "camera.height=0:64,1:2000", "--frames", 2, "-o", film)
    case.ok("a film that sees more reads more", done.returncode != 0 and "does not unpack" in done.stderr, done.stderr)
    of_percentiles = {**BEAM["volumes"][0], "transfer_function": {"preset": "grey", "range": ["1%", "99%"]}}
    for name, words, change in (("a look that is found", ("--look", "auto"), {}), ("a view that is found", ("--view", "front"), {}),
                                ("a camera that is found", (), {"camera": None}), ("a function over percentiles", (), {"volumes": [of_percentiles]})):
        made, said = picture(damaged, *words, **change)
        case.ok(f"a scene file with {name}: all chunks are read", made is None and "does not unpack" in said, said)
    (damaged / "0/0/0/32").write_bytes(b"damaged")
    made, said = picture(damaged)
    case.ok("a scene file: a damaged chunk that is seen is told", made is None and "does not unpack" in said, said)


def doors(case, server):
    """Each way to a picture that is zoomed in: the bytes of a part of the finest level are sent, and pictures are those of all bytes.
    Without shadows a picture of all bytes is that of its scene, which is read whole."""
    url, off = server.url, ("--zoom", 8, "--shadows", "off", "--size", "32x32", "--quiet")
    finest, first = (servers.level_bytes(server.folder / FIRST, level) for level in (0, 1))
    pictures, others = case.folder / "pictures", case.folder / "others"
    one, two, times = f"{url}/{FIRST}", f"{url}/{SECOND}", (f"{url}/{TIMES}", "--time", "all")
    for name, stores, words in (
            ("several volumes", 2, ("render", one, two, *off, "-o", pictures / "a.png")),
            ("several channels", 2, ("render", f"{url}/{CHANNELS}", "--channel", "all", *off, "-o", pictures / "a.png")),
            ("several sides", 1, ("render", one, *off, "--views", "front,left", "-o", f"{pictures}/%s.png")),
            ("a series of files", 2, ("render", one, two, *off, "-o", f"{pictures}/%s.png")),
            ("a series of times", 2, ("render", *times, *off, "-o", f"{pictures}/%d.png")),
            ("a film", 1, ("animate", one, *off, "--turntable", 8, "--frames", 2, "-o", pictures)),
            ("a film of times", 2, ("animate", *times, *off, "-o", pictures)),
            ("a film that goes nearer", 1, ("animate", one, *off, "--key", "camera.zoom=0:1,2:2", "-o", pictures))):
        for folder in (pictures, others):
            shutil.rmtree(folder, ignore_errors=True)
            folder.mkdir()
        case.fresh()
        server.forget()
        done = case.run(*words)
        made = [pixels_of(case, path) for path in sorted(pictures.iterdir())]
        case.ok(f"{name}: the first level and a part of the finest one", done.returncode == 0 and made != [] and
                stores * first < server.sent < stores * (first + finest * 3 / 4), (done.stderr, server.sent / stores, first, finest, len(made)))
        case.run(*(str(word).replace(url, str(server.folder)).replace(str(pictures), str(others)) for word in words))
        case.ok(f"{name}: the pictures of all chunks", made == [whole_of(case, path) for path in sorted(others.iterdir())], len(made))


def faults_at_doors(case, server):
    """Where chunks of the finest level do not come as they are, no door makes a picture of them, and the program says why."""
    url, off, pictures = server.url, ("--zoom", 8, "--shadows", "off", "--size", "32x32", "--quiet"), case.folder / "pictures"
    one, two, times = f"{url}/{FIRST}", f"{url}/{SECOND}", (f"{url}/{TIMES}", "--time", "all")
    for name, store, left, words in (
            ("several volumes", SECOND, 0, ("render", one, two, *off, "-o", pictures / "a.png")),
            ("several channels", CHANNELS, 0, ("render", f"{url}/{CHANNELS}", "--channel", "all", *off, "-o", pictures / "a.png")),
            ("several sides", FIRST, 0, ("render", one, *off, "--views", "front,left", "-o", f"{pictures}/%s.png")),
            ("a series of files", SECOND, 1, ("render", one, two, *off, "-o", f"{pictures}/%s.png")),
            ("a film", FIRST, 0, ("animate", one, *off, "--turntable", 8, "--frames", 2, "-o", pictures)),
            ("a film of times", TIMES, 0, ("animate", *times, *off, "-o", pictures))):
        chunks = [path.relative_to(server.folder).as_posix() for path in (server.folder / store / "0").rglob("*") if path.is_file() and path.name.isdigit()]
        for fault, said in (("403", "the server answers 403"), ("cut", "it does not arrive"), ("half", "does not unpack"), ("flipped", "does not unpack")):
            shutil.rmtree(pictures, ignore_errors=True)
            pictures.mkdir()
            case.fresh()
            server.forget(**{chunk.replace("/", "__"): ["always", fault] for chunk in chunks})
            done = case.run(*words)
            made = sorted(path.name for path in pictures.iterdir())
            case.ok(f"{name}, {fault}: no picture of wrong voxels", done.returncode != 0 and said in done.stderr and len(made) == left, (done.returncode, done.stderr, made))


def whole_of(case, picture):
    """The pixels of the scene that a picture carries, for which all chunks are read."""
    done = case.run("render", picture, "--quiet", "--print-scene")
    case.run("render", of_all_chunks(case, done.stdout), "-o", case.folder / "whole.png", "--quiet")
    return pixels_of(case, case.folder / "whole.png")


def pixels_of(case, picture):
    case.run("convert", picture, case.folder / "same.npy")
    return (case.folder / "same.npy").read_bytes()


def greatest_difference(a, b):
    if a is None or b is None:
        return 1
    return max(abs(x - y) for x, y in zip(array.array("f", a[128:]), array.array("f", b[128:])))


def main():
    with tempfile.TemporaryDirectory() as folder:
        case = servers.Case(os.path.abspath(sys.argv[1]), folder)
        if shutil.which("curl") is None:
            print("1..0 # SKIP there is no curl")
            return 0
        stores = pathlib.Path(folder, "stores")
        write_store(stores / STORE)
        write_sharded(stores / SHARDED)
        write_small_chunks(stores)
        server = servers.Server(stores)
        doors(case, server)
        faults_at_doors(case, server)
        scenes(case, stores / "beam.zarr")
        seen = parts(case, server)
        shards(case, server)
        faults(case, server, seen)
        read_once(case, server)
        print(f"1..{case.number}")
        return 1 if case.failed else 0


if __name__ == "__main__":
    sys.exit(main())
