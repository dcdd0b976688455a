"""Makes one module for notebooks from the files of the viewer's page, which import each other."""
from __future__ import annotations

import functools
import re
from importlib.resources import files
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable

_IMPORT = re.compile(r'^import \{([^}]*)\} from "\./(\w+)\.js";\n', re.M)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:function|class|const) (\w+))", re.M)


def _read(name: str) -> str:
    return (files("halflight") / "page" / name).read_text(encoding="utf-8")


def join(name: str, read: Callable[[str], str], joined: dict[str, str]) -> None:
    """The text of a file as a function that returns the file's exports, after the texts of the files that it imports.
    read: gives a file's text by its name.
    """
    if name in joined:
        return
    text = read(f"{name}.js")
    uses = _IMPORT.findall(text)
    for _, used in uses:
        join(used, read, joined)
    given = "".join(f"const {{{names}}} = ${used};\n" for names, used in uses)
    exported = ", ".join(_EXPORT.findall(text))
    body = _EXPORT.sub("", _IMPORT.sub("", text))
    joined[name] = f"const ${name} = (() => {{\n{given}{body}\nreturn {{ {exported} }};\n}})();\n"


@functools.cache
def module() -> str:
    """The JavaScript of the widget's module, in the form that anywidget needs."""
    joined: dict[str, str] = {}
    join("widget", _read, joined)
    return "".join(joined.values()) + "export default { render: $widget.render };\n"


@functools.cache
def style() -> str:
    """CSS."""
    return _read("style.css")
