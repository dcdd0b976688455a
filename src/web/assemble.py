#!/usr/bin/env python3
"""Makes the page without a server of its scripts and of the library as WebAssembly.

usage: assemble.py LIBRARIES FOLDER NOTICE ...
LIBRARIES is the folder with the WebAssembly files. NOTICE: files with the notices of what these hold. Writes FOLDER/page/, static files for any web server, and
FOLDER/halflight.html, all of it in one file, which opens from a disk. Either has the notices: licences.txt, and a comment.
"""
import base64
import gzip
import importlib.util
import pathlib
import sys
import urllib.parse

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = [ROOT / "src" / "web" / "page", ROOT / "src" / "server" / "page"]

# The joiner of the notebooks' widget; the package itself is not installed here.
_specification = importlib.util.spec_from_file_location("_page", ROOT / "python" / "halflight" / "_page.py")
joiner = importlib.util.module_from_spec(_specification)
_specification.loader.exec_module(joiner)

PAGE = """<!doctype html>
<html lang="en">
  <head>
    <meta charset="utf-8">
    <meta name="viewport" content="width=device-width, initial-scale=1">
    <title>Halflight</title>
    <link rel="icon" href="{icon}">
    {style}
    {script}
  </head>
  <body class="halflight-page"></body>
</html>
"""
NOTICE = "Halflight is distributed under the Apache License 2.0. Its library, as WebAssembly, holds code of the following authors.\n"


def read(name):
    return next(folder / name for folder in FOLDERS if (folder / name).exists()).read_text(encoding="utf-8")


def joined(name):
    """A script and all that it imports, in one module: functions that return what they export, and the script's own lines last."""
    parts = {}
    joiner.join(name, read, parts)
    return "".join(parts.values()).replace(f"const ${name} = (() => {{", f"const ${name} = (async () => {{")


def element(name, content):
    packed = base64.b64encode(gzip.compress(content, 9, mtime=0)).decode()
    return f'<script type="text/plain" data-part="{name}">{packed}</script>'


libraries, folder, *notice_files = (pathlib.Path(one) for one in sys.argv[1:])
notices = "\n".join([NOTICE, *(f"{file.parent.name}\n\n{file.read_text(encoding='utf-8')}" for file in notice_files)])
parts = {"worker.js": joined("worker").encode(), **{name: (libraries / name).read_bytes() for name in ("halflight.wasm", "halflight-relaxed.wasm")}}
style, script = read("style.css") + read("tab.css"), joined("tab")
icon = "data:image/svg+xml," + urllib.parse.quote(read("icon.svg"))
page = folder / "page"
page.mkdir(parents=True, exist_ok=True)
for name, content in {**parts, "halflight-threads.wasm": (libraries / "halflight-threads.wasm").read_bytes(), "style.css": style.encode(), "tab.js": script.encode()}.items():
    (page / name).write_bytes(content)
(page / "licences.txt").write_text(notices, encoding="utf-8")
(page / "index.html").write_text(PAGE.format(icon=icon, style='<link rel="stylesheet" href="style.css">', script='<script type="module" src="tab.js"></script>'))
single = PAGE.format(icon=icon, style=f"<style>{style}</style>",
                     script="\n    ".join([element(*one) for one in parts.items()] + [f'<script type="module">{script}</script>']))
single += f"<!--\n{notices.replace('--', '- -')}-->\n"
(folder / "halflight.html").write_text(single, encoding="utf-8")
for name in ("halflight-relaxed.wasm", "halflight.wasm", "halflight-threads.wasm"):
    print(f"{name}: {len(gzip.compress((page / name).read_bytes(), 9))} bytes compressed")
print(f"{folder / 'halflight.html'}: {len(single)} bytes")
