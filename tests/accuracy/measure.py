"""Errors of one scene's pictures, and what they cost."""
import json
import resource
import subprocess

import numpy

import scenes

METHODS = {  # title: settings
    "hard": {"shadows": "hard"},
    "paper": {"shadows": "soft", "soft_method": "paper"},
    "cascade": {"shadows": "soft", "soft_method": "cascade"},
    "sublights 2": {"shadows": "soft", "soft_method": "sublights", "light_samples": 2},
    "sublights 4": {"shadows": "soft", "soft_method": "sublights", "light_samples": 4},
    "sublights 8": {"shadows": "soft", "soft_method": "sublights", "light_samples": 8},
}
SPACINGS = [2, 1.5, 1, 0.75, 0.5, 0.35, 0.25]
COST_SIZE, COST_FRAMES = "512x512", 8


class Errors:
    """Root mean squares and 99.9 percentiles of differences. Pixels of the shadow factor count with their alpha: where
    next to nothing is seen, its shadow is nothing that shows."""

    def __init__(self, made, truth):
        alpha = truth.picture[:, :, 3]
        self.difference = made.shadow - truth.shadow
        self.shadow = numpy.sqrt((alpha * self.difference ** 2).sum() / alpha.sum())
        self.shadow_worst = numpy.quantile(abs(self.difference[alpha > 0.5]), 0.999) if (alpha > 0.5).any() else 0.0
        if not (alpha > 0.5).any():
            self.shadow_worst = numpy.quantile((abs(self.difference) * alpha) / alpha.max(), 0.999)
        colors = made.picture - truth.picture
        self.picture = numpy.sqrt((colors ** 2).mean())
        self.picture_worst = numpy.quantile(abs(colors).max(2), 0.999)


class Result:
    """Of one scene: errors and costs by method, hard shadows against hard ones by sheet spacing."""

    def __init__(self, name, text, truth):
        self.name, self.text, self.truth = name, text, truth
        self.errors, self.costs, self.spacing = {}, {}, {}


def scene(name, described, with_costs):
    truth, sharp = (scenes.reference(name, described, shadows) for shadows in ("soft", "hard"))
    result = Result(name, described["description"], truth)
    for method, settings in METHODS.items():
        made = scenes.sheets(name, described, method.replace(" ", "-"), **settings)
        if made is None:
            print(f"  {method}: not in this version, skipped")
            continue
        result.errors[method] = Errors(made, truth)
    for spacing in SPACINGS:
        made = scenes.sheets(name, described, f"spacing-{spacing}", "hard", sheet_spacing=spacing)
        result.spacing[spacing] = Errors(made, sharp)
    if with_costs:
        costs(name, described, result)
    return result


def processor_seconds(path, kind, frames):
    """Processor time of a program that makes so many frames, after one that is not counted by it."""
    def used():
        spent = resource.getrusage(resource.RUSAGE_CHILDREN)
        return spent.ru_utime + spent.ru_stime
    before = used()
    subprocess.run([scenes.PROGRAM, "bench", path, "--only", kind, "--frames", str(frames), "--threads", "1", "--size", COST_SIZE],
                   check=True, capture_output=True)
    return used() - before


def costs(name, described, result):
    """Processor time of a frame by one thread: what frames after the first add to a program's time."""
    seconds = {}
    for method in result.errors:
        settings = METHODS[method]
        kind = "hard" if settings["shadows"] == "hard" else f"soft_{settings['soft_method']}"
        path = scenes.WORK / f"{name}-cost.json"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps(scenes.changed(described, **settings)))
        more, one = processor_seconds(path, kind, 1 + COST_FRAMES), processor_seconds(path, kind, 1)
        seconds[method] = (more - one) / COST_FRAMES
    result.costs = {method: spent / seconds["hard"] for method, spent in seconds.items()}


def scene_costs(name, described):
    """A result that has costs alone."""
    result = Result(name, described["description"], None)
    result.errors = dict.fromkeys(METHODS)
    costs(name, described, result)
    return result
