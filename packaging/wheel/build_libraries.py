#!/usr/bin/env python3
"""Compiles the libraries of libraries.toml that have builds of their own: those by CMake, and those by a configure script.

usage: build_libraries.py SOURCES ROOT PROCESSOR JOBS     remove ROOT to compile all of them anew
SOURCES has the unpacked sources; ROOT has in bin/ the compilers cc and c++ and the tools ar and ranlib. What is built goes to ROOT/lib and ROOT/include.
"""
import pathlib
import re
import shutil
import subprocess
import sys
import tomllib

TOOLCHAIN = """\
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR {processor})
set(CMAKE_C_COMPILER {root}/bin/cc)
set(CMAKE_CXX_COMPILER {root}/bin/c++)
set(CMAKE_AR {root}/bin/ar)
set(CMAKE_RANLIB {root}/bin/ranlib)
set(CMAKE_FIND_ROOT_PATH {root})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
"""


def sources_of(sources, source):
    """The folder of a package's sources, and their version."""
    found = [folder for folder in sources.glob(f"{source}-*") if folder.is_dir()]
    if len(found) != 1:
        sys.exit(f"{sources}: {len(found)} folders are named {source}-*: remove it, and fetch the sources again")
    return found[0], found[0].name[len(source) + 1:]


def run(*command, **options):
    subprocess.run([str(word) for word in command], check=True, **options)


def copy_target(root, sources, build, library, version):
    """What `cmake --install` would copy of the targets alone, and their pkg-config file."""
    for name in library["archives"]:
        shutil.copy2(next(build.rglob(name)), root / "lib")
    for pattern in library["headers"]:
        pattern, _, folder = pattern.partition(":")
        base, pattern = (build, pattern.removeprefix("BUILD/")) if pattern.startswith("BUILD/") else (sources, pattern)
        place = root / "include" / folder
        place.mkdir(parents=True, exist_ok=True)
        for header in base.glob(pattern):
            shutil.copy2(header, place)
    (root / "lib/pkgconfig" / f"{library['package']}.pc").write_text(
        f"Name: {library['package']}\nDescription: {library['package']}\nVersion: {re.match('[0-9.]*[0-9]', version)[0]}\n"
        f"Libs: -L{root}/lib {library['links']}\nCflags: -I{root}/include -I{root}/include/{library['package']}\n")


def by_cmake(sources, root, name, library, jobs):
    folder, version = sources_of(sources, library["source"])
    build = root / "cmake" / name
    run("cmake", "-G", "Ninja", "-S", folder, "-B", build, f"-DCMAKE_TOOLCHAIN_FILE={root}/toolchain.cmake", "-DCMAKE_BUILD_TYPE=Release",
        f"-DCMAKE_INSTALL_PREFIX={root}", "-DCMAKE_INSTALL_LIBDIR=lib", "-DBUILD_SHARED_LIBS=OFF", "-DCMAKE_POSITION_INDEPENDENT_CODE=ON",
        *library["cmake"])
    if "targets" in library:
        run("cmake", "--build", build, "-j", jobs, "--target", *library["targets"])
        copy_target(root, folder, build, library, version)
    else:
        run("cmake", "--build", build, "-j", jobs)
        run("cmake", "--install", build)


def by_configure(sources, root, name, library, processor, jobs):
    folder, _ = sources_of(sources, library["source"])
    build = root / "configured" / name
    build.mkdir(parents=True, exist_ok=True)
    run(folder / "configure", f"--host={processor}-linux-gnu", f"--prefix={root}", f"CC={root}/bin/cc", f"AR={root}/bin/ar",
        f"RANLIB={root}/bin/ranlib", "LDFLAGS=-s", *library["configure"], cwd=build)
    run("make", "-s", f"-j{jobs}", "install", cwd=build)


def main():
    sources, root, processor, jobs = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3], sys.argv[4]
    (root / "toolchain.cmake").write_text(TOOLCHAIN.format(root=root, processor=processor))
    (root / "lib/pkgconfig").mkdir(parents=True, exist_ok=True)
    libraries = tomllib.loads((pathlib.Path(__file__).parent / "libraries.toml").read_text())
    for name, library in libraries.items():
        if (root / "made" / name).exists():
            continue
        if "cmake" in library:
            by_cmake(sources, root, name, library, jobs)
        elif "configure" in library:
            by_configure(sources, root, name, library, processor, jobs)
        (root / "made").mkdir(exist_ok=True)
        (root / "made" / name).touch()


main()
