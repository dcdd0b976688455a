"""Shows progress by a callable, by tqdm if it is installed, or by a line on stderr."""
from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from ._library import Report, listening

__all__ = ["Progress"]

Progress = bool | Callable[[str, float], object] | None


class _Line:
    """A progress line on stderr, which is written anew each time."""

    def __call__(self, stage: str, fraction: float) -> None:
        sys.stderr.write(f"\r{stage} {fraction:4.0%}")
        sys.stderr.flush()

    def close(self) -> None:
        sys.stderr.write("\r" + 20 * " " + "\r")


class _Bar:
    """A progress bar of tqdm, which also works in notebooks."""

    def __init__(self, tqdm: Any) -> None:
        self.bar = tqdm(total=1.0, bar_format="{desc} {percentage:3.0f}%|{bar}| {elapsed}", leave=False)

    def __call__(self, stage: str, fraction: float) -> None:
        self.bar.set_description_str(stage, refresh=False)
        self.bar.n = fraction
        self.bar.refresh()

    def close(self) -> None:
        self.bar.close()


@contextmanager
def told(progress: Progress) -> Iterator[None]:
    """Within this context manager, calls report their progress as `progress` asks: True, False, None or a callable
    (stage, fraction).
    """
    if progress is None or progress is False:
        with listening(None):
            yield
        return
    if progress is not True:
        if not callable(progress):
            raise TypeError(f"progress: {progress!r} is neither True, False nor callable")
        with listening(progress):
            yield
        return
    bar: _Line | _Bar
    try:
        from tqdm.auto import tqdm

        bar = _Bar(tqdm)
    except ImportError:
        bar = _Line()
    report: Report = bar
    try:
        with listening(report):
            yield
    finally:
        bar.close()
