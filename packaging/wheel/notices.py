#!/usr/bin/env python3
"""Puts the licences and notices of the libraries that a wheel holds into it, and refuses a wheel with a library that it may not hold.

usage: notices.py WHEEL ROOT SOURCES ZIG
ROOT and SOURCES are the folders of build_libraries.py, ZIG is the folder of ziglang. The wheel is changed in its place. Fails where a licence is none of
ALLOWED, as a GPL is not, where a library's notice is missing, and where a file in the wheel needs a library, or the build has one, that libraries.toml does
not list.
"""
import base64
import email
import hashlib
import io
import pathlib
import re
import sys
import tomllib
import zipfile

import pefile
from elftools.elf.elffile import ELFFile

ALLOWED = {"Apache-2.0", "Apache-2.0 WITH LLVM-exception", "BSD-2-Clause", "BSD-3-Clause", "IJG", "LicenseRef-Public-Domain", "MIT", "MPL-2.0", "Zlib",
           "ZPL-2.1", "bzip2-1.0.6", "libpng-2.0", "libtiff"}
ALLOWED_AS_FILES = {"LGPL-2.1-or-later"}  # of libraries that are files of their own, which can be replaced
# What the systems, and Python on Windows, have themselves.
SYSTEM = re.compile(r"lib(c|m|pthread|dl|rt)\.so\.[0-9]+|ld-linux.*|api-ms-win-crt-[\w-]+\.dll|(kernel32|shell32|ntdll|psapi|advapi32|bcrypt|python3)\.dll", re.I)


def fail(message):
    sys.exit(f"notices: {message}")


def terms(expression):
    return expression.split(" AND ")


def sources_of(sources, source):
    found = [folder for folder in sources.glob(f"{source}-*") if folder.is_dir()]
    if len(found) != 1:
        fail(f"{sources}: {len(found)} folders are named {source}-*: remove it, and fetch the sources again")
    return found[0]


def notices_of(name, library, sources, zig):
    """The texts of a library's notices, by their names in the wheel."""
    folder = sources_of(sources, library["source"]) if "source" in library else pathlib.Path("/")
    texts = {}
    for pattern in library["notices"]:
        base, pattern = (zig, pattern.removeprefix("ZIG/")) if pattern.startswith("ZIG/") else (folder, pattern.lstrip("/"))
        found = sorted(base.glob(pattern))
        if not found:
            fail(f"{base / pattern}, a notice of {name}, is missing: correct `notices` in libraries.toml")
        texts |= {f"{name}/{file.name}": file.read_bytes() for file in found}
    return texts


def check_licences(libraries):
    for name, library in libraries.items():
        alone = library["archives"] and all(".so" in file for file in library["archives"])
        for term in terms(library["licence"]):
            if term not in ALLOWED and not (alone and term in ALLOWED_AS_FILES):
                fail(f"{name}: a wheel may not hold a library under {term}: build it without")


def check_archives(libraries, root):
    listed = {file for library in libraries.values() for file in library["archives"]}
    for file in [*root.glob("lib/*.a"), *root.glob("lib/*.so.*")]:
        if file.name.endswith(".dll.a"):
            continue  # the names of a library that Python has, and no code
        if file.name not in listed and not (file.is_symlink() or re.sub(r"(\.so\.\d+).*", r"\1", file.name) in listed):
            fail(f"{file}: a library that libraries.toml does not list")


def needed_by(content):
    """The names of the libraries that a program or a library needs; None: it is neither."""
    if content.startswith(b"\x7fELF"):
        dynamic = ELFFile(io.BytesIO(content)).get_section_by_name(".dynamic")
        return [tag.needed for tag in dynamic.iter_tags("DT_NEEDED")]
    if content.startswith(b"MZ"):
        return [entry.dll.decode() for entry in pefile.PE(data=content).DIRECTORY_ENTRY_IMPORT]
    return None


def check_needed(libraries, files):
    """No file needs a library but the system's and those in the wheel, which are listed."""
    listed = {file for library in libraries.values() for file in library["archives"]}
    inside = {name: needed for name, content in files.items() if (needed := needed_by(content)) is not None}
    bundled = {}
    for name in inside:
        if ".libs/" in name:
            plain = re.sub(r"-[0-9a-f]{8}(?=\.so)", "", pathlib.Path(name).name)
            if re.sub(r"(\.so\.\d+).*", r"\1", plain) not in listed:
                fail(f"{name}: a library that libraries.toml does not list")
            bundled[pathlib.Path(name).name] = plain
    for name, needed in inside.items():
        for library in needed:
            if library not in bundled and not SYSTEM.fullmatch(library):
                fail(f"{name} needs {library}, which is not in the wheel")


def table(libraries, sources):
    lines = ["Libraries that are linked into Halflight, or lie beside it, in this wheel. Their licences and notices are in the folders here.", ""]
    for name, library in libraries.items():
        version = sources_of(sources, library["source"]).name[len(library["source"]) + 1:] if "source" in library else ""
        place = "a file of its own, which may be replaced" if any(".so" in file for file in library["archives"]) else "linked in"
        lines.append(f"{name:15} {version:16} {library['licence']:34} {place}")
    return "\n".join(lines) + "\n\nSources: Debian's source packages of these names and versions, and what packaging/wheel of Halflight's sources does with them.\n"


def rewrite(wheel, files, libraries, notices):
    """Adds the notices, and says in METADATA and RECORD that they are there."""
    info = next(name for name in files if name.endswith(".dist-info/METADATA")).rpartition("/")[0]
    metadata = email.message_from_bytes(files[f"{info}/METADATA"])
    every = sorted({term for library in libraries.values() for term in terms(library["licence"])} | {"Apache-2.0"})
    metadata.replace_header("License-Expression", " AND ".join(every))
    for name, content in notices.items():
        metadata["License-File"] = f"libraries/{name}"
        files[f"{info}/licenses/libraries/{name}"] = content
    body = metadata.get_payload()
    head = "".join(f"{key}: {value}\n" for key, value in metadata.items())
    files[f"{info}/METADATA"] = f"{head}\n{body}".encode()
    record = [f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b'=').decode()},{len(content)}"
              for name, content in files.items() if name != f"{info}/RECORD"]
    files[f"{info}/RECORD"] = ("\n".join([*record, f"{info}/RECORD,,"]) + "\n").encode()


def main():
    wheel, root, sources, zig = (pathlib.Path(word) for word in sys.argv[1:5])
    libraries = tomllib.loads((pathlib.Path(__file__).parent / "libraries.toml").read_text())
    system = "windows" if wheel.stem.endswith("win_amd64") else "linux"
    libraries = {name: library for name, library in libraries.items() if system in library.get("systems", ["linux"])}
    with zipfile.ZipFile(wheel) as archive:
        members = [member for member in archive.infolist() if not member.is_dir()]
        modes = {member.filename: member.external_attr for member in members}
        files = {member.filename: archive.read(member) for member in members}
    check_licences(libraries)
    check_archives(libraries, root)
    check_needed(libraries, files)
    notices = {name: text for library, of in libraries.items() for name, text in notices_of(library, of, sources, zig).items()}
    notices["LIBRARIES.txt"] = table(libraries, sources).encode()
    rewrite(wheel, files, libraries, notices)
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, content in files.items():
            member = zipfile.ZipInfo(name, (2020, 1, 1, 0, 0, 0))
            member.compress_type, member.external_attr = zipfile.ZIP_DEFLATED, modes.get(name, 0o100644 << 16)
            archive.writestr(member, content)
    print(table(libraries, sources))


if __name__ == "__main__":
    main()
