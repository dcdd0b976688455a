"""Defines the package's exceptions and warnings.

For faults of a call, the package raises Python's own exceptions: `TypeError` for words and types, `ValueError` for
values that the library refuses, `MemoryError`, `OSError`. The two exceptions below concern the content of a file, and
the abilities of this version.
"""

__all__ = ["HalflightWarning", "InputError", "UnsupportedError"]


class InputError(ValueError):
    """A file or a scene is malformed.

    Attributes
    ----------
    line, column : int
        The place of the fault in the text, counted from 1; 0 if it is not known.
    byte_offset : int
        The place of the fault in the file; -1 if it is not known.
    """

    line = 0
    column = 0
    byte_offset = -1


class UnsupportedError(NotImplementedError):
    """A file or a scene is well formed, but this version cannot do what it asks for."""


class HalflightWarning(UserWarning):
    """A warning about a choice that the library has made by itself, or about the cost of a copy."""
