"""Sets the memory limit of volumes and frames, and the folder for volumes that are larger."""
from __future__ import annotations

import os

from ._library import call, context, ffi, lib, path_bytes

_limited: tuple[int | None, str | None] = None, None


def current() -> tuple[int | None, str | None]:
    """The limit in bytes and the scratch folder; each is None if it was not given."""
    return _limited


def limit_memory(limit: int | None, *, scratch_folder: str | os.PathLike[str] | None = None) -> None:
    """Limit the memory that volumes, scenes and renderers hold, and render larger volumes from a scratch file.

    A volume file whose voxels do not fit is read into a scratch file without a name; frames are the same, bit for bit.
    An array of zarr, h5py or dask is read into such a file, too, slice by slice; for a moment its voxels need twice
    their room on the disk. Other arrays are in memory already. Call it while no other thread loads or renders.

    Parameters
    ----------
    limit : int or None
        The greatest number of bytes that are held at once. None sets no limit, as at the start.
    scratch_folder : path, optional
        The folder for scratch files, which should be on a fast disk. A file takes 1.15 times the bytes of the voxels.
        By default TMPDIR of the environment, else /var/tmp.

    Raises
    ------
    ValueError
        `limit` is no number of bytes above 0.
    FileNotFoundError
        There is no such folder.

    Examples
    --------
    >>> limit_memory(4 << 30)
    >>> limit_memory(None)
    """
    if limit is not None and (isinstance(limit, bool) or not isinstance(limit, int) or not 0 < limit < 1 << 64):
        raise ValueError(f"limit: {limit!r} is no number of bytes above 0")
    folder = os.fspath(scratch_folder if scratch_folder is not None else os.environ.get("TMPDIR") or "/var/tmp")
    if scratch_folder is not None and not os.path.isdir(folder):
        raise FileNotFoundError(f"scratch_folder: there is no folder {folder!r}")
    call(lib.hl_context_limit_memory, context, limit or 0, ffi.new("char[]", path_bytes(folder)))
    global _limited
    _limited = limit, folder
