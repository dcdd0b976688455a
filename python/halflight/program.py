"""Runs the program `halflight` from Python, for the wheel's command, `animate` and `view`."""
from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from typing import Any, Unpack

from .render import Asked, scene_for
from .scene import Scene

__all__ = ["Viewing", "animate", "main", "program_path", "view"]


def program_path() -> str:
    """The path of the program that is installed with the package, or else of the program that PATH or
    HALFLIGHT_PROGRAM names.

    Raises
    ------
    FileNotFoundError
        There is none.
    """
    beside = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "halflight-program" + (".exe" if sys.platform == "win32" else ""))
    if os.path.exists(beside):
        return beside
    if (named := os.environ.get("HALFLIGHT_PROGRAM")):
        return named
    own = os.path.realpath(sys.argv[0]) if sys.argv else ""
    for folder in os.environ.get("PATH", "").split(os.pathsep):
        found = shutil.which("halflight", path=folder)
        # The result must not be the script that calls this function.
        if found is not None and os.path.realpath(found) != own:
            return found
    raise FileNotFoundError("the program halflight is not installed: install a wheel of the package, or build it by scripts/build")


def main() -> int:
    """Replaces this process by the program, for ``halflight ...`` and ``python -m halflight ...``. Windows replaces no process: there this one waits."""
    try:
        path = program_path()
    except FileNotFoundError as problem:
        print(f"halflight: {problem}", file=sys.stderr)
        return 1
    sys.stdout.flush()
    if sys.platform == "win32":
        return subprocess.run([path, *sys.argv[1:]]).returncode
    os.execv(path, ["halflight", *sys.argv[1:]])


def _scene_of(source: Any, asked: Any) -> Scene:
    return source if isinstance(source, Scene) and not asked else scene_for(source, **asked)


def _key(path: str, values: Mapping[float, float]) -> str:
    if not isinstance(values, Mapping) or not values:
        raise TypeError(f"keys['{path}']: {values!r} is no mapping of frames to values")
    return f"{path}=" + ",".join(f"{frame:g}:{float(value)!r}" for frame, value in sorted(values.items()))


def animate(source: Any, path: str | os.PathLike[str], *, turntable: int | None = None,
            keys: Mapping[str, Mapping[float, float]] | None = None, frames: int | None = None, fps: float | None = None,
            quiet: bool = True, **asked: Unpack[Asked]) -> str:
    """Make a film of a scene in which the camera turns and numbers change, by ``halflight animate``.

    Parameters
    ----------
    source : Scene, or what `render` takes
        What is shown.
    path : path
        A .mp4, .mov, .mkv, .webm or .gif file, which the program ffmpeg makes, or a folder for numbered pictures.
    turntable : int, optional
        The number of frames in which the camera turns once about the picture's vertical axis.
    keys : mapping of str to mapping of frame to value, optional
        The numbers of the scene that change, by their place in the scene file: ``{"lights.0.intensity": {0: 1, 48:
        3}}``; "camera.azimuth", "camera.elevation" and "camera.roll" (degrees) and "camera.zoom" turn the camera.
    frames : int, optional
        The number of frames. By default it is the turn's, or reaches up to the last frame of `keys`.
    fps : float, optional
        The number of frames in a second; default 30.
    quiet : bool
        Whether to show no progress bar.
    **asked
        Keywords of `render`.

    Returns
    -------
    str
        The path.

    Raises
    ------
    RuntimeError
        The program has failed; the message is the program's.
    """
    if turntable is None and not keys:
        raise TypeError("animate(): nothing moves: give turntable= or keys=")
    words: list[str] = []
    for word, value in (("--turntable", turntable), ("--frames", frames), ("--fps", fps)):
        if value is not None:
            words += [word, f"{value:g}"]
    for place, values in (keys or {}).items():
        words += ["--key", _key(place, values)]
    with tempfile.TemporaryDirectory(prefix="halflight-") as folder:
        file = os.path.join(folder, "scene.json")
        _scene_of(source, asked).save(file)
        command = [program_path(), "animate", file, *words, "-o", os.path.abspath(path), *(["--quiet"] if quiet else [])]
        ran = subprocess.run(command, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE if quiet else None, text=True)
    if ran.returncode != 0:
        raise RuntimeError((ran.stderr or f"halflight animate failed with {ran.returncode}").strip().removeprefix("halflight: "))
    return os.fspath(path)


class Viewing:
    """A viewer that runs: `url` is its page, `wait()` returns when it ends, `close()` ends it."""

    def __init__(self, process: subprocess.Popen[str], folder: tempfile.TemporaryDirectory[str], url: str) -> None:
        self._process, self._folder, self.url = process, folder, url

    def wait(self) -> None:
        """Wait until the viewer ends, as by Ctrl-C."""
        try:
            self._process.wait()
        except KeyboardInterrupt:
            pass
        finally:
            self.close()

    def close(self) -> None:
        """End the viewer."""
        if self._process.poll() is None:
            self._process.terminate()
            self._process.wait()
        if self._process.stdout is not None:
            self._process.stdout.close()
        self._folder.cleanup()

    def __enter__(self) -> Viewing:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<halflight.Viewing {self.url}>"


def view(source: Any, *, browser: bool = True, options: Sequence[str] = (), **asked: Unpack[Asked]) -> Viewing:
    """Show a scene with the viewer in a browser, as ``halflight view`` does. In notebooks, use `show`.

    Parameters
    ----------
    source : Scene, or what `render` takes
        What is shown.
    browser : bool
        Whether to open a browser with the page. The result's `url` is the page's address.
    options : sequence of str
        More options of ``halflight view``, such as ("--port", "8080").
    **asked
        Keywords of `render`.

    Returns
    -------
    Viewing
        Its `wait()` keeps a script alive until the viewer is closed.
    """
    folder = tempfile.TemporaryDirectory(prefix="halflight-")
    try:
        file = os.path.join(folder.name, "scene.json")
        _scene_of(source, asked).save(file)
        command = [program_path(), "view", file, *([] if browser else ["--no-browser"]), *options]
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        url = process.stdout.readline().strip() if process.stdout is not None else ""
        if not url:
            _, said = process.communicate()
            raise RuntimeError(said.strip().removeprefix("halflight: ") or "halflight view ended at once")
        if process.stderr is not None:
            process.stderr.close()
        return Viewing(process, folder, url)
    except BaseException:
        folder.cleanup()
        raise
