"""Particles as volumes, and snapshots of simulations."""
import base64

import numpy as np
import pytest

import halflight
from halflight import Particles


def even(side, **settings):
    """Particles on a cubic lattice in the unit box, of mass 1 together."""
    places = (np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3) + 0.25) / side
    return Particles(places, np.full(side**3, side**-3.0), periodic=1, **settings)


def mass(volume, ends=0):
    voxels = np.asarray(volume, dtype=np.float64)
    if ends:
        voxels = voxels[:-1, :-1, :-1]
    return voxels.sum() * np.prod(volume.info().spacing)


def test_mass_and_density():
    particles = even(12, h=1.2 / 12)
    density = particles.volume("density")
    assert mass(density, ends=1) == pytest.approx(1, abs=1e-5)
    assert np.asarray(density) == pytest.approx(1, abs=0.02)
    assert np.asarray(particles.volume()) == pytest.approx(0, abs=0.01)
    assert np.asarray(particles.volume(np.full(12**3, 7.0))) == pytest.approx(7, abs=1e-4)
    assert particles.volume(spacing=0.05).dimensions[0] in (21, 25)
    assert max(particles.volume(size=16).dimensions) <= 17


def test_particles_are_volumes():
    """Where a volume is wanted, particles are the volume of their density."""
    particles = Particles(np.random.default_rng(3).normal(size=(400, 3)), h=0.4)
    expected = halflight.render(particles.volume(), size=32)
    for shown in particles, [particles], halflight.Volume(particles), halflight.Scene(particles):
        assert np.array_equal(halflight.render(shown, size=32), expected)
    assert np.array_equal(halflight.render(particles, cmap="magma", size=32), halflight.render(particles.volume(), cmap="magma", size=32))
    with pytest.raises(TypeError, match="spacing is for arrays"):
        halflight.render(particles, spacing=2)


def test_lengths_are_found():
    rng = np.random.default_rng(4)
    places = rng.random((2000, 3))
    found = Particles(places.astype(np.float32)).h
    distance = np.sort(np.linalg.norm(places[:50, None] - places[None], axis=2), axis=1)[:, 48]
    assert found[:50] == pytest.approx(distance / 2, rel=1e-4)
    density = Particles(places).volume("density")
    assert mass(density) == pytest.approx(2000, rel=1e-5)


def test_wrong_arguments():
    with pytest.raises(ValueError, match="positions have the shape"):
        Particles(np.zeros((5, 2)))
    with pytest.raises(ValueError, match="one for each particle"):
        Particles(np.zeros((5, 3)), masses=[1, 2])
    with pytest.raises(halflight.InputError, match="mass of particle 1"):
        Particles(np.random.default_rng(1).random((5, 3)), masses=[1, -2, 1, 1, 1]).volume()
    with pytest.raises(ValueError, match="there is no 'densty'"):
        even(3).volume("densty")
    with pytest.raises(halflight.InputError, match="at one place"):
        Particles(np.ones((5, 3))).volume()


def test_pictures():
    rng = np.random.default_rng(2)
    places = rng.normal(size=(5000, 3))
    particles = Particles(places)
    image = np.asarray(halflight.render(particles.volume(size=64), size=(48, 48)))
    assert image[24, 24].max() > image[2, 2].max() + 0.05
    colored = np.asarray(halflight.render(particles.colored(places[:, 0], ["red", "blue"], size=64), size=(48, 48), camera=(0, 0)))
    left, right = colored[24, 18], colored[24, 30]
    assert left[0] > 2 * left[2] and right[2] > 2 * right[0]


def snapshot(path, box, **fields):
    h5py = pytest.importorskip("h5py")
    with h5py.File(path, "w") as file:
        file.create_group("Header").attrs.update({"BoxSize": box, "MassTable": np.array([0.0, 0.5, 0, 0, 0, 0])})
        for name, values in fields.items():
            file[name.replace("__", "/")] = values


def test_snapshots(tmp_path):
    rng = np.random.default_rng(3)
    places = rng.random((3000, 3)) * 10
    masses = np.full(3000, 2.0, np.float32)
    snapshot(tmp_path / "gadget.hdf5", 10.0, PartType0__Coordinates=places, PartType0__Masses=masses,
             PartType0__SmoothingLength=np.full(3000, 1.5), PartType0__Velocities=np.tile([3.0, 4.0, 0.0], (3000, 1)),
             PartType1__Coordinates=places[:100] / 3)
    gas = halflight.open_snapshot(tmp_path / "gadget.hdf5")
    assert mass(gas.volume("density", size=32), ends=1) == pytest.approx(6000, rel=1e-5)
    assert gas.particles.h[0] == pytest.approx(0.75)
    assert np.nanmax(np.asarray(gas.volume("Velocities", size=32))) == pytest.approx(5, abs=1e-3)
    halo = halflight.open_snapshot(tmp_path / "gadget.hdf5", part="halo")
    assert mass(halo.volume("density", size=32)) == pytest.approx(50, rel=1e-5)
    for n in range(2):
        snapshot(tmp_path / f"arepo.{n}.hdf5", 10.0, PartType0__Coordinates=places[n::2], PartType0__Masses=masses[n::2],
                 PartType0__Density=np.full(1500, 6.0))
    cells = halflight.open_snapshot(tmp_path / "arepo.0.hdf5")
    assert len(cells) == 3000
    assert cells.particles.h[0] == pytest.approx(0.5 * np.cbrt(48 / 3 * 3 / (4 * np.pi)))
    with pytest.raises(halflight.InputError, match="no group PartType4"):
        halflight.open_snapshot(tmp_path / "gadget.hdf5", part="stars")
    (tmp_path / "text.hdf5").write_text("no")
    with pytest.raises(halflight.InputError, match="not an HDF5 file"):
        halflight.open_snapshot(tmp_path / "text.hdf5")


def test_tables(tmp_path):
    rng = np.random.default_rng(5)
    table = np.column_stack([rng.random((500, 3)), np.full(500, 0.1), np.arange(500)])
    np.savetxt(tmp_path / "table.csv", table, delimiter=",", header="x,y,z,h,temperature", comments="")
    with pytest.warns(halflight.HalflightWarning, match="log density is taken"):
        halflight.Volume(tmp_path / "table.csv")
    density = halflight.Volume(tmp_path / "table.csv", array="density")
    assert mass(density) == pytest.approx(500, rel=1e-5)
    mean = np.asarray(halflight.Volume(tmp_path / "table.csv", array="temperature"))
    assert 0 < np.nanmin(mean) and np.nanmax(mean) < 499


def data_array(name, values, encoding):
    """A DataArray element of a VTK file: as text, or in base64 after the length of its bytes."""
    values = np.asarray(values)
    kind = {"f4": "Float32", "f8": "Float64"}[values.dtype.str[1:]]
    components = values.shape[1] if values.ndim > 1 else 1
    text = " ".join(map(repr, values.ravel().tolist()))
    if encoding == "binary":
        content = values.astype(values.dtype.newbyteorder("<")).tobytes()
        text = base64.b64encode(np.array([len(content)], "<u8").tobytes() + content).decode()
    return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="{encoding}">{text}</DataArray>'


def write_points(path, pieces, encoding="ascii", polygons=0):
    """PolyData of points; a piece is their places and a dictionary of arrays."""
    text = '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64"><PolyData>'
    for places, arrays in pieces:
        text += f'<Piece NumberOfPoints="{len(places)}" NumberOfVerts="0" NumberOfLines="0" NumberOfPolys="{polygons}" NumberOfStrips="0">'
        text += "<PointData>" + "".join(data_array(name, values, encoding) for name, values in arrays.items()) + "</PointData>"
        text += f"<Points>{data_array('Points', places, encoding)}</Points></Piece>"
    path.write_text(text + "</PolyData></VTKFile>")
    return path


@pytest.mark.parametrize("encoding", ["ascii", "binary"])
def test_points_of_vtk(tmp_path, encoding):
    rng = np.random.default_rng(6)
    places, masses, lengths = rng.random((500, 3)), rng.random(500).astype("f4"), np.full(500, 0.1, "f4")
    speeds = np.column_stack([np.arange(500), np.zeros(500), np.zeros(500)])
    arrays = {"mass": masses, "h": lengths, "velocity": speeds}
    np.savetxt(tmp_path / "table.csv", np.column_stack([places, masses, lengths, speeds[:, 0]]), fmt="%.17g", delimiter=",",
               header="x,y,z,mass,h,velocity", comments="")
    parts = [(places[part], {name: values[part] for name, values in arrays.items()}) for part in (slice(200), slice(200, None))]
    points = write_points(tmp_path / "points.vtp", parts, encoding)
    density = halflight.Volume(points, array="density")
    assert mass(density) == pytest.approx(masses.sum(), rel=1e-5)
    for array in ("density", "velocity"):
        voxels = [np.asarray(halflight.Volume(file, array=array)) for file in (points, tmp_path / "table.csv")]
        assert np.array_equal(*voxels, equal_nan=True)


def test_polydata_that_is_no_particles(tmp_path):
    """Points without masses and lengths, and surfaces, stay meshes."""
    places = np.random.default_rng(7).random((5, 3))
    for arrays, polygons in (({"velocity": places}, 0), ({"mass": np.ones(5, "f4")}, 1)):
        points = write_points(tmp_path / "points.vtp", [(places, arrays)], polygons=polygons)
        with pytest.raises(halflight.UnsupportedError, match="a mesh, not a volume"):
            halflight.Volume(points)


def test_points_that_lack_an_array(tmp_path):
    places = np.random.default_rng(8).random((5, 3))
    points = write_points(tmp_path / "points.vtp", [(places, {"mass": np.ones(5, "f4")}), (places, {})])
    with pytest.raises(halflight.InputError, match="a piece has no array of mass"):
        halflight.Volume(points)
