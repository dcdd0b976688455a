#!/usr/bin/env python3
"""The page without a server, in Chromium from a disk and from a web server, and in Firefox.

usage: page.py FOLDER PROGRAM [SHOTS]
FOLDER is that of scripts/web. What browser is not there is left out. SHOTS: a folder where screenshots are kept.
"""
import base64
import contextlib
import functools
import gzip
import hashlib
import http.server
import itertools
import json
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests"), str(ROOT / "tests" / "viewer"), str(ROOT / "tests" / "budgets")]
from browser import Browser  # noqa: E402
from dicom_files import dicom_slice  # noqa: E402
from equal_scenes import render_with, write_dropped, write_scenes  # noqa: E402
from firefox import Firefox  # noqa: E402
from scenes import SCENES, balls, write_volumes  # noqa: E402

SHOTS = pathlib.Path(sys.argv[3]).resolve() if len(sys.argv) > 3 else None
MOST = 1.5e6  # bytes of a WebAssembly file, or of a page and all that it loads, as a server sends them, compressed
HANG = 1200  # seconds, for a browser that hangs alone
number = 0


def check(good, what):
    global number
    number += 1
    print(f"{'ok' if good else 'not ok'} {number} - {what}", flush=True)
    if not good:
        sys.exit(1)


def skip(what, why):
    global number
    number += 1
    print(f"ok {number} - {what} # SKIP {why}", flush=True)


def choose_files(browser, files):
    browser.choose("input[type=file]", files)


def try_chosen(browser, url, what, program, folder):
    """The page shows a volume that is chosen."""
    browser.open(url)
    browser.wait("document.querySelector('.tab-welcome') !== null")
    choose_files(browser, [folder / "labels.nrrd"])
    browser.wait("globalThis.halflight?.frames.statistics.finals > 0")
    saved_scene(browser, folder, "saved.json")
    check(same_pixels(program, folder, final_picture(browser), "saved.json"), f"{what}: the final picture is the program's")


def try_kinds(browser, url, what, program, folder):
    """A file of each kind is shown."""
    for name, files in write_dropped(folder, program):
        if name == "series":
            continue  # try_folder
        browser.open(url)
        browser.wait("globalThis.halflight === undefined && document.querySelector('.tab-welcome') !== null")
        choose_files(browser, [folder / file for file in files])
        browser.wait("globalThis.halflight?.frames.statistics.finals > 0")
        saved_scene(browser, folder, "saved.json")
        check(same_pixels(program, folder, final_picture(browser), "saved.json"), f"{what}: {name} is shown")


def try_folder(browser, url, what, program, folder):
    """A folder that is dropped is opened as DICOM; a page from a server opens one in /dev, too, which a page from a disk may do only if the user agrees."""
    (folder / "series").mkdir(exist_ok=True)
    for place in range(9):
        (folder / "series" / f"{place}.dcm").write_bytes(dicom_slice(place))
    browser.open(url)
    browser.wait("globalThis.halflight === undefined && document.querySelector('.tab-welcome') !== null")
    with tempfile.TemporaryDirectory(dir="/dev/shm" if url.startswith("http") else "/var/tmp") as place:
        shutil.copytree(folder / "series", f"{place}/series")
        browser.drop((400, 200), [pathlib.Path(place) / "series"])
        browser.wait("globalThis.halflight?.frames.statistics.finals > 0")
    saved_scene(browser, folder, "saved.json")
    check(same_pixels(program, folder, final_picture(browser), "saved.json"), f"{what}: a folder of DICOM is dropped")


def try_lanes(browser, what):
    """A frame of the main lane cancels what the worker makes for a picture at rest, and leaves the picture that is saved."""
    source = base64.b64encode((ROOT / "src" / "web" / "page" / "worker_channel.js").read_bytes()).decode()
    cancelled = browser.run(f"""import('data:text/javascript;base64,{source}').then(({{ WorkerChannel }}) => {{
      const sent = [], made = Worker;
      Worker = class {{ addEventListener() {{}} postMessage(message) {{ sent.push(message); }} }};
      const channel = new WorkerChannel('worker.js');
      Worker = made;
      for (const lane of ['-small', '-compared', '-probe', '-save']) channel.fetchFrame({{}}, {{ lane }});
      channel.fetchFrame({{}}, {{ moving: true }});
      return sent.filter(({{ kind }}) => kind === 'cancel').map(({{ number }}) => number); }})""")
    check(cancelled == [1, 2, 3], f"{what}: pictures for a rest end where it moves: {cancelled}")


def saved_scene(browser, folder, name):
    """The scene that the page shows, for the program, in the folder of its files."""
    scene = json.loads(browser.run("JSON.stringify(halflight.store.scene)"))
    for part in scene["volumes"] + scene.get("meshes", []):
        if "file" in part:
            part["file"] = pathlib.PurePosixPath(part["file"]).name
    (folder / name).write_text(json.dumps(scene))
    return scene


def final_picture(browser):
    return bytes(browser.run("halflight.frames.finalPicture.arrayBuffer().then((bytes) => [...new Uint8Array(bytes)])"))


def same_pixels(program, folder, picture, scene):
    (folder / "page.png").write_bytes(picture)
    subprocess.run([program, "render", folder / scene, "-o", folder / "native.png", "--quiet"], check=True)
    done = subprocess.run([program, "diff", folder / "page.png", folder / "native.png"], capture_output=True, text=True)
    return done.returncode == 0


def label_at(i, j, k):
    """The value of labels.nrrd."""
    return (1 + i // 14) * (balls(i, j, k) > 125)


def crosshair_at(browser, place, first=(0, 0, 0)):
    """Puts the crosshair there, and waits for its value: { voxel, value, inside }. first: the place of voxel 0, 0, 0."""
    browser.run(f"halflight.slices.moveTo({json.dumps(place)})")
    voxel = [a - b for a, b in zip(place, first)]
    browser.wait(f"JSON.stringify(halflight.slices.readout?.voxel) === {json.dumps(json.dumps(voxel, separators=(',', ':')))} && Number.isFinite(halflight.slices.readout.value)")
    return json.loads(browser.run("JSON.stringify(halflight.slices.readout)"))


def try_slices(browser, what, first=(0, 0, 0)):
    """Slices show the file's values, and a click in the picture finds what is seen there."""
    browser.run("halflight.store.setPage({ layout: 'four' })")
    places = [[20, 2, 30], [13, 14, 14], [27, 25, 20]]
    found = [crosshair_at(browser, place, first)["value"] for place in places]
    check(found == [label_at(*place) for place in places], f"{what}: slices have the file's values: {found}")
    painted = browser.run("""new Promise((done) => setTimeout(done, 300)).then(() => [...document.querySelectorAll('.slice canvas')].filter((canvas) => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return new Set(new Uint32Array(data.buffer)).size > 2; }).length)""")
    check(painted == 3, f"{what}: three slices are painted")
    x, y, width, height = browser.run("(() => { const b = document.getElementById('view').getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()")
    before = browser.run("JSON.stringify(halflight.store.page.cursor)")
    browser.click([x + 0.5 * width, y + 0.6 * height])
    browser.wait(f"JSON.stringify(halflight.store.page.cursor) !== {json.dumps(before)}")
    cursor = [round(one) for one in json.loads(browser.run("JSON.stringify(halflight.store.page.cursor)"))]
    around = [label_at(*(cursor[axis] + step[axis] for axis in range(3))) for step in itertools.product((-1, 0, 1), repeat=3)]
    check(0 in around and max(around) > 0, f"{what}: a click finds a label's surface: {cursor}")


def try_added(browser, program, folder, what):
    """A mesh is added to the volume that is open, and undone."""
    (folder / "triangle.obj").write_text("v 2 2 2\nv 25 2 25\nv 2 25 25\nf 1 2 3\n")
    finals = "halflight.frames.statistics.stage === 'final'"
    browser.run("[...document.querySelectorAll('.section label')].find((label) => label.textContent.includes('Add to what is open')).control.click()")
    choose_files(browser, [folder / "triangle.obj"])
    browser.wait(f"document.getElementById('title').textContent === 'labels.nrrd + triangle.obj' && {finals}")
    saved_scene(browser, folder, "added.json")
    check(same_pixels(program, folder, final_picture(browser), "added.json"), f"{what}: a mesh is added to what is open")
    browser.run("document.getElementById('undo').click()")
    browser.wait(finals)
    saved_scene(browser, folder, "undone.json")
    check(same_pixels(program, folder, final_picture(browser), "undone.json") and browser.run("(halflight.store.scene.meshes ?? []).length") == 0, f"{what}: and undone")
    check(browser.run("document.title") == "labels.nrrd · Halflight", f"{what}: with its name")


def try_reload(browser, folder, what):
    """A page that is loaded anew names what was open, and goes on with it where it is dropped again."""
    browser.run("halflight.store.changeRender('sheet_spacing', 1.5)")
    browser.run("new Promise((done) => setTimeout(done, 500))")
    browser.call("Page.reload")
    browser.wait("globalThis.halflight === undefined && document.querySelector('.tab-message')?.textContent.includes('labels.nrrd')")
    choose_files(browser, [folder / "labels.nrrd"])
    browser.wait("globalThis.halflight?.frames.statistics.finals > 0")
    check(browser.run("halflight.store.scene.render.sheet_spacing") == 1.5 and browser.run("halflight.slices.layout") == "four",
          f"{what}: a page that is loaded anew goes on with what was done")


def try_sizes(page):
    """A page that takes the library from a server does not wait long for it."""
    for file in sorted(page.glob("*.wasm")):
        size = len(gzip.compress(file.read_bytes(), 9))
        check(size <= MOST, f"{file.name}: {size} bytes compressed")


def try_welcome(url):
    """A phone shows the page's name before a file is open."""
    with Browser(size=(390, 844)) as browser:
        browser.open(url)
        browser.wait("document.querySelector('.tab-welcome h1') !== null")
        size = browser.run("parseFloat(getComputedStyle(document.querySelector('.tab-welcome h1')).fontSize)")
        check(size >= 16, f"Chromium, a phone: the page has its name: {size} pixels")
        check(browser.run("document.scrollingElement.scrollWidth <= innerWidth"), "Chromium, a phone: it is no wider than the screen")


def try_chromium(url, what, program, folder):
    with Browser(size=(900, 500)) as browser:
        try_chosen(browser, url, what, program, folder)
        browser.run("halflight.store.changeRender('sheet_spacing', 0.05)")  # a final picture that takes long
        browser.wait("halflight.frames.statistics.stage === 'refining' && document.querySelector('#stage').textContent === 'refining'")
        before = json.loads(browser.run("JSON.stringify(halflight.frames.statistics)"))
        browser.drag((200, 200), (230, 210))
        browser.wait(f"halflight.frames.statistics.previews > {before['previews']}")
        after = json.loads(browser.run("JSON.stringify(halflight.frames.statistics)"))
        check(after["cancelled"] > before["cancelled"] and after["finals"] == before["finals"],
              f"{what}: a picture that is wanted no longer ends")
        try_lanes(browser, what)
        browser.wait("halflight.frames.statistics.stage === 'refining'")
        finals = browser.run("halflight.frames.statistics.finals")
        browser.run("halflight.store.setPage({ layout: 'four' })")
        value = crosshair_at(browser, [13, 14, 14])["value"]
        check(value == 1 and browser.run("halflight.frames.statistics.finals") == finals, f"{what}: slices do not wait for the picture")
        browser.run("halflight.store.changeRender('sheet_spacing', 1)")
        try_slices(browser, what)
        try_reload(browser, folder, what)
        try_added(browser, program, folder, what)
        try_folder(browser, url, what, program, folder)
        try_kinds(browser, url, what, program, folder)
        check(browser.problems == [], f"{what}: no problem in the console: {browser.problems}")


def try_firefox(firefox, url, what, program, folder):
    with Firefox(firefox, size=(900, 500)) as browser:
        try_chosen(browser, url, what, program, folder)
        try_added(browser, program, folder, what)
        try_kinds(browser, url, what, program, folder)
        check(browser.problems == [], f"{what}: no problem in the console: {browser.problems}")


def try_held_scene(kind, what, page, program, folder):
    """A page that holds a scene shows it without being asked."""
    (folder / "held.json").write_text(json.dumps(SCENES["labels"]))
    subprocess.run([program, "export", folder / "held.json", "--page", page, "-o", folder / "held.html", "--quiet"], check=True)
    held = re.search(r'data-file="volume0.nrrd">([^<]*)<', (folder / "held.html").read_text())[1]
    (folder / "volume0.nrrd").write_bytes(gzip.decompress(base64.b64decode(held)))
    facts = json.loads(subprocess.run([program, "info", "--json", folder / "volume0.nrrd"], check=True, capture_output=True, text=True).stdout)
    with kind(size=(900, 500)) as browser:
        browser.open((folder / "held.html").as_uri())
        browser.wait("globalThis.halflight?.frames.statistics.finals > 0")
        saved_scene(browser, folder, "saved.json")
        check(same_pixels(program, folder, final_picture(browser), "saved.json"), f"{what}: a page that holds a scene shows it")
        try_slices(browser, what, [round(one) for one in facts["origin"]])
        if SHOTS is not None:
            browser.wait("halflight.frames.statistics.stage === 'final'")
            browser.screenshot(SHOTS / f"{what}.png")
        check(browser.run("document.title") == "held · Halflight" and browser.problems == [],
              f"{what}: it has the scene's name and no problem in the console: {browser.problems}")


def try_alone(kind, what, page, program, folder):
    """A page loads one file of the library, and is small. A page that is loaded asks its server for nothing more: the server has ended when a file is
    chosen."""
    with serve(page, IsolatingHandler) as (server, url), kind(size=(900, 500)) as browser:
        browser.open(url)
        loaded = "performance.getEntriesByType('resource').map(({ name }) => name.slice(location.href.length))"
        browser.wait(f"{loaded}.some((name) => name.endsWith('.wasm'))")
        names = sorted(name for name in browser.run(loaded) if (page / name).is_file())
        size = sum(len(gzip.compress((page / name).read_bytes(), 9)) for name in [*names, "index.html"])
        check("halflight-threads.wasm" in names and size <= MOST, f"{what}: {size} bytes are loaded, compressed: {' '.join(names)}")
        server.shutdown()
        server.server_close()
        choose_files(browser, [folder / "labels.nrrd"])
        browser.wait("globalThis.halflight?.frames.statistics.finals > 0")
        saved_scene(browser, folder, "saved.json")
        check(same_pixels(program, folder, final_picture(browser), "saved.json"), f"{what}: the page renders after its server has ended")


# Starts the library with its threads.
BEGIN = """<!doctype html><script type="module">
  import { WorkerChannel } from "./worker_channel.js";
  const library = new Uint8Array(await (await fetch("halflight-threads.wasm")).arrayBuffer());
  globalThis.threads = await new WorkerChannel("worker.js").begin(library);
</script>"""


def write_channel_page(folder, name, page):
    """A page that starts the library as the page of the tab does: it imports the script that makes the workers."""
    (folder / name).write_text(page)
    shutil.copy(ROOT / "src" / "web" / "page" / "worker_channel.js", folder)


def try_starts(kind, what, folder):
    """The library starts whenever a page is loaded: in Firefox, workers that other workers made sometimes waited for ever, in one of twenty pages."""
    write_channel_page(folder, "begin.html", BEGIN)
    times = 60
    with serve(folder, IsolatingHandler) as (_, url), kind(size=(900, 500)) as browser:
        for number in range(times):
            browser.open(f"{url}begin.html?{number}")
            browser.wait(f"location.search === '?{number}' && globalThis.threads !== undefined", timeout=60)
        check(browser.run("threads > 0"), f"{what}: the library starts in {times} pages")


class Handler(http.server.SimpleHTTPRequestHandler):
    """The page's folder; POST: what a browser tells, for the test."""

    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".wasm": "application/wasm", ".js": "text/javascript"}

    def log_message(self, *_):
        pass

    def do_POST(self):
        self.server.told.append(json.loads(self.rfile.read(int(self.headers["Content-Length"]))))
        self.server.arrived.set()
        self.send_response(204)
        self.end_headers()


class IsolatingHandler(Handler):
    """A server that isolates its pages, so that their workers may share memory."""

    def end_headers(self):
        self.send_header("Cross-Origin-Opener-Policy", "same-origin")
        self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
        super().end_headers()


@contextlib.contextmanager
def serve(folder, handler=Handler):
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(handler, directory=folder))
    server.told, server.arrived = [], threading.Event()
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield server, f"http://127.0.0.1:{server.server_address[1]}/"
    finally:
        server.shutdown()


# Renders scenes in the page's own worker, and tells the hashes of their pictures.
HASHES = """<!doctype html><script type="module">
import { WorkerChannel } from "./worker_channel.js";
try {
  const { modules, jobs } = await (await fetch("jobs.json")).json();
  if (crossOriginIsolated) modules.unshift("halflight-threads.wasm");
  const bytes = async (name) => new Uint8Array(await (await fetch(name)).arrayBuffer());
  const channel = new WorkerChannel("worker.js"), answers = [];
  let threads = 0;
  for (const name of modules) if ((threads = await channel.begin(await bytes(name))) > 0) break;
  if (threads === 0) throw new Error("no engine");
  for (const { scene, files } of jobs) {
    const contents = Object.fromEntries(await Promise.all(files.map(async (name) => [name, await bytes(name)])));
    const start = await channel.open(contents, scene, scene), { blob } = await channel.fetchFrame(start.scene, { format: "npy" });
    const digest = await crypto.subtle.digest("SHA-256", await blob.arrayBuffer());
    answers.push([scene, [...new Uint8Array(digest)].map((byte) => byte.toString(16).padStart(2, "0")).join("")]);
  }
  await fetch("tell", { method: "POST", body: JSON.stringify({ answers, threads, processors: navigator.hardwareConcurrency }) });
} catch (error) {
  await fetch("tell", { method: "POST", body: JSON.stringify({ problem: String(error) }) });
}
</script>"""


def write_hash_page(page, folder, program):
    """A copy of the page with the scenes of tests/equal_scenes.py. Returns {scene: hash of the program's picture}."""
    shutil.copytree(page, folder)
    jobs = [{"scene": scene, "files": files} for scene, files in write_scenes(folder)]
    expected = {job["scene"]: hashlib.sha256(render_with([program], folder, job["scene"], "native.npy")).hexdigest() for job in jobs}
    (folder / "jobs.json").write_text(json.dumps({"modules": ["halflight-relaxed.wasm", "halflight.wasm"], "jobs": jobs}))
    write_channel_page(folder, "hashes.html", HASHES)
    return expected


def compare_hashes(command, what, folder, expected):
    for handler in (Handler, IsolatingHandler):
        told = hashes_of(command, folder, handler)
        threads = 1 if handler is Handler else min(told.get("processors", 0), 8)
        answers = dict(told.get("answers", []))
        differing = [scene for scene, digest in expected.items() if answers.get(scene) != digest]
        check(not differing and told["threads"] == threads,
              f"{what}: {len(expected)} pictures are the program's, {told.get('threads')} threads: {told.get('problem', '')} {' '.join(differing)}")


def hashes_of(command, folder, handler):
    """What a browser tells of the pictures of hashes.html."""
    profile_folder = tempfile.TemporaryDirectory(prefix="halflight-web-profile-", ignore_cleanup_errors=True)
    with serve(folder, handler) as (server, url), profile_folder as profile:
        browser = subprocess.Popen([*command(profile), urllib.parse.urljoin(url, "hashes.html")], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                                   start_new_session=True)
        try:
            server.arrived.wait(HANG)
        finally:
            os.killpg(browser.pid, signal.SIGKILL)  # with its processes, which would go on to write into the profile
            browser.wait()
        return server.told[0] if server.told else {"problem": "the browser does not answer"}


def main():
    web, program = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    if not (web / "halflight.html").exists():
        print("ok 1 - page # SKIP the page is not there: scripts/web makes it\n1..1")
        return
    with tempfile.TemporaryDirectory(prefix="halflight-web-") as text:
        folder = pathlib.Path(text)
        try_sizes(web / "page")
        write_volumes(folder)
        expected = write_hash_page(web / "page", folder / "page", program)
        if shutil.which("chromium"):
            try_welcome((web / "halflight.html").as_uri())
            try_chromium((web / "halflight.html").as_uri(), "Chromium, one file", program, folder)
            try_held_scene(Browser, "Chromium", web / "halflight.html", program, folder)
            with serve(web / "page") as (_, url):
                try_chromium(url, "Chromium, a folder", program, folder)
            with serve(web / "page", IsolatingHandler) as (_, url):
                try_chromium(url, "Chromium, an isolated folder", program, folder)
            try_alone(Browser, "Chromium", web / "page", program, folder)
            compare_hashes(lambda profile: ["chromium", "--headless=new", "--no-sandbox", "--disable-gpu", f"--user-data-dir={profile}"],
                           "Chromium", folder / "page", expected)
        else:
            skip("Chromium", "it is not installed")
        firefox = shutil.which("firefox-esr") or shutil.which("firefox")
        if firefox:
            try_firefox(firefox, (web / "halflight.html").as_uri(), "Firefox, one file", program, folder)
            with serve(web / "page", IsolatingHandler) as (_, url):
                try_firefox(firefox, url, "Firefox, an isolated folder", program, folder)
            try_alone(functools.partial(Firefox, firefox), "Firefox", web / "page", program, folder)
            try_starts(functools.partial(Firefox, firefox), "Firefox", folder / "page")
            try_held_scene(functools.partial(Firefox, firefox), "Firefox", web / "halflight.html", program, folder)
            compare_hashes(lambda profile: [firefox, "--headless", "--no-remote", "--profile", profile], "Firefox", folder / "page", expected)
        else:
            skip("Firefox", "it is not installed")
    print(f"1..{number}")


main()
