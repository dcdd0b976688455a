"""What the tests of the Python package share."""
import os

import numpy as np
import pytest

import halflight


@pytest.fixture(scope="session")
def program():
    """The program that the package is held to."""
    path = os.environ.get("HALFLIGHT_PROGRAM")
    if not path:
        pytest.skip("HALFLIGHT_PROGRAM names no program")
    return path


@pytest.fixture(scope="session")
def blob():
    """uint8 [24][20][28]: a ball beside the middle, no axis like another."""
    z, y, x = np.mgrid[-1:1:24j, -1:1:20j, -1:1:28j]
    return (255 * np.exp(-5 * ((x - 0.2) ** 2 + y**2 + 2 * (z + 0.1) ** 2))).astype(np.uint8)


@pytest.fixture(scope="session")
def small(blob):
    """A scene that renders in an instant."""
    return halflight.Scene(blob, size=(64, 48))


@pytest.fixture(scope="session")
def has_openexr(blob):
    """Skips a test where the build writes no OpenEXR, as on Windows."""
    try:
        halflight.Renderer().render(halflight.Scene(blob, size=(8, 8))).encode("exr")
    except halflight.UnsupportedError as missing:
        pytest.skip(str(missing))
