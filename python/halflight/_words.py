"""Unknown words are refused with the nearest known one."""
from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Collection
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


def nearest(word: str, known: Collection[str]) -> str:
    """`": did you mean 'x'?"`, or a list of all where none is near."""
    import difflib

    found = difflib.get_close_matches(word.lower(), known, 1, 0.5)
    return f": did you mean '{found[0]}'?" if found else f": use one of {', '.join(known)}"


def check_keywords(place: str, given: Collection[str], known: Collection[str]) -> None:
    """Raise TypeError for the first unknown keyword."""
    for word in given:
        if word not in known:
            raise TypeError(f"{place} has no keyword '{word}'{nearest(word, known)}")


def choice(place: str, word: object, known: Collection[str]) -> str:
    """`word`, if it is one of the known ones."""
    if not isinstance(word, str):
        raise TypeError(f"{place}: {word!r} is no name: use one of {', '.join(known)}")
    if word not in known:
        raise ValueError(f"{place}: there is no '{word}'{nearest(word, known)}")
    return word


def suggests_also(further: Collection[str]) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """`suggests` for a function whose ``**`` takes these keywords."""
    return lambda function: suggests(function, further)


def suggests(function: Callable[P, R], further: Collection[str] = ()) -> Callable[P, R]:
    """Make `function` answer an unknown keyword with the nearest one that it has. further: what its ** takes."""
    parameters = inspect.signature(function).parameters.values()
    known = [p.name for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY) and p.name != "self"]
    known += further
    place = function.__qualname__.removesuffix(".__init__") + "()"

    @functools.wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        check_keywords(place, kwargs, known)
        return function(*args, **kwargs)

    return checked
