#!/usr/bin/env python3
"""Privacy: nothing of a patient that DICOM files say reaches a picture, a film, a log or the page; what a picture says of its files.

usage: privacy.py PROGRAM
"""
import io
import json
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
import zlib

from PIL import Image

import checks
from checks import check
from dicom_files import dicom_slice
from viewer import Viewer

PROGRAM = os.path.abspath(sys.argv[1])

# Elements about the patient and the people around, and what stands in them.
SECRETS = {
    0x00080050: ("SH", b"Accession"), 0x00080080: ("LO", b"Institution"), 0x00080081: ("ST", b"Streetofit"), 0x00080090: ("PN", b"Referring^Doc"),
    0x00081048: ("PN", b"Recordphysician"), 0x00081050: ("PN", b"Performer^Who"), 0x00081070: ("PN", b"Operatorname"),
    0x00100010: ("PN", b"Musterfrau^Erika"), 0x00100020: ("LO", b"Patientnumber77"), 0x00100030: ("DA", b"19640812"), 0x00100032: ("TM", b"031415"),
    0x00100040: ("CS", b"F"), 0x00101000: ("LO", b"Otherid88"), 0x00101001: ("PN", b"Maiden^Name"), 0x00101010: ("AS", b"061Y"),
    0x00101040: ("LO", b"Heidestrasse"), 0x00101060: ("PN", b"Mothersname"), 0x00102154: ("SH", b"0221471100"), 0x00102160: ("SH", b"Ethnicgroup"),
    0x001021b0: ("LT", b"Historyofit"), 0x00104000: ("LT", b"Patientcomment"), 0x00200010: ("SH", b"Studynumber99"),
}
TEXTS = [value for kind, value in SECRETS.values() if len(value) > 4]


def run(*arguments, **more):
    done = subprocess.run([PROGRAM, *arguments], capture_output=True, check=False, **more)
    check(done.returncode == 0, f"halflight {' '.join(arguments)}: {done.stderr.decode()}")
    return done.stdout + done.stderr


def png_texts(data):
    """All texts of a PNG, unpacked."""
    texts, at = [], 8
    while at < len(data):
        length, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        body = data[at + 8:at + 8 + length]
        if kind not in (b"IHDR", b"IDAT", b"IEND", b"PLTE", b"sRGB", b"gAMA", b"cHRM", b"bKGD"):
            texts.append(body)
            for start in range(len(body)):
                try:
                    texts.append(zlib.decompress(body[start:]))
                    break
                except zlib.error:
                    pass
        at += 12 + length
    return texts


def says_nothing(what, data):
    pieces = [data, *(png_texts(data) if data[:4] == b"\x89PNG" else [])]
    found = [text for text in TEXTS for piece in pieces if text in piece or text.decode().encode("utf-16-le") in piece]
    check(found == [], f"{what} says {found}")


def read(path):
    with open(path, "rb") as file:
        return file.read()


def patients():
    """Pictures, films, logs, reports and other volumes of a DICOM series."""
    for name, options in (("a.png", []), ("b.png", ["--depth", "16"]), ("c.exr", ["--layers"]), ("d.npy", []), ("e.png", ["--labels", "series"])):
        says_nothing(name, run("render", "series", "--size", "24x24", *options, "-o", name))
        says_nothing(name, read(name))
    says_nothing("--json", run("render", "series", "--size", "24x24", "--json", "-o", "f.png"))
    says_nothing("--print-scene", run("render", "series", "--print-scene"))
    says_nothing("damaged files", run("render", "damaged", "--size", "24x24", "-o", "g.png"))
    says_nothing("a DICOM file", run("render", "series/0.dcm", "--size", "24x24", "-o", "h.png"))
    for command in (["info", "series"], ["info", "series", "--json"], ["looks", "series", "-o", "looks.png"]):
        says_nothing(command[0], run(*command))
    for name in ("v.nrrd", "v.nii", "v.mha", "v.vti"):
        says_nothing(name, run("convert", "series", name))
        says_nothing(name, read(name))
    scene = run("render", "series", "--print-scene", "--size", "24x24", "--quiet")
    with open("scene.json", "wb") as file:
        file.write(scene)
    says_nothing("animate", run("animate", "scene.json", "--turntable", "3", "-o", "frames"))
    for name in os.listdir("frames"):
        says_nothing(name, read(f"frames/{name}"))
    if shutil.which("ffmpeg"):
        says_nothing("a film", run("animate", "scene.json", "--turntable", "3", "-o", "film.mp4"))
        says_nothing("a film", read("film.mp4"))
    refused = subprocess.run([PROGRAM, "render", "cut.dcm", "-o", "i.png"], capture_output=True, check=False)
    check(refused.returncode != 0, "a file that is cut short")
    says_nothing("an error", refused.stdout + refused.stderr)


def page():
    """The viewer's answers, and what it says."""
    def request(method, path, body=None):
        status, headers, answer = viewer.request(method, path, body)
        told = answer + str(headers).encode()
        says_nothing(path, told)
        return status, told

    with Viewer(PROGRAM, "series") as viewer:
        scene = json.loads(viewer.request("GET", "start.json")[2])["scene"]
        scene["image"].update(width=24, height=24)
        text = json.dumps(scene)
        request("GET", "start.json")
        for number, format in enumerate(("jpeg", "png", "exr", "npy"), 1):
            check(request("POST", f"frame?page=p&number={number}&format={format}", text)[0] == 200, format)
        check(request("POST", "scene", text)[0] == 200, "the scene")
        status, body = request("POST", "film?page=p&number=9&format=zip&turntable=2", text)
        archive = zipfile.ZipFile(io.BytesIO(body))
        check(status == 200 and len(archive.namelist()) == 2, "pictures of a film")
        for name in archive.namelist():
            says_nothing(name, archive.read(name))
        check(request("POST", "open?file=series")[0] == 200 and request("POST", "open?file=damaged")[0] == 200, "other folders")
        check(request("POST", "open?file=cut.dcm")[0] == 400, "a file that is cut short")
        check(request("POST", "upload?name=x.dcm", read("series/0.dcm"))[0] == 200, "a dropped file")
        viewer.interrupt()
        says_nothing("the log", viewer.process.stdout.read().encode() + viewer.process.stderr.read().encode())


def scene_in(path):
    text = Image.open(path).text.get("halflight:scene")
    return json.loads(text) if text is not None else None


def names_of_files(folder):
    """A picture names the files beside it relative to itself, and others as they were given; or none at all."""
    os.makedirs("home/erika/scans")
    shutil.copy("v.nrrd", "home/erika/scans/v.nrrd")
    shutil.copy("v.nrrd", "elsewhere.nrrd")
    whole = f"{folder}/home/erika"
    for volume, output, name in ((f"{whole}/scans/v.nrrd", f"{whole}/scans/p.png", "v.nrrd"), (f"{whole}/scans/v.nrrd", f"{whole}/p.png", "scans/v.nrrd"),
                                 ("home/erika/scans/v.nrrd", "home/erika/scans/q.png", "v.nrrd"), (f"{whole}/scans/v.nrrd", "r.png", "home/erika/scans/v.nrrd"),
                                 ("elsewhere.nrrd", "home/erika/s.png", "elsewhere.nrrd"), (f"{folder}/elsewhere.nrrd", "home/t.png", f"{folder}/elsewhere.nrrd")):
        run("render", volume, "--size", "24x24", "--quiet", "-o", output)
        check(scene_in(output)["volumes"][0]["file"] == name, f"{output} of {volume} names it {scene_in(output)['volumes'][0]['file']}, not {name}")
        run("render", output, "--quiet", "-o", "again.npy")
        run("render", volume, "--size", "24x24", "--quiet", "-o", "first.npy")
        check(read("again.npy") == read("first.npy"), f"{output} renders to the same picture again")
    os.rename("home/erika", "home/moved")
    run("render", "home/moved/p.png", "--quiet", "-o", "again.npy")
    check(read("again.npy") == read("first.npy"), "a folder that has moved with its pictures renders them as before")
    run("render", "v.nrrd", "--size", "24x24", "--quiet", "--no-metadata", "-o", "bare.png")
    run("render", "v.nrrd", "--size", "24x24", "--quiet", "-o", "told.png")
    check(scene_in("bare.png") is None and b"v.nrrd" not in read("bare.png"), "--no-metadata leaves scene and names out")
    check(png_texts(read("bare.png")) == [], "and all other texts")
    check(Image.open("bare.png").tobytes() == Image.open("told.png").tobytes(), "the pixels are the same")
    bare = subprocess.run([PROGRAM, "render", "v.nrrd", "--size", "24x24", "--quiet", "--no-metadata", "-o", "-"], capture_output=True, check=True)
    check(bare.stdout == read("bare.png"), "on standard output, too")
    run("render", "v.nrrd", "--size", "24x24", "--quiet", "--layers", "-o", "told.exr")
    check(b"v.nrrd" not in read("told.exr") and os.getcwd().encode() not in read("told.exr"), "an EXR holds neither in any case")
    run("animate", "scene.json", "--turntable", "2", "--no-metadata", "--quiet", "-o", "bare")
    check([scene_in(f"bare/{name}") for name in sorted(os.listdir("bare"))] == [None, None], "pictures of animate")
    run("render", "v.nrrd", "elsewhere.nrrd", "--range-of-all", "--size", "24x24", "--no-metadata", "--quiet", "-o", "series-%02d.png")
    check([scene_in(name) for name in sorted(os.listdir(".")) if name.startswith("series-")] == [None, None], "and of a series")


with tempfile.TemporaryDirectory() as folder:
    folder = os.path.realpath(folder)
    os.chdir(folder)
    os.mkdir("temporary")
    os.environ["TMPDIR"] = f"{folder}/temporary"
    secrets = [(tag, *value) for tag, value in SECRETS.items()]
    os.mkdir("series")
    os.mkdir("damaged")
    for n in range(4):
        for place in ("series", "damaged"):
            with open(f"{place}/{n}.dcm", "wb") as file:
                file.write(dicom_slice(n, secrets))
    for path in ("damaged/9.dcm", "cut.dcm"):
        with open(path, "wb") as file:
            file.write(dicom_slice(9, secrets)[:-40])
    check(all(text in read("series/0.dcm") for text in TEXTS), "the files do say all of it")
    patients()
    names_of_files(folder)
    if subprocess.run([PROGRAM, "view", "none.nrrd", "--no-browser"], capture_output=True, check=False).returncode != 4:
        page()
    print(f"{checks.count} checks passed")
