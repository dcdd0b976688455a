"""Exceptions and warnings.

Faults of a call are Python's own: `TypeError` for words and types, `ValueError` for values that the library
refuses, `MemoryError`, `OSError`. The two classes below tell what a file holds, and what this version can do.
"""

__all__ = ["HalflightWarning", "InputError", "UnsupportedError"]


class InputError(ValueError):
    """A file or a scene is malformed.

    Attributes
    ----------
    line, column : int
        Where in the text, counted from 1; 0 where that is not known.
    byte_offset : int
        Where in the file; -1 where that is not known.
    """

    line = 0
    column = 0
    byte_offset = -1


class UnsupportedError(NotImplementedError):
    """A file or a scene is well formed, and this version cannot do what it asks for."""


class HalflightWarning(UserWarning):
    """What the library chose by itself, or what a copy costs."""
