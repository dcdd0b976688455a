"""Snapshots of simulations as particles: HDF5 files of Gadget, Arepo, Gizmo, SWIFT and those that write as they do."""
from __future__ import annotations

import os
from collections.abc import Iterator
from typing import Any

import numpy as np

from ._hdf5 import open_file
from ._words import choice
from .errors import InputError
from .particles import Particles
from .volume import Volume

__all__ = ["Snapshot", "open_snapshot"]

_PARTS = {"gas": "PartType0", "halo": "PartType1", "dark matter": "PartType1", "disk": "PartType2", "bulge": "PartType3",
          "stars": "PartType4", "boundary": "PartType5", "black holes": "PartType5",
          **{f"PartType{n}": f"PartType{n}" for n in range(7)}}


class Snapshot:
    """One type of particle of a snapshot. Made by `open_snapshot`, as a mapping of the file's fields.

    Attributes
    ----------
    particles : Particles
        Places, masses, smoothing lengths and the periodic box, as the file has them.

    Examples
    --------
    ``snapshot["Temperature"]`` reads a field; ``snapshot.volume()`` is the logarithm of density on a grid, and
    ``snapshot.volume("Temperature")`` the mean of a field.
    """

    __slots__ = ("_paths", "_type", "particles")

    def __init__(self, paths: list[str], type_name: str, particles: Particles) -> None:
        self._paths, self._type, self.particles = paths, type_name, particles

    def __len__(self) -> int:
        return len(self.particles)

    def keys(self) -> list[str]:
        """The names of the fields."""
        for group in _groups(self._paths, self._type):
            return [name for name in group if hasattr(group[name], "shape")]
        return []

    def __getitem__(self, field: str) -> np.ndarray[Any, Any]:
        """A field's numbers in the file's units, one for each particle; of vectors the lengths."""
        return _lengths(_read(self._paths, self._type, choice("field", field, self.keys())))

    def volume(self, quantity: Any = "log density", **settings: Any) -> Volume:
        """The particles on a grid, as `Particles.volume`; a name of a field takes its mean."""
        if isinstance(quantity, str) and quantity not in ("log density", "density"):
            settings.setdefault("name", quantity)
            quantity = self[quantity]
        return self.particles.volume(quantity, **settings)

    def colored(self, field: str, cmap: Any = "viridis", *, log: bool = False, **settings: Any) -> list[Volume]:
        """Opacity by density and colour by the mean of a field or, with `log`, of its logarithm, as `Particles.colored`."""
        values = self[field]
        if log:
            with np.errstate(divide="ignore"):
                values = np.log10(values)
            values = np.where(np.isfinite(values), values, np.min(values[np.isfinite(values)], initial=0))
        return self.particles.colored(values, cmap, name=field, **settings)


def open_snapshot(path: str | os.PathLike[str], part: str = "gas") -> Snapshot:
    """Open a snapshot of Gadget, Arepo, Gizmo or SWIFT in HDF5, which needs the package h5py.

    Smoothing lengths are the field SmoothingLength (SmoothingLengths), in which Gadget, Gizmo and SWIFT give the kernel's reach or a
    multiple of it. Cells of Arepo have none: theirs follow from Density or Volume. Without any of these they are found from the
    distances of neighbours. A box whose length is BoxSize counts as periodic where particles fill it.

    Parameters
    ----------
    path : path
        The file, or the first of several (``snap_099.0.hdf5``), or a folder of them.
    part : str
        "gas", "halo", "disk", "bulge", "stars", "boundary", "black holes", or a group's name, "PartType4".

    Raises
    ------
    InputError
        The file is no such snapshot, or has no such particles.
    """
    paths, name = _files(os.fspath(path)), _PARTS[choice("part", part, _PARTS)]
    positions = _read(paths, name, "Coordinates").astype(np.float64)
    header, table = _header(paths[0])
    masses = _masses(paths, name, table, len(positions))
    return Snapshot(paths, name, Particles(positions, masses, h=_smoothing(paths, name, masses, header), periodic=_period(header, positions)))


def _files(path: str) -> list[str]:
    """All files of a snapshot, in the order of their numbers."""
    from glob import escape, glob

    if os.path.isdir(path):
        found = sorted(glob(os.path.join(escape(path), "*.hdf5")) + glob(os.path.join(escape(path), "*.h5")), key=_number)
        if not found:
            raise InputError(f"{path}: the folder has no .hdf5 file")
        return found
    if not os.path.exists(path):
        raise FileNotFoundError(f"{path}: there is no such file")
    stem, dot, number = path.rpartition(".")[0].rpartition(".")
    if dot and number.isdigit():
        return sorted(glob(f"{escape(stem)}.*{escape(path[len(stem) + 1 + len(number):])}"), key=_number)
    return [path]


def _number(path: str) -> tuple[int, str]:
    number = path.rpartition(".")[0].rpartition(".")[2]
    return int(number) if number.isdigit() else -1, path


def _groups(paths: list[str], name: str) -> Iterator[Any]:
    """The group of a type of particle in each file that has it."""
    found = False
    for path in paths:
        try:
            file = open_file(path)
        except OSError as failure:
            raise InputError(f"{path}: not an HDF5 file that can be read: {failure}") from failure
        with file:
            if name in file:
                found = True
                yield file[name]
    if not found:
        raise InputError(f"{paths[0]}: the snapshot has no group {name}: choose another part")


def _read(paths: list[str], name: str, field: str) -> np.ndarray[Any, Any]:
    pieces = []
    for group in _groups(paths, name):
        if field not in group:
            raise InputError(f"{paths[0]}: the group {name} has no {field}")
        pieces.append(np.asarray(group[field]))
    return pieces[0] if len(pieces) == 1 else np.concatenate(pieces)


def _has(paths: list[str], name: str, field: str) -> bool:
    return any(field in group for group in _groups(paths, name))


def _lengths(values: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    if values.ndim == 2 and values.shape[1] == 1:
        return values[:, 0]
    return np.sqrt(np.sum(np.square(values, dtype=np.float64), axis=1)) if values.ndim == 2 else values


def _header(path: str) -> tuple[dict[str, Any], np.ndarray[Any, Any]]:
    with open_file(path) as file:
        header = dict(file["Header"].attrs) if "Header" in file else {}
        code = file["Header"].attrs.get("Code", b"") if "Header" in file else b""
        header["is_swift"] = "SWIFT" in (code.decode() if isinstance(code, bytes) else str(code))
    return header, np.atleast_1d(header.get("MassTable", np.zeros(7)))


def _masses(paths: list[str], name: str, table: np.ndarray[Any, Any], count: int) -> Any:
    if _has(paths, name, "Masses"):
        return _read(paths, name, "Masses")
    number = int(name[-1])
    if number < len(table) and table[number] > 0:
        return np.full(count, table[number], np.float32)
    return None


def _smoothing(paths: list[str], name: str, masses: Any, header: dict[str, Any]) -> Any:
    """Smoothing lengths of kernels that reach to twice of them."""
    for field in ("SmoothingLength", "SmoothingLengths"):
        if _has(paths, name, field):
            # SWIFT's cubic spline reaches to 1.825742 of its smoothing length (its theory pages), Gadget's to 1 of it.
            return _read(paths, name, field) * (1.825742 / 2 if header.get("is_swift") else 0.5)
    if _has(paths, name, "Volume"):
        volumes = _read(paths, name, "Volume")
    elif masses is not None and _has(paths, name, "Density"):
        volumes = masses / _read(paths, name, "Density")
    else:
        return None
    # A kernel over 48 cells, as where neighbours are looked for.
    return 0.5 * np.cbrt(48 * volumes * 3 / (4 * np.pi))


def _period(header: dict[str, Any], positions: np.ndarray[Any, Any]) -> Any:
    """The periodic box, if there is one: particles of an isolated system do not lie within BoxSize, or do not fill it."""
    sizes = np.atleast_1d(header.get("BoxSize", 0)).astype(np.float64)
    sizes = np.repeat(sizes, 3) if sizes.size == 1 else sizes
    finite = positions[np.isfinite(positions).all(axis=1)]
    if sizes.size != 3 or not (sizes > 0).all() or len(finite) == 0:
        return None
    low, high = finite.min(axis=0), finite.max(axis=0)
    filled = (low >= 0).all() and (high <= sizes).all() and (high - low > 0.9 * sizes).all()
    return sizes.tolist() if filled else None
