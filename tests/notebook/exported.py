"""A notebook that JupyterLab has saved, as a page without a kernel: nbconvert's HTML shows the viewer's last frame."""
import functools
import http.server
import pathlib
import re
import shutil
import subprocess
import threading

from checks import check

# The saved state of widgets is for Jupyter's html-manager. nbconvert names an address of it; here the copy in shinywidgets serves, with the require.js of shiny,
# and anywidget's script, which the html-manager asks for by its name.
SCRIPTS = {"require.js": "shiny/www/shared/**/require*.js", "embed-amd.js": "shinywidgets/static/libembed-amd.js", "anywidget.js": "anywidget/nbextension/index.js"}
SETTINGS = "lab/user-settings/@jupyter-widgets/jupyterlab-manager/plugin.jupyterlab-settings"
# The copy only defines the html-manager; what nbconvert names runs it, too.
RUN = "\nrequire(['@jupyter-widgets/html-manager/dist/libembed-amd'], (embed) => embed.renderWidgets());\n"
STILL = """(() => { const find = (root) => root.querySelector('.halflight-still') ??
    [...root.querySelectorAll('*')].map((e) => e.shadowRoot && find(e.shadowRoot)).find(Boolean);
  const still = find(document); return still?.complete && still.naturalWidth > 0 ? still : undefined; })()"""
PIXELS = f"""(() => {{
  const image = {STILL}, canvas = document.createElement('canvas'), pen = canvas.getContext('2d');
  [canvas.width, canvas.height] = [image.naturalWidth, image.naturalHeight];
  pen.drawImage(image, 0, 0);
  return crypto.subtle.digest('SHA-256', pen.getImageData(0, 0, canvas.width, canvas.height).data).then((hash) =>
    [...new Uint8Array(hash)].map((byte) => byte.toString(16).padStart(2, '0')).join(''));
}})()"""


def keep_states_of_widgets(configuration):
    """JupyterLab's setting by which a saved notebook has its widgets' states."""
    place = pathlib.Path(configuration) / SETTINGS
    place.parent.mkdir(parents=True)
    place.write_text('{"saveState": true}')


class _Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


def check_export(browser, programs, folder, expected, picture):
    """The page of FOLDER/show.ipynb shows a frame whose pixels have this SHA-256."""
    packages = next((programs.parent / "lib").glob("python3*")) / "site-packages"
    page = pathlib.Path(folder) / "page"
    page.mkdir()
    for name, pattern in SCRIPTS.items():
        shutil.copy(next(packages.glob(pattern)), page / name)
    with (page / "embed-amd.js").open("a") as script:
        script.write(RUN)
    subprocess.run([programs / "jupyter-nbconvert", "--to", "html", "--output-dir", page, "--HTMLExporter.require_js_url=require.js",
                    "--HTMLExporter.widget_renderer_url=embed-amd.js", pathlib.Path(folder) / "show.ipynb"], check=True, capture_output=True)
    # MathJax is nothing that the viewer needs; a browser without a network waits for it.
    text = (page / "show.html").read_text()
    (page / "show.html").write_text(re.sub(r'<script[^>]*src="https:[^>]*>\s*</script>', "", text))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(_Quiet, directory=page)) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        browser.open(f"http://127.0.0.1:{server.server_port}/show.html")
        browser.wait(f"{STILL} !== undefined", timeout=300)
        found = browser.run(PIXELS)
        check(found == expected, f"an exported page shows the last frame: {found} {expected}")
        if picture:
            browser.screenshot(picture)
        server.shutdown()
