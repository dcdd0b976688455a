"""Converts OpenVDB files to NanoVDB by halflight-openvdb or by the converter of libnanovdb-tools, as the program does.
"""
from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path


class NoConverter(Exception):
    """No converter is installed. On Windows none is asked, since nothing there limits its output."""


def convert(path: str) -> bytes:
    """The NanoVDB file that a converter makes of an OpenVDB file.

    This module chooses all names that the converter gets: the input is a link in a temporary folder. The converter's
    memory and its output are limited to the size of the machine's memory, because a damaged file can make it ask for
    any number of bytes.

    Raises
    ------
    NoConverter
        The program is not installed, or the system is Windows.
    OSError
        The converter has failed; the message is its first line.
    """
    if sys.platform == "win32":
        raise NoConverter
    converter = os.environ.get("HALFLIGHT_OPENVDB") or shutil.which("halflight-openvdb") or "nanovdb_convert"
    with tempfile.TemporaryDirectory(prefix="halflight-") as folder:
        source, made = Path(folder, "in.vdb"), Path(folder, "out.nvdb")
        source.symlink_to(os.path.realpath(path))
        try:
            succeeded = _run([converter, str(source), str(made)], Path(folder, "said"))
        except FileNotFoundError:
            raise NoConverter from None
        if not succeeded or not made.is_file():
            with Path(folder, "said").open("rb") as output:
                said = output.read(400).decode("utf-8", "replace").strip().splitlines()
            raise OSError(f"{Path(converter).name}: {said[0].strip() if said else 'it wrote nothing'}")
        return made.read_bytes()


def _run(words: list[str], said: Path) -> bool:
    """Run a program whose messages go to the file `said`. Returns whether it succeeds. It has ended when this call
    returns.
    """
    import resource  # Windows has none

    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    with said.open("wb") as output:
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=output, stderr=subprocess.STDOUT)
    try:
        for limit in (resource.RLIMIT_AS, resource.RLIMIT_FSIZE):
            resource.prlimit(process.pid, limit, (memory, memory))
        return process.wait() == 0
    finally:
        process.kill()
        process.wait()
