"""What the tests with other programs' packages share. scripts/test_integrations installs the packages and runs them."""
import os
import pathlib

import numpy as np
import pytest


@pytest.fixture(scope="session")
def pictures():
    """Where pictures for docs/integrations.md go: the folder that HALFLIGHT_PICTURES names, else nowhere."""
    folder = os.environ.get("HALFLIGHT_PICTURES")
    return pathlib.Path(folder) if folder else None


def dilated(mask):
    """The mask, one pixel wider everywhere."""
    wide = np.pad(mask, 1)
    return np.any([wide[1 + y:wide.shape[0] - 1 + y, 1 + x:wide.shape[1] - 1 + x] for y in (-1, 0, 1) for x in (-1, 0, 1)], axis=0)


def check_silhouettes(one, other):
    """Each mask lies within the other one, one pixel wider."""
    assert one.any() and other.any()
    assert not (one & ~dilated(other)).any() and not (other & ~dilated(one)).any()


def side_by_side(path, *codes):
    """Pictures beside each other as one file."""
    from PIL import Image

    Image.fromarray(np.hstack([one[..., :3] for one in codes])).save(path)
