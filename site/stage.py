"""Lays out the site's pages: the repository's own, which keep their places, and the references.

usage: stage.py PROGRAM FOLDER

PROGRAM prints the reference of the commands; the references of C are made of include/halflight/*.h, the ones of Python by the
site's builder of python/halflight. Links to files that the site does not show become plain text.
"""
import ast
import pathlib
import re
import shutil
import subprocess
import sys

from c_reference import reference_of

ROOT = pathlib.Path(__file__).resolve().parent.parent
TAB = ROOT / "build-web/page"
PAGES = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "docs", "examples", "integrations"]
# Where the site's first page begins: what a visitor can do at once.
HERO = """# Halflight

**Pictures of volumes in which matter attenuates light: hard and soft shadows, without noise, on ordinary processors.**
{tab}
"""
TRY = "\n[Open the viewer in this tab](tab/index.html){ .md-button .md-button--primary } [Gallery](docs/gallery/index.md){ .md-button }\n"
GALLERY = "\n[Gallery](docs/gallery/index.md){ .md-button .md-button--primary }\n"


def copy_pages(folder):
    for name in PAGES:
        source = ROOT / name
        if source.is_dir():
            shutil.copytree(source, folder / name, ignore=shutil.ignore_patterns("*.py", "*.c", "__pycache__", "slides", "tests"))
        elif source.exists():
            shutil.copy(source, folder / name)
    shutil.copy(ROOT / "site/site.css", folder)
    for page in [*folder.glob("integrations/**/*.md")]:
        if page.name != "README.md":
            page.unlink()


def flatten_links(folder):
    """Links to what the site does not show become the words alone."""
    for page in folder.rglob("*.md"):
        def one(link):
            target = link[2].split("#")[0]
            if re.match(r"[a-z]+:", target) or not target or (page.parent / target).exists():
                return link[0]
            return link[1].strip("`") if link[0].startswith("!") else f"`{link[1].strip('`')}`"

        page.write_text(re.sub(r"!?\[([^\]\n]*)\]\(([^)\s]+)\)", one, page.read_text()))


def write_program(program, page):
    """Each command's help, as the program prints it."""
    def help_of(*words):
        return subprocess.run([program, "help", *words], check=True, capture_output=True, text=True).stdout

    overview = help_of()
    commands = re.findall(r"^  ([a-z]+)  ", overview, re.M)
    text = ["# The program\n", "What `halflight help` prints. The manual, `man halflight`, says more of each option.\n",
            f"```text\n{overview}```\n"]
    for command in commands:
        text.append(f"## halflight {command}\n\n```text\n{help_of(command)}```\n")
    page.write_text("\n".join(text))


def write_python(page):
    """A heading for each public name of the package."""
    module = ast.parse((ROOT / "python/halflight/__init__.py").read_text())
    names = next(ast.literal_eval(one.value) for one in module.body
                 if isinstance(one, ast.Assign) and one.targets[0].id == "__all__")
    page.write_text("# Python\n\n" + "\n".join(f"::: halflight.{name}\n" for name in sorted(names, key=str.lower)))


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True)
    copy_pages(folder)
    (folder / "reference").mkdir()
    write_program(program, folder / "reference/program.md")
    (folder / "reference/c.md").write_text(reference_of(ROOT / "include/halflight"))
    write_python(folder / "reference/python.md")
    has_tab = TAB.is_dir()
    if has_tab:
        shutil.copytree(TAB, folder / "tab")
    front = folder / "README.md"
    front.write_text(re.sub(r"\A# Halflight\n", lambda _: HERO.format(tab=TRY if has_tab else GALLERY), front.read_text()))
    flatten_links(folder)


if __name__ == "__main__":
    main()
