#!/usr/bin/python3
"""Measures other renderers beside Halflight and writes their table into docs/performance.md; see scripts/peers.

    scene.json        what all of them draw
    job.py            the same in the files that each of them reads
    measure.py        runs one renderer, and what it cost
    *_scene.py        run inside Blender, ParaView, Mitsuba, VTK; volpack.c uses VolPack's library
    report.py         the table and its pictures
"""
import argparse
import os
import pathlib
import sys

import job
import measure
import report


def arguments():
    parser = argparse.ArgumentParser(description="Other renderers beside Halflight; writes a part of docs/performance.md.")
    parser.add_argument("--only", choices=measure.RENDERERS, help="this renderer beside Halflight; docs stay as they are")
    parser.add_argument("--data", type=pathlib.Path, default=os.environ.get("HALFLIGHT_DATA", job.ROOT / "../shared/data"),
                        help="folder of real volumes (default $HALFLIGHT_DATA or ../shared/data)")
    parser.add_argument("--size", type=int, default=512, metavar="N", help="N x N pixels (default 512)")
    parser.add_argument("--samples", type=int, default=64, metavar="N",
                        help="of a pixel, where light is sampled by chance (default 64)")
    parser.add_argument("--program", type=pathlib.Path, default=job.ROOT / "build/halflight", metavar="PROGRAM")
    return parser.parse_args()


def load():
    return float(pathlib.Path("/proc/loadavg").read_text().split()[0])


def main():
    chosen = arguments()
    try:
        described = job.prepare(pathlib.Path(chosen.data).resolve(), chosen.size, chosen.samples)
    except job.MissingData as missing:
        sys.exit(f"{missing}: say with --data where the volumes are")
    ours, others, absent, loads = measure.Halflight(chosen.program), [], {}, []
    for name, renderer in measure.RENDERERS.items():
        if chosen.only not in (None, name):
            continue
        ours.bench()
        loads.append(load())
        print(f"{name}, load {loads[-1]:.1f}", flush=True)
        try:
            for outcome in renderer(described):
                others.append(outcome)
                report.print_row(outcome)
        except measure.Unavailable as reason:
            absent[name] = str(reason)
            print(f"  not available here: {reason}", flush=True)
    ours.bench()
    loads.append(load())
    outcomes = [*ours.outcomes(), *others]
    report.compare(outcomes)
    for outcome in outcomes:
        report.print_row(outcome)
    if chosen.only is None:
        report.write(described, outcomes, absent, loads)


main()
