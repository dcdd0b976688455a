#!/usr/bin/env python3
"""The published JSON Schema of figures and `halflight figure` agree, and the schema has the options that panels have.

Usage: figure_schema.py PROGRAM SOURCE_ROOT
"""
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import jsonschema
except ImportError:
    print("skipped: python3-jsonschema is not installed")
    sys.exit(77)

PANEL = {"input": "rings.nrrd"}
# What is in the file, and whether it is a figure.
CASES = [
    ({"panels": [PANEL]}, True),
    ({"$schema": "halflight-figure.schema.json", "panels": [PANEL]}, True),
    ({"panels": [PANEL | {"scale-bar": "auto", "unit": "mm", "ortho": True}]}, True),
    ({"panels": [PANEL | {"scale_bar": "auto", "unit": "mm", "ortho": True}]}, True),
    ({"panels": [PANEL | {"look": "translucent", "zoom": 2, "light": "20,30"}, PANEL], "columns": 2}, True),
    ({"panels": [PANEL | {"annotate": ["a@0.1,0.1", "b@0.2,0.2"]}], "letters": "A", "font-size": 8}, True),
    ({"panels": [PANEL], "width": "8.9cm", "gap": 1, "share": ["camera", "light"], "dpi": 50}, True),
    ({"panels": [PANEL | {"inset": {"zoom": 4, "corner": "upper left", "part": 0.3}}], "letters": False}, True),
    ({"panels": [{"letter": "x", "aspect": 2}], "options": {"input": "rings.nrrd", "ortho": True}}, True),
    ({"panels": [PANEL | {"ortho": None}], "background": "transparent"}, True),
    ({"panels": [PANEL | {"reference": True, "rays": 1, "shadows": "off", "sky": 0}], "width": "20mm"}, True),
    ({"panels": [PANEL | {"inset": {"zoom": 4, "at": [0.25, 0.5]}}]}, True),
    ({"panels": []}, False),
    ({}, False),
    ([], False),
    ({"panels": [PANEL], "rows": 2}, False),
    ({"panels": [PANEL | {"zoomm": 2}]}, False),
    ({"panels": [PANEL | {"output": "a.png"}]}, False),
    ({"panels": [PANEL | {"size": "20x20"}]}, False),
    ({"panels": [PANEL | {"layers": True}]}, False),
    ({"panels": [PANEL | {"inset": {"at": [0.2, 2]}}]}, False),
    ({"panels": [PANEL | {"inset": {"at": 0.5}}]}, False),
    ({"panels": [PANEL | {"zoom": {"of": 2}}]}, False),
    ({"panels": [PANEL | {"zoom": True}]}, False),
    ({"panels": [PANEL | {"look": ["mip", "xray"]}]}, False),
    ({"panels": [{"input": 3}]}, False),
    ({"panels": [{"input": []}]}, False),
    ({"panels": [PANEL | {"letter": 3}]}, False),
    ({"panels": [PANEL | {"aspect": 100}]}, False),
    ({"panels": [PANEL | {"inset": {"corner": "middle"}}]}, False),
    ({"panels": [PANEL | {"inset": {"part": 2}}]}, False),
    ({"panels": [PANEL | {"inset": {"inset": {}}}]}, False),
    ({"panels": [PANEL], "width": "89 miles"}, False),
    ({"panels": [PANEL], "dpi": 1}, False),
    ({"panels": [PANEL], "columns": 0}, False),
    ({"panels": [PANEL], "share": ["sky"]}, False),
    ({"panels": [PANEL], "letters": 3}, False),
    ({"panels": [PANEL], "background": 3}, False),
]


def main(program, root):
    schema = json.loads((root / "share/halflight-figure.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "make", "rings", "--size", "16", "--quiet", "-o", "rings.nrrd"], cwd=folder, check=True)
        for figure, accepted in CASES:
            small = {"dpi": 20} | figure if isinstance(figure, dict) else figure
            text = json.dumps(small)
            pathlib.Path(folder, "figure.json").write_text(text)
            told = subprocess.run([program, "figure", "figure.json", "-o", "out.png", "--quiet"], cwd=folder,
                                  capture_output=True, text=True)
            faults = [fault.message for fault in validator.iter_errors(small)]
            if (told.returncode == 0) != accepted or (not faults) != accepted:
                wrong += 1
                print(f"{text}: the program: {told.returncode} {told.stderr.strip()}; the schema: {faults}")
    stale = subprocess.run([sys.executable, root / "scripts/figure_schema", "--check", program]).returncode
    print(f"{len(CASES)} figures, {wrong} disagreements")
    return 1 if wrong or stale else 0


sys.exit(main(str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2])))
