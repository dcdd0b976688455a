"""The reference of the C library as one page: each header's comments and declarations, in their order."""
import re

# A comment of a header: of a section, of the next declaration, or at the end of a line.
COMMENT = re.compile(r"/\*.*?\*/", re.S)


def _words(comment):
    """A comment's text without its stars."""
    lines = [re.sub(r"^\s*\* ?", "", line) for line in comment[2:-2].splitlines()]
    return "\n".join(line.strip() for line in lines).strip()


def _items(text):
    """[(comment, declaration)]: what stands between blank lines at the top of a header; either may be empty."""
    items, comment, at = [], "", 0
    while at < len(text):
        rest = text[at:]
        if not rest.strip():
            break
        at += len(rest) - len(rest.lstrip())
        rest = text[at:]
        if rest.startswith("/*"):
            if comment:
                items.append((comment, ""))
            found = COMMENT.match(rest)
            comment, at = found[0], at + found.end()
            if text[at:at + 2] == "\n\n":  # nothing follows at once: it is a section's or a header's
                items.append((comment, ""))
                comment = ""
            continue
        length = _declaration(rest)
        items.append((comment, rest[:length].rstrip()))
        comment, at = "", at + length
    return items


def _declaration(text):
    """The length of the first declaration, with comments at its last line's end, or of a preprocessor's line."""
    if text.startswith("#"):
        found = re.match(r"(.*\\\n)*.*", text)
        return found.end()
    depth, at = 0, 0
    while at < len(text):
        if text.startswith("/*", at):
            at = COMMENT.match(text, at).end()
            continue
        depth += {"{": 1, "}": -1}.get(text[at], 0)
        at += 1
        if text[at - 1] == ";" and depth == 0:
            tail = re.match(r"[ \t]*/\*.*?\*/", text[at:], re.S)
            return at + (tail.end() if tail else 0)
    return at


def _name(declaration):
    declaration = COMMENT.sub("", declaration)
    found = re.search(r"\b(hl_\w+)\s*\(", declaration) or re.search(r"\}\s*(\w+);", declaration) or re.search(
        r"\b(\w+);", declaration) or re.match(r"#define (\w+)", declaration)
    return found[1] if found else ""


def _body(text):
    """A header without its guard, includes and what is for C++."""
    text = re.sub(r"#ifdef __cplusplus\n.*?#endif\n", "", text, flags=re.S)
    text = re.sub(r"^#(ifndef|define) HALFLIGHT_\w+_H\n", "", text, flags=re.M)
    text = re.sub(r"^#include .*\n", "", text, flags=re.M)
    return re.sub(r"#endif\s*\Z", "", text)


def reference_of(folder):
    """The page's text."""
    page = ["# The C library\n", "All that the headers of `include/halflight` declare. A program includes `<halflight/halflight.h>`.\n"]
    for header in sorted(folder.glob("*.h")):
        page.append(f"## halflight/{header.name}\n")
        for comment, declaration in _items(_body(header.read_text())):
            words = re.sub(r"\Ahalflight/\w+\.h - ", "", _words(comment)) if comment else ""
            is_define = declaration.startswith("#define") and not declaration.startswith(("#define HL_API", "#define HL_WARN"))
            if declaration.startswith("#") and not is_define:
                continue
            if declaration:
                name = _name(declaration)
                page.append(f"### {name}\n" if name else "")
                page.append(f"```c\n{declaration}\n```\n")
            if words:
                page.append(re.sub(r"([<>*_\[\]])", r"\\\1", words) + "\n")
    return "\n".join(page)
