#!/usr/bin/env python3
"""A folder of binary masks, as TotalSegmentator and MONAI's bundles write them, as one picture.

usage: halflight_masks.py FOLDER [-o PICTURE] [--scan FILE] [--show NAME,NAME=COLOR:OPACITY,...] [--size WIDTHxHEIGHT]

Each file NAME.nii.gz is a structure.
"""
from __future__ import annotations

import argparse
import pathlib
import sys
from collections.abc import Mapping
from typing import Any

import halflight
import numpy as np

_ENDINGS = (".nii.gz", ".nii", ".nrrd", ".mha")
# Tab. 10 of matplotlib and lighter ones between: neighbours in the list differ.
_COLORS = ("#d8b98f", "#c0504d", "#4f81bd", "#9bbb59", "#8064a2", "#4bacc6", "#f79646", "#e6b8b7", "#b8cce4", "#ffd966", "#a9d18e", "#c27ba0")


def names_of(folder: Any) -> dict[str, pathlib.Path]:
    """The masks of a folder by their names."""
    found = {}
    for path in sorted(pathlib.Path(folder).iterdir()):
        ending = next((one for one in _ENDINGS if path.name.endswith(one)), None)
        if ending is not None:
            found[path.name.removesuffix(ending)] = path
    if not found:
        raise FileNotFoundError(f"{folder}: holds no masks (.nii.gz, .nii, .nrrd, .mha)")
    return found


def labels_of(folder: Any, show: Mapping[str, Any] | None = None) -> halflight.Volume:
    """One label map of a folder's masks, or of those that `show` names: name -> colour, (colour, opacity) or None.

    Where masks overlap, the later one in the list of names counts.
    """
    files = names_of(folder)
    for name in show or {}:
        if name not in files:
            raise ValueError(f"there is no mask '{name}': use one of {', '.join(files)}")
    wanted = list(show or files)
    total, affine, looks = None, None, {}
    for number, name in enumerate(wanted, 1):
        volume = halflight.Volume(files[name])
        mask = np.asarray(volume) > 0
        if total is None:
            total, affine = np.zeros(mask.shape, np.uint16), volume.affine
        elif mask.shape != total.shape or not np.allclose(volume.affine, affine, atol=1e-3):
            raise ValueError(f"{files[name]}: its grid is not that of {files[wanted[0]]}")
        if not mask.any():
            continue
        total[mask] = number
        given = (show or {}).get(name)
        looks[number] = _COLORS[(number - 1) % len(_COLORS)] if given is None else given
    if not looks:
        raise ValueError(f"{folder}: all masks are empty")
    present = set(np.unique(total).tolist())
    return halflight.Volume(total, affine=affine, labels={number: look for number, look in looks.items() if number in present}, name="masks")


def render(folder: Any, scan: Any = None, show: Mapping[str, Any] | None = None, **settings: Any) -> halflight.Image:
    """The picture of a folder's masks, alone or with the scan around them; keywords of `halflight.Scene`."""
    volumes: list[Any] = [labels_of(folder, show)]
    if scan is not None:
        volumes.append(halflight.Volume(scan, look="xray"))
    return halflight.Renderer().render(halflight.Scene(volumes, **{"camera": "front", **settings}))


def _shown(text: str | None) -> dict[str, Any] | None:
    if text is None:
        return None
    found: dict[str, Any] = {}
    for item in text.split(","):
        name, _, opacity = item.partition(":")
        name, _, color = name.partition("=")
        look: Any = color or None
        found[name] = (look or _COLORS[len(found) % len(_COLORS)], float(opacity)) if opacity else look
    return found


def main() -> int:
    """The command."""
    parser = argparse.ArgumentParser(description="A folder of masks as one picture.")
    parser.add_argument("folder")
    parser.add_argument("-o", "--output", default="masks.png")
    parser.add_argument("--scan")
    parser.add_argument("--show")
    parser.add_argument("--size", default="800x800")
    given = parser.parse_args()
    try:
        render(given.folder, given.scan, _shown(given.show), size=given.size).save(given.output)
    except (OSError, ValueError) as problem:
        print(f"halflight_masks.py: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
