"""Opens HDF5 files by h5py, which is not installed with this package."""
from __future__ import annotations

from typing import Any


def open_file(path: Any) -> Any:
    """An h5py.File for reading; close it, or use it with `with`."""
    try:
        import h5py
    except ImportError as missing:
        raise ImportError("files of HDF5 need h5py: pip install h5py") from missing
    library: Any = h5py
    return library.File(path, "r")
