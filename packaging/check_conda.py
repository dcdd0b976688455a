#!/usr/bin/env python3
"""The recipe of conda-forge renders for each of the systems and versions of Python that are named here.

usage: check_conda.py RECIPE
"""
import pathlib
import sys

import rattler_build

PYTHONS = ["3.11.* *_cpython", "3.12.* *_cpython", "3.13.* *_cp313", "3.14.* *_cp314"]


def main():
    recipe = rattler_build.Stage0Recipe.from_yaml(pathlib.Path(sys.argv[1]).read_text())
    variants = rattler_build.VariantConfig({"c_stdlib": ["sysroot"], "c_stdlib_version": ["2.17"], "python": PYTHONS})
    made = recipe.render(variants)
    if len(made) != len(PYTHONS):
        sys.exit(f"{sys.argv[1]}: {len(made)} packages are rendered for {len(PYTHONS)} versions of Python")
    for variant in made:
        print(variant.recipe.package.name, variant.recipe.package.version)


main()
