"""OpenVDB files, which nanovdb_convert makes NanoVDB of."""
import json
import shutil
import subprocess

import numpy as np
import pytest

import halflight
from halflight.errors import InputError, UnsupportedError

openvdb = pytest.importorskip("pyopenvdb")
if shutil.which("nanovdb_convert") is None:
    pytest.skip("no nanovdb_convert", allow_module_level=True)


@pytest.fixture
def file(tmp_path):
    """A grid whose voxel (x, y, z) has the value 1 + 100 x + 10 y + z, a quarter of a unit wide."""
    x, y, z = np.indices((5, 4, 3))
    grid = openvdb.FloatGrid()
    grid.copyFromArray((1 + 100 * x + 10 * y + z).astype(np.float32))
    grid.name = "density"
    grid.transform = openvdb.createLinearTransform(0.25)
    openvdb.write(str(tmp_path / "smoke.vdb"), grids=[grid])
    return tmp_path / "smoke.vdb"


def test_values_and_place(file):
    info = halflight.info(file)
    assert info.dimensions == (5, 4, 3) and info.range == (1, 433) and np.isclose(info.mean, 217)
    assert np.allclose(info.spacing, 0.25) and [a.name for a in info.arrays] == ["density"]
    picture = np.asarray(halflight.render(halflight.Volume(file), size=(32, 32)))
    assert picture.shape == (32, 32, 4) and picture.max() > 0


def test_the_data_and_not_the_name_tell_fog(program, tmp_path):
    """A grid called "density" is smoke where the file says fog and the data may be one; signed values never are."""
    z, y, x = np.mgrid[-1:1:40j, -1:1:40j, -1:1:40j]
    puff = np.exp(-5 * (x**2 + y**2 + z**2))
    signed = np.exp(-8 * ((x - .3)**2 + y**2 + z**2)) - np.exp(-8 * ((x + .3)**2 + y**2 + z**2))
    fog, unknown = openvdb.GridClass.FOG_VOLUME, openvdb.GridClass.UNKNOWN
    for values, kind, taken in ((puff, fog, "smoke or cloud"), (puff, unknown, "field"), (signed, fog, "signed field")):
        grid = openvdb.FloatGrid()
        grid.copyFromArray(np.where(abs(values) < 0.01, 0, values).astype(np.float32))
        grid.name, grid.gridClass = "density", kind
        openvdb.write(str(tmp_path / "grid.vdb"), grids=[grid])
        told = subprocess.run([program, "info", "--json", tmp_path / "grid.vdb"], capture_output=True, check=True)
        assert json.loads(told.stdout)["taken_for"] == taken


def test_as_the_program_reads_it(file, program):
    told = subprocess.run([program, "convert", file, file.with_suffix(".nrrd")], capture_output=True, text=True)
    assert told.returncode == 0, told.stderr
    assert halflight.info(file.with_suffix(".nrrd")).mean == halflight.info(file).mean


def test_without_the_converter(file, monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(UnsupportedError, match="nanovdb_convert NAME.vdb NAME.nvdb"):
        halflight.Volume(file)


def test_damaged(file):
    file.write_bytes(file.read_bytes()[:5000])
    with pytest.raises(InputError, match=r"smoke\.vdb: (nanovdb_convert|halflight-openvdb): "):
        halflight.Volume(file)
