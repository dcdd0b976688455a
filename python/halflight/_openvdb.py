"""OpenVDB files as NanoVDB, by halflight-openvdb or the converter of libnanovdb-tools, as the program does it."""
from __future__ import annotations

import os
import resource
import shutil
import subprocess
import tempfile
from pathlib import Path


class NoConverter(Exception):
    """No converter is installed."""


def convert(path: str) -> bytes:
    """The NanoVDB file that a converter makes of an OpenVDB file.

    The converter sees names of this module's choice only: the input is a link in a temporary folder. It may take the
    machine's memory, and write as much: of a damaged file it can ask for any number of bytes.

    Raises
    ------
    NoConverter
        The program is not installed.
    OSError
        The converter fails: its first words.
    """
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
    """Run a program, with what it says in the file `said`; whether it succeeds. It ends with this call in any case."""
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
