#!/usr/bin/env python3
"""halflight.show() in a real JupyterLab and in a real Notebook 7: its frames, its scene, and that it turns as the page does.

usage: notebook.py BUILD [PICTURES]
The hosts and anywidget come from PyPI into a virtual environment of the build folder, once; where they cannot be had,
the test is skipped.
"""
import json
import os
import pathlib
import shutil
import socket
import subprocess
import sys
import tempfile
import time
import urllib.request

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "viewer"))
import checks  # noqa: E402  (the folder is added above)
from browser import Browser  # noqa: E402
from checks import check  # noqa: E402
from exported import check_export, keep_states_of_widgets  # noqa: E402

BUILD = pathlib.Path(sys.argv[1]).resolve()
# shinywidgets is for exported.py, and the last for ../viewer/tools.py.
PACKAGES = ("jupyterlab>=4", "notebook>=7", "anywidget>=0.9", "numpy", "pillow", "cffi", "shinywidgets", "axe-core-python")
CELLS = ["""import numpy, halflight
z, y, x = numpy.mgrid[-1:1:32j, -1:1:32j, -1:1:32j]
ball = numpy.exp(-6 * ((x - 0.3) ** 2 + y**2 + 1.5 * z**2)).astype(numpy.float32)
widget = halflight.show(ball, shadows="soft", size=(64, 64), height=420)
widget""",
         """import hashlib
scene = widget.scene
picture = halflight.Renderer().render(scene)
print("PIXELS", hashlib.sha256(picture.to_srgb8().tobytes()).hexdigest(), scene.volumes[0])""",
         """widget.camera = halflight.Camera(position=(120.0, -40.0, 60.0), target=(15.5, 15.5, 15.5))
widget.lights = [halflight.Directional(direction=(1.0, 0.0, -1.0))]"""]
# Each host's program, its settings, and the address of a notebook in it.
HOSTS = {"JupyterLab": ("jupyter-lab", ("--LabApp.expose_app_in_browser=True", "--LabApp.news_url=None",
                                        "--LabApp.check_for_updates_class=jupyterlab.NeverCheckForUpdate"), "lab/tree"),
         "Notebook": ("jupyter-notebook", ("--JupyterNotebookApp.expose_app_in_browser=True",), "notebooks")}
PANEL = "[...globalThis.jupyterapp?.shell.widgets('main') ?? []].find((w) => w.context?.path === 'show.ipynb')"


def skip(reason):
    print(reason)
    sys.exit(77)


def environment():
    """The virtual environment's folder of programs."""
    folder = BUILD / "jupyter"
    if not all((folder / "bin" / program).exists() for program in (*(host[0] for host in HOSTS.values()), "shiny")):
        made = subprocess.run([sys.executable, "-m", "venv", folder], capture_output=True, text=True)
        if made.returncode != 0:
            skip("python3-venv is not installed")
        got = subprocess.run([folder / "bin" / "pip", "install", "--quiet", *PACKAGES], capture_output=True, text=True)
        if got.returncode != 0:
            shutil.rmtree(folder)
            skip("JupyterLab and Notebook cannot be had from PyPI")
    return folder / "bin"


def packages():
    """The Python package as it is installed."""
    stage = BUILD / "notebook-stage"
    subprocess.run(["meson", "install", "-C", BUILD, "--quiet", "--no-rebuild", "--destdir", stage, "--tags", "python-runtime"],
                   check=True, capture_output=True)
    return next(path.parent for path in stage.rglob("halflight/__init__.py"))


def free_port():
    with socket.socket() as any_socket:
        any_socket.bind(("127.0.0.1", 0))
        return any_socket.getsockname()[1]


class Host:
    """A host with one notebook."""

    def __init__(self, name, programs, folder):
        program, settings, address = HOSTS[name]
        notebook = {"nbformat": 4, "nbformat_minor": 5, "metadata": {"kernelspec": {"name": "python3", "display_name": "Python 3"}},
                    "cells": [{"cell_type": "code", "id": f"cell-{n}", "metadata": {}, "outputs": [], "execution_count": None, "source": text}
                              for n, text in enumerate(CELLS)]}
        (pathlib.Path(folder) / "show.ipynb").write_text(json.dumps(notebook))
        port = free_port()
        self.url = f"http://127.0.0.1:{port}/{address}/show.ipynb?token=test"
        own = {"PYTHONPATH": str(packages().parent), "HOME": folder, "JUPYTER_CONFIG_DIR": folder + "/config", "JUPYTER_DATA_DIR": folder + "/data",
               "JUPYTER_RUNTIME_DIR": folder + "/run", "IPYTHONDIR": folder + "/ipython"}
        self.process = subprocess.Popen(
            [programs / program, "--no-browser", f"--port={port}", "--IdentityProvider.token=test", "--allow-root",
             "--ServerApp.root_dir=" + folder, *settings],
            env={**os.environ, **own}, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        keep_states_of_widgets(folder + "/config")
        self._wait(port)

    def _wait(self, port):
        for _ in range(600):
            try:
                urllib.request.urlopen(f"http://127.0.0.1:{port}/api?token=test", timeout=2)
                return
            except OSError:
                time.sleep(0.1)
        sys.exit("FAILED: the notebook's server does not start")

    def close(self):
        self.process.terminate()
        self.process.wait(20)


def run_cell(browser, number):
    browser.run(f"""(async () => {{
      const panel = {PANEL};
      await panel.context.ready; await panel.sessionContext.ready;
      jupyterapp.shell.activateById(panel.id);
      panel.content.activeCellIndex = {number};
      await jupyterapp.commands.execute('notebook:run-cell');
    }})()""", timeout=120)


VIEWER = "[...document.querySelectorAll('*')].find((e) => e.halflight)?.halflight"


def pixels(browser):
    """SHA-256 of the pixels on the screen."""
    return browser.run(f"""(() => {{
      const host = [...document.querySelectorAll('*')].find((e) => e.halflight);
      const canvas = host.firstElementChild.shadowRoot.querySelector('#picture');
      const {{ data }} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      return crypto.subtle.digest('SHA-256', data).then((hash) =>
        [...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, '0')).join(''));
    }})()""")


def view_box(browser):
    return browser.run("""(() => { const host = [...document.querySelectorAll('*')].find((e) => e.halflight);
      const b = host.firstElementChild.shadowRoot.querySelector('#view').getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()""")


def output(browser):
    return browser.run("[...document.querySelectorAll('.jp-OutputArea-output')].map((o) => o.textContent).find((t) => t.includes('PIXELS')) ?? ''")


RECORD = r"""(() => { globalThis.sent = [];
  const send = WebSocket.prototype.send;
  WebSocket.prototype.send = function (message) {
    const text = typeof message === 'string' ? message : new TextDecoder().decode(message);
    if (text.includes('"kind":"frame"')) sent.push([/"base":[0-9]/.test(text), /"scene":"((?:[^"\\]|\\.)*)"/.exec(text)[1].length]);
    return send.call(this, message);
  }; })()"""


def check_viewer(browser, name, picture):
    browser.wait(f"{PANEL}?.context.isReady === true", timeout=300)
    browser.problems.clear()  # what the host says at its start
    run_cell(browser, 0)
    browser.wait(f"({VIEWER})?.frames.statistics.stage === 'final'", timeout=300)
    first = pixels(browser)
    if picture:
        browser.screenshot(picture)
    browser.run(RECORD)
    x, y, width, height = view_box(browser)
    browser.drag([x + 60, y + height - 60], [x + 160, y + height - 90], steps=12)
    browser.wait(f"({VIEWER}).frames.statistics.stage === 'final'", timeout=300)
    sent = browser.run("sent")
    told = [size for differs, size in sent if differs]
    check(told and max(told) <= 600, f"{name}: moving frames send what differs: {sent}")
    turned = pixels(browser)
    check(turned != first, f"{name}: a drag turns the volume")
    run_cell(browser, 1)
    browser.wait("[...document.querySelectorAll('.jp-OutputArea-output')].some((o) => o.textContent.includes('PIXELS'))", timeout=300)
    found = output(browser)
    check(turned in found, f"{name}: widget.scene is what is seen, pixel for pixel: {turned} {found}")
    check("32x32x32 float32>" in found, f"{name}: its volume is the array again: {found}")
    run_cell(browser, 2)
    browser.wait(f"({VIEWER}).store.scene.camera.position[0] === 120 && ({VIEWER}).store.scene.lights[0].direction[0] === 1", timeout=300)
    browser.wait(f"({VIEWER}).frames.statistics.stage === 'final'", timeout=300)
    last = pixels(browser)
    check(last not in (first, turned), f"{name}: Python's camera and light are seen")
    problems = [one for one in browser.problems if "to activate" not in one]  # the host's plugins on a busy machine
    check(problems == [], f"{name}: the console has errors: {problems}")
    print(f"{name}: {checks.count} checks passed; frames: {browser.run(f'({VIEWER}).frames.statistics')}")
    browser.run(f"{PANEL}.context.save().then(() => true)", timeout=120)
    return last


chromium = shutil.which("chromium")
if chromium is None:
    skip("chromium is not installed")
programs = environment()
for name in HOSTS:
    with tempfile.TemporaryDirectory() as folder, Browser(chromium, (1280, 900)) as browser:
        host = Host(name, programs, folder)
        try:
            browser.open(host.url)
            last = check_viewer(browser, name, sys.argv[2] + f"/{name}.png" if len(sys.argv) > 2 else None)
            check_export(browser, programs, folder, last, sys.argv[2] + f"/{name} exported.png" if len(sys.argv) > 2 else None)
        finally:
            host.close()
