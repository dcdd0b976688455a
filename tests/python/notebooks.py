"""The notebooks of examples/notebooks run, and docs/tutorial is what scripts/tutorial makes of them."""
import pathlib
import subprocess
import sys

import pytest

ROOT = pathlib.Path(__file__).parent.parent.parent
NOTEBOOKS = sorted((ROOT / "examples/notebooks").glob("*.ipynb"))
NEEDS = {"05-medical": ["nibabel"], "04-animation": ["PIL"]}
DATA = {"05-medical": pathlib.Path("/usr/share/mricron/templates/ch2bet.nii.gz")}


def test_there_are_six():
    assert len(NOTEBOOKS) == 6


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook(path, tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    for package in ["ipykernel", "matplotlib", *NEEDS.get(path.stem, [])]:
        pytest.importorskip(package)
    if path.stem in DATA and not DATA[path.stem].exists():
        pytest.skip(f"{DATA[path.stem]} is not there")
    book = nbformat.read(path, as_version=4)
    assert not any(cell.get("outputs") for cell in book.cells), "notebooks are stored without what they put out"
    nbclient.NotebookClient(book, timeout=200, resources={"metadata": {"path": str(tmp_path)}}).execute()
    assert any("image/png" in output.get("data", {}) or "image/gif" in output.get("data", {})
               for cell in book.cells for output in cell.get("outputs", []))


def test_the_tutorial_has_the_notebooks_text():
    done = subprocess.run([sys.executable, ROOT / "scripts/tutorial", "--check"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
