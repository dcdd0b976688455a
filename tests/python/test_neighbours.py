"""Volumes of other packages, where these are installed: the array and the place that each one knows."""
import subprocess
import sys

import numpy as np
import pytest

import halflight

DIRECTION = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
SPACING, ORIGIN = np.array([1.0, 2, 3]), np.array([7.0, 8, 9])
AFFINE = np.vstack([np.column_stack([DIRECTION * SPACING, ORIGIN]), [0, 0, 0, 1]])


@pytest.fixture
def expected(blob):
    """The picture of the blob at this place, and its place."""
    volume = halflight.Volume(blob, affine=AFFINE)
    return np.asarray(halflight.render(volume, size=(64, 48))), volume.info()


def check(source, expected, space=None, tolerance=2e-3):
    """source gives the expected place and picture. With a space the body's anatomy turns the view: the place alone."""
    picture, place = expected
    info = halflight.info(source)
    assert info.dimensions == place.dimensions and info.range == place.range and info.space == space
    steps = info.direction * info.spacing
    corner = info.origin + steps.clip(max=0) @ (np.array(info.dimensions) - 1)
    assert np.allclose(corner, place.origin + (place.direction * place.spacing).clip(max=0)
                       @ (np.array(place.dimensions) - 1))
    # The axes may be counted in another order and from the other end.
    assert np.allclose(sorted(map(tuple, abs(steps.T))), sorted(map(tuple, abs((place.direction * place.spacing).T))))
    if space is None:
        assert abs(np.asarray(halflight.render(source, size=(64, 48))) - picture).max() <= tolerance


def test_nibabel(blob, expected, tmp_path):
    nibabel = pytest.importorskip("nibabel")
    image = nibabel.Nifti1Image(blob.transpose(), AFFINE)
    check(image, expected, "RAS")
    nibabel.save(image, tmp_path / "blob.nii.gz")
    loaded, file = nibabel.load(tmp_path / "blob.nii.gz"), halflight.render(tmp_path / "blob.nii.gz", size=(64, 48))
    # The same picture as of the file, which the library reads itself.
    assert abs(np.asarray(halflight.render(loaded, size=(64, 48))) - np.asarray(file)).max() < 2e-3


def test_simpleitk(blob, expected):
    itk = pytest.importorskip("SimpleITK")
    image = itk.GetImageFromArray(blob)
    image.SetSpacing(SPACING.tolist())
    image.SetOrigin(ORIGIN.tolist())
    image.SetDirection(DIRECTION.ravel().tolist())
    check(image, expected, "LPS")
    volume = halflight.Volume(image)
    del image
    assert volume.info().range == expected[1].range


def test_itk(blob, expected):
    itk = pytest.importorskip("itk")
    image = itk.image_from_array(blob)
    image.SetSpacing(SPACING.tolist())
    image.SetOrigin(ORIGIN.tolist())
    image.SetDirection(itk.matrix_from_array(DIRECTION))
    check(image, expected, "LPS")


@pytest.mark.parametrize("order", "FC")
def test_pynrrd(blob, expected, tmp_path, order):
    nrrd = pytest.importorskip("nrrd")
    header = {"space directions": (DIRECTION * SPACING).T, "space origin": ORIGIN, "space dimension": 3}
    nrrd.write(str(tmp_path / "blob.nrrd"), blob, header, index_order="C")
    check(nrrd.read(str(tmp_path / "blob.nrrd"), index_order=order), expected)
    check(str(tmp_path / "blob.nrrd"), expected, tolerance=0)


def test_xarray(blob):
    xarray = pytest.importorskip("xarray")
    z, y, x = (start + step * np.arange(size) for start, step, size in zip((9, 8, 7), (3, -2, 1), blob.shape))
    array = xarray.DataArray(blob, coords={"z": z, "y": y, "x": x}, dims=("z", "y", "x"), name="density")
    placed = halflight.Volume(blob, affine=[[1, 0, 0, 7], [0, -2, 0, 8], [0, 0, 3, 9]])
    expected = np.asarray(halflight.render(placed, size=(64, 48))), placed.info()
    check(array, expected, tolerance=0)
    check(array.transpose("x", "y", "z"), expected)
    assert halflight.Volume(array).look["name"] == "density"
    with pytest.raises(ValueError, match="the coordinates of 'x' are not evenly spaced"):
        halflight.Volume(array.assign_coords(x=x**2))


def test_vtk(blob, expected):
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.vtkCommonDataModel import vtkImageData

    data = vtkImageData()
    data.SetDimensions(blob.shape[::-1])
    data.SetSpacing(SPACING)
    data.SetOrigin(ORIGIN)
    data.SetDirectionMatrix(DIRECTION.ravel())
    scalars = numpy_to_vtk(blob.ravel())
    data.GetPointData().SetScalars(scalars)
    check(data, expected, tolerance=0)


def test_pyvista(blob, expected):
    pyvista = pytest.importorskip("pyvista")
    grid = pyvista.ImageData(dimensions=blob.shape[::-1], spacing=SPACING, origin=ORIGIN)
    grid.direction_matrix = DIRECTION
    grid.point_data["density"] = blob.ravel()
    check(grid, expected, tolerance=0)
    cells = pyvista.ImageData(dimensions=np.add(blob.shape[::-1], 1), spacing=SPACING,
                              origin=ORIGIN - DIRECTION @ (SPACING / 2))
    cells.direction_matrix = DIRECTION
    cells.cell_data["density"] = blob.ravel()
    check(cells, expected, tolerance=1e-4)
    with pytest.raises(ValueError, match="has no active scalars"):
        halflight.Volume(pyvista.ImageData(dimensions=(3, 3, 3)))


def plain_check(source, blob):
    assert np.array_equal(np.asarray(halflight.render(source, size=(64, 48))),
                          np.asarray(halflight.render(blob, size=(64, 48))))


def test_h5py(blob, tmp_path):
    h5py = pytest.importorskip("h5py")
    with h5py.File(tmp_path / "blob.h5", "w") as file:
        plain_check(file.create_dataset("density", data=blob), blob)


def test_zarr(blob):
    zarr = pytest.importorskip("zarr")
    plain_check(zarr.array(blob), blob)


def test_dask(blob):
    dask = pytest.importorskip("dask.array")
    plain_check(dask.from_array(blob, chunks=8), blob)


def test_reading_much_is_said():
    class Stored:
        shape, dtype, chunks = (1024, 1024, 1024), np.dtype(np.uint8), (64, 64, 64)

        def __array__(self):
            raise AssertionError

        def __getitem__(self, index):
            return np.zeros((2, 2, 2), np.uint8)

    with pytest.warns(halflight.HalflightWarning, match="all 1.0 GiB are read into memory"):
        halflight.Volume(Stored())


def test_none_is_imported():
    code = "import halflight, numpy, sys; halflight.render(numpy.ones((9, 9, 9)), size=(8, 8)); print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout.split()
    assert not {"nibabel", "SimpleITK", "nrrd", "xarray", "vtkmodules", "pyvista", "h5py", "zarr", "dask",
                "matplotlib", "tqdm"} & set(loaded)
