#!/usr/bin/python3
"""Measures every method on every scene against the reference and writes docs/accuracy.md; see scripts/accuracy.

    scenes.py    scenes, and pictures of them by sheets and reference
    measure.py   errors and costs
    outside.py   Mitsuba 3 on a scene that both can render
    lines.py     lines where nothing casts a shadow: floors and balls
    faces.py     faces of cuts, and isosurfaces
    pictures.py  difference pictures and plots
    report.py    docs/accuracy.md
"""
import argparse
import os
import pathlib

import measure
import outside
import pictures
import report
import scenes


def arguments():
    parser = argparse.ArgumentParser(description="The renderer against the reference; writes docs/accuracy.md.")
    parser.add_argument("--only", default="", metavar="TEXT", help="scenes with TEXT in their name; docs stay as they are")
    parser.add_argument("--data", type=pathlib.Path, default=os.environ.get("HALFLIGHT_DATA", scenes.ROOT / "../shared/data"),
                        help="folder of real volumes (default $HALFLIGHT_DATA or ../shared/data)")
    parser.add_argument("--skip-mitsuba", action="store_true")
    parser.add_argument("--skip-costs", action="store_true")
    parser.add_argument("--reference-only", action="store_true", help="only make the reference's pictures")
    parser.add_argument("--lines-only", action="store_true", help="only the sections about lines, faces and isosurfaces, without the reference")
    parser.add_argument("--costs-only", action="store_true", help="only the section about costs, without the reference")
    return parser.parse_args()


def main():
    chosen = arguments()
    if chosen.lines_only:
        report.replace_lines(report.lines_and_faces())
        return
    results = []
    for name in scenes.names(chosen.only):
        print(name, flush=True)
        try:
            scene = scenes.load(name, pathlib.Path(chosen.data).resolve())
        except scenes.MissingData as missing:
            print(f"  skipped: there is no {missing}")
            continue
        if chosen.costs_only:
            results.append(measure.scene_costs(name, scene))
        elif chosen.reference_only:
            scenes.reference(name, scene, "hard")
            scenes.reference(name, scene, "soft")
        else:
            results.append(measure.scene(name, scene, not chosen.skip_costs))
    if chosen.reference_only or not results:
        return
    if chosen.costs_only:
        report.replace_costs(results)
        return
    report.print_table(results)
    if chosen.only:
        return
    pictures.differences(results)
    pictures.plot(results)
    truth = None if chosen.skip_mitsuba else outside.measure()
    if truth is not None:
        pictures.outside(truth[0])
    report.write(results, truth, report.lines_and_faces())


main()
