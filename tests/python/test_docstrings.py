"""The docstrings of the public functions document the functions' own parameters."""
import inspect
import re

import pytest

import halflight


def is_python(made):
    return inspect.isfunction(made) or inspect.ismethod(made)


def public_functions():
    """The functions of the package, and the methods of its classes, that have a section of parameters."""
    for name in halflight.__all__:
        made = getattr(halflight, name)
        if inspect.isfunction(made):
            yield name, made
        elif inspect.isclass(made):
            yield from ((f"{name}.{word}", method) for word, method in inspect.getmembers(made, is_python) if not word.startswith("_"))


def documented(docstring):
    """The names at the beginnings of the lines that are not indented."""
    section = re.search(r"Parameters\n-+\n(.*?)(?=\n\n\w[\w ]*\n-+\n|\Z)", docstring, re.S)[1]
    heads = [line.split(" : ")[0] for line in section.splitlines() if line and not line.startswith(" ")]
    return {name.strip().lstrip("*") for head in heads for name in head.split(",")}


@pytest.mark.parametrize("function", [pytest.param(function, id=name) for name, function in public_functions()
                                      if "Parameters\n-" in (inspect.getdoc(function) or "")])
def test_parameters(function):
    parameters = {one.name: one.kind for one in inspect.signature(function).parameters.values() if one.name != "self"}
    named = {name for name, kind in parameters.items() if kind is not inspect.Parameter.VAR_KEYWORD}
    assert named <= documented(inspect.getdoc(function)) <= set(parameters)
