"""The pages' blocks of Python without prompts run, on small stand-ins for what they name. docs/python.md has doctests, too."""
import pathlib
import re
import subprocess

import numpy as np
import pytest

import halflight

ROOT = pathlib.Path(__file__).parent.parent.parent
PAGES = ["packaging/wheel/README.md", "docs/figures.md", "docs/integrations.md", "docs/layers.md", "docs/particles.md", "docs/python.md"]
# Packages that a block with this text needs.
NEEDED = {"pyvista": "pyvista", "show(": "anywidget", "open_snapshot": "h5py"}


def blocks():
    """Each block, by its page and first line: fenced, or indented and beginning with an import or an assignment."""
    found = []
    for page in PAGES:
        text = (ROOT / page).read_text() if (ROOT / page).exists() else ""
        found += [(page, code) for code in re.findall(r"^```python\n(.*?)^```", text, re.M | re.S)]
        for block in re.findall(r"(?<=\n\n)((?:    .*\n)+)", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)):
            code = "".join(line[4:] for line in block.splitlines(keepends=True))
            found += [(page, code)] if re.match(r"import |\w+ = ", code) else []
    return [pytest.param(code, id=f"{page}: {code.splitlines()[0]}") for page, code in found]


def write_layers(blob):
    """What `halflight render scene.json -o parts.npy --layers` writes."""
    lights = [halflight.Directional(direction=(0, 1, -1)), halflight.Directional(direction=(1, 1, 0))]
    halflight.Renderer().render(halflight.Scene(blob, lights=lights, size=(48, 32)), layers=True).save("parts.npy")


def write_scans(blob, program):
    pathlib.Path("blob_28x20x24_uint8.raw").write_bytes(blob.tobytes())
    for name in ("head", "brain"):
        subprocess.run([program, "convert", "blob_28x20x24_uint8.raw", f"{name}.nii.gz", "--quiet"], check=True)


def write_snapshot(positions, masses, temperature):
    h5py = pytest.importorskip("h5py")
    with h5py.File("snap_099.0.hdf5", "w") as file:
        file.create_group("Header").attrs.update({"BoxSize": 100.0, "MassTable": np.zeros(6)})
        for name, values in (("Coordinates", positions), ("Masses", masses), ("InternalEnergy", temperature)):
            file[f"PartType0/{name}"] = values


@pytest.mark.parametrize("code", blocks())
def test_block(code, blob, program, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    packages = {package: pytest.importorskip(package) for text, package in NEEDED.items() if text in code}
    random = np.random.default_rng(5)
    names = {"halflight": halflight, "np": np, "density": blob, "positions": 100 * random.random((2000, 3)), "masses": np.ones(2000),
             "smoothing_lengths": np.full(2000, 4.0), "temperature": 1 + random.random(2000), **packages}
    if "nii.gz" in code:
        write_scans(blob, program)
    if "parts.npy" in code:
        write_layers(blob)
    if "open_snapshot" in code:
        write_snapshot(names["positions"], names["masses"], names["temperature"])
    if "pyvista" in code:
        names["mesh"] = packages["pyvista"].Sphere()
    if "other." in code:
        names["other"] = halflight.render(blob, size=(64, 48))
    try:
        exec(compile(code, "page", "exec"), names)
    except halflight.UnsupportedError as missing:
        pytest.skip(str(missing))


@pytest.mark.skipif(not (ROOT / "docs").exists(), reason="the pages are not there")
def test_there_are_blocks():
    assert len(blocks()) >= 8
