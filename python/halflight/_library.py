"""Calls the library: keeps one context for the process, raises errors as exceptions, and handles Ctrl-C and progress.

cffi releases the interpreter's lock during every call. While a call runs, the library asks C code (python/native.c)
whether to stop, and the C code asks this module every 50 ms. In the main thread, Python then runs the handlers of
signals. So Ctrl-C raises an exception in `python_wants_stop`, and the call ends.
"""
from __future__ import annotations

import itertools
import os
import sys
import threading
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any

from . import _native
from .errors import HalflightWarning, InputError, UnsupportedError

ffi = _native.ffi
lib = _native.lib

Report = Callable[[str, float], object]


class _Calls(threading.local):
    """The results that the callbacks of this thread's call leave for the caller."""

    def __init__(self) -> None:
        self.failure: BaseException | None = None
        self.reports: list[Report | None] = []
        self.messages: list[tuple[int, str]] = []  # (hl_log_level, text)


_calls = _Calls()
# The arrays that volumes borrow, by the number that the library passes when it releases an array.
_lent: dict[int, object] = {}
_converted: dict[int, object] = {}  # the bytes of converted files that the library reads, by their address
_numbers = itertools.count(1)


def _remember(kind: type[BaseException], failure: BaseException, trace: object) -> None:
    _calls.failure = failure


@ffi.def_extern(error=1, onerror=_remember)  # type: ignore[untyped-decorator]
def python_wants_stop() -> int:
    return 0


@ffi.def_extern(error=1, onerror=_remember)  # type: ignore[untyped-decorator]
def python_progress(stage: Any, fraction: float) -> int:
    report = _calls.reports[-1] if _calls.reports else None
    if report is not None:
        report(text_of(stage), fraction)
    return 0


@ffi.def_extern()  # type: ignore[untyped-decorator]
def python_log(level: int, message: Any) -> None:
    _calls.messages.append((level, text_of(message)))


@ffi.def_extern()  # type: ignore[untyped-decorator]
def python_array_released(key: int) -> None:
    _lent.pop(key, None)


@ffi.def_extern(error=lib.HL_ERROR_CANCELLED, onerror=_remember)  # type: ignore[untyped-decorator]
def python_convert(path: Any, content: Any, byte_count: Any, error: Any) -> int:
    """Convert OpenVDB to NanoVDB. The bytes are kept until `python_converted` is called."""
    from . import _openvdb  # this import stands here because it takes 8 ms
    try:
        converted = ffi.from_buffer(_openvdb.convert(os.fsdecode(ffi.string(path))))
    except _openvdb.NoConverter:
        return int(lib.HL_ERROR_UNSUPPORTED)
    except OSError as failure:
        error.message = str(failure).encode("utf-8", "replace")[:200]
        return int(lib.HL_ERROR_INPUT)
    content[0], byte_count[0] = converted, len(converted)
    _converted[int(ffi.cast("uintptr_t", converted))] = converted
    return int(lib.HL_OK)


@ffi.def_extern()  # type: ignore[untyped-decorator]
def python_converted(content: Any) -> None:
    _converted.pop(int(ffi.cast("uintptr_t", content)), None)


def text_of(characters: Any) -> str:
    """The text of a `const char *`."""
    whole: bytes = ffi.string(characters)
    return whole.decode("utf-8", "replace")


def _make_context() -> Any:
    made, error = ffi.new("hl_context **"), ffi.new("hl_error *")
    if lib.python_context_create(made, error) != lib.HL_OK:
        raise ImportError(text_of(error.message))
    return made[0]


context = _make_context()


def lend(description: Any, array: object) -> None:
    """Keep `array` until the library no longer reads the voxels of `description`."""
    key = next(_numbers)
    _lent[key] = array
    lib.python_lend(description, key)


def unlend(description: Any) -> None:
    """Release the arrays that were lent to the library if no volume was made."""
    _lent.pop(int(ffi.cast("uintptr_t", description.release_data)), None)


def is_url(path: str) -> bool:
    """Whether a path is a URL of a web server, as the library understands it."""
    return path.startswith(("http://", "https://"))


def _exception(status: int, error: Any, path: str | None) -> BaseException:
    message = text_of(error.message) or text_of(lib.hl_status_name(status))
    if status == lib.HL_ERROR_CANCELLED:
        failure, _calls.failure = _calls.failure, None
        return failure or KeyboardInterrupt()
    if path is not None and not is_url(path) and not os.path.exists(path) and status in (lib.HL_ERROR_IO, lib.HL_ERROR_INPUT):
        return FileNotFoundError(message)
    if status == lib.HL_ERROR_INPUT:
        failed = InputError(message)
        failed.line, failed.column, failed.byte_offset = error.line, error.column, error.byte_offset
        return failed
    kinds: dict[int, type[Exception]] = {
        lib.HL_ERROR_ARGUMENT: ValueError, lib.HL_ERROR_MEMORY: MemoryError, lib.HL_ERROR_IO: OSError,
        lib.HL_ERROR_UNSUPPORTED: UnsupportedError}
    return kinds.get(status, RuntimeError)(message)


def _frames_to_caller() -> int:
    """The number of stack frames up to the first one outside this package. Warnings name the line of that frame."""
    depth, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == __package__:
        depth, frame = depth + 1, frame.f_back
    return depth


def warn(message: str) -> None:
    """Warn the caller of the package."""
    warnings.warn(message, HalflightWarning, stacklevel=_frames_to_caller())


def _pass_on(level: int, message: str) -> None:
    """Pass a message of the library on: a warning as Python's warning, any other message to the logger "halflight"."""
    if level == lib.HL_LOG_WARNING:
        warn(message)
        return
    import logging  # this import stands here because it takes longer than the rest of the package
    logging.getLogger(__package__).info("%s", message)


@contextmanager
def listening(report: Report | None) -> Iterator[None]:
    """Within this context manager, calls report their progress to `report`."""
    _calls.reports.append(report)
    try:
        yield
    finally:
        _calls.reports.pop()


def call(function: Any, *arguments: Any, path: str | None = None, urls: Sequence[str] = (), warns: bool = True) -> None:
    """Call `function(*arguments, error)`, and raise the error that it reports.

    Parameters
    ----------
    function : C function
        One that returns hl_status and takes hl_error last.
    path : str, optional
        The file that is read: where it is missing, the exception is FileNotFoundError. Or the URL of a store, for whose
        files the server is asked.
    urls : sequence of str
        URLs of further stores for whose files servers are asked.
    warns : bool
        Whether the library's messages are passed on: not where they would be about a file that the caller does not know of.
    """
    error = ffi.new("hl_error *")
    lib.python_call_begin(bool(_calls.reports) and _calls.reports[-1] is not None)
    texts = [ffi.new("char[]", os.fsencode(url)) for url in ([*urls] if path is None else [path, *urls]) if is_url(url)]
    named = ffi.new("char *[]", [*texts, ffi.NULL])  # borrowed until the call ends, as the texts are
    lib.python_call_may_ask(named)
    try:
        status = function(*arguments, error)
    finally:
        lib.python_call_end()
    if _calls.messages:
        messages, _calls.messages = _calls.messages, []
        for level, message in messages if warns else []:
            _pass_on(level, message)
    if status != lib.HL_OK:
        raise _exception(status, error, path)
    if _calls.failure is not None:  # a callback failed in the call's last moment
        failure, _calls.failure = _calls.failure, None
        raise failure


def made(function: Any, type_name: str, release: Any, *arguments: Any, path: str | None = None, urls: Sequence[str] = ()) -> Any:
    """The object that `function(*arguments, &object, error)` makes; `release` ends it."""
    place = ffi.new(f"{type_name} **")
    call(function, *arguments, place, path=path, urls=urls)
    return ffi.gc(place[0], release)


def path_bytes(path: str | bytes | os.PathLike[str]) -> bytes:
    """A file's name for the library, which separates folders by '/' on every system."""
    name = os.fsencode(path)
    return name.replace(b"\\", b"/") if sys.platform == "win32" else name


def encoded(function: Any, *arguments: Any) -> bytes:
    """The bytes that `function(*arguments, &bytes, &length, error)` makes."""
    data, length = ffi.new("unsigned char **"), ffi.new("size_t *")
    call(function, *arguments, data, length)
    try:
        return bytes(ffi.buffer(data[0], length[0]))
    finally:
        lib.hl_bytes_release(context, data[0])


def choices_of(option: str) -> list[str]:
    """The choices of an option by which scenes are composed; an empty list if there is no such option."""
    choices = lib.hl_option_choices(option.encode())
    found: list[str] = []
    while choices != ffi.NULL and choices[len(found)].name != ffi.NULL:
        found.append(text_of(choices[len(found)].name))
    return found


def composed(description: Any, flags: Any, options: Mapping[str, str]) -> Any:
    """An hl_scene of a description and options, by their names."""
    keep = [(ffi.new("char[]", name.encode()), ffi.new("char[]", value.encode())) for name, value in options.items()]
    array = ffi.new("hl_option[]", keep) if keep else ffi.NULL
    return made(lib.hl_scene_compose, "hl_scene", lib.hl_scene_release, context, description, flags, array, len(keep))


def names(function: Any) -> list[str]:
    """The names that `function(0)`, `function(1)`, ... return, up to the first null."""
    found: list[str] = []
    while (name := function(len(found))) != ffi.NULL:
        found.append(text_of(name))
    return found
