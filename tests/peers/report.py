"""The table of docs/performance.md between its markers, and docs/pictures/peers-*.png."""
import math
import os
import pathlib
import textwrap

import numpy
from PIL import Image

import job as jobs

DOCUMENT = jobs.ROOT / "docs" / "performance.md"
PICTURES = jobs.ROOT / "docs" / "pictures"
BEGIN, END = "<!-- peers -->", "<!-- end of peers -->"
AGAINST = {"off": "off", "hard": "hard", "soft": "cascade"}  # what a renderer's kind of shadows is held against
TITLES = {"off": "none", "hard": "hard", "soft": "soft", "paper": "soft, `paper`", "cascade": "soft, `cascade`",
          "sublights": "soft, 4x4 sub-lights"}
LACKS = {
    "Halflight": "exact multiple scattering; its own is an approximation ([scattering.md](scattering.md))",
    "VolPack": "soft shadows; a table for the values between voxels (voxels are classified, then blended); light more than 45 "
               "degrees off the view's main axis; shadows that begin at the object that casts them (they begin some voxels "
               "behind); more than one thread; new opacities without classifying anew",
    "OpenVDB vdb_render": "soft shadows, colours, transfer functions (its file holds extinctions). Its shadows stop at some "
                          "hundredths of the light. Its processor time is the whole process's",
    "VTK": "shadows, in its ray caster for processors",
    "ParaView": "soft shadows. It is made for graphics processors, and its OpenGL is software here",
    "Blender Cycles": "pictures without noise: time grows with the samples, and noise falls with their root. Each frame reads "
                      "and sorts the volume anew",
    "Mitsuba 3": "pictures without noise, as Blender; a table for the values between voxels. New programs are compiled within "
                 "its frame",
}


def luminance(picture):
    return numpy.clip(picture, 0, 1) @ (0.2126, 0.7152, 0.0722)


def compare(outcomes):
    """Each outcome gets `alike`, the correlation of its luminance with that of Halflight's picture of the same kind, and
    `ratio`, its processor time in that of Halflight's frame."""
    ours = {outcome.kind: outcome for outcome in outcomes if outcome.renderer == "Halflight"}
    for outcome in outcomes:
        model = ours[AGAINST.get(outcome.kind, "cascade")]
        outcome.alike = numpy.corrcoef(luminance(outcome.picture).ravel(), luminance(model.picture).ravel())[0, 1]
        outcome.ratio = outcome.processor_ms / model.processor_ms


def print_row(outcome):
    print(f"  {outcome.renderer} {outcome.version}, {outcome.kind}: {outcome.frame_ms:.0f} ms, "
          f"processor {outcome.processor_ms:.0f} ms, process {outcome.process_s:.1f} s, noise {outcome.noise:.4f}"
          + (f", alike {outcome.alike:.3f}, ratio {outcome.ratio:.2f}" if hasattr(outcome, "alike") else ""), flush=True)


def number(value):
    return f"{value:.0f}" if value >= 10 else f"{value:.1f}" if value >= 1 else f"{value:.2f}"


def picture_name(outcome):
    first = outcome.renderer.split()[0].lower()
    return f"peers-{first}-{outcome.kind}.png"


def save_pictures(outcomes):
    for old in PICTURES.glob("peers-*.png"):
        old.unlink()
    for outcome in outcomes:
        linear = numpy.clip(outcome.picture, 0, 1)
        encoded = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
        image = Image.fromarray((255 * encoded + 0.5).astype(numpy.uint8))
        image.quantize(96, dither=Image.Dither.NONE).save(PICTURES / picture_name(outcome), optimize=True)


def processor():
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            return line.split(":")[1].strip()
    return "unknown processor"


def table(outcomes):
    yield "| renderer | shadows | a frame, ms | processor, ms | of Halflight's | process, s | noise | alike |"
    yield "|---|---|---|---|---|---|---|---|"
    for outcome in outcomes:
        title = f"{outcome.renderer} {outcome.version}"
        kind = TITLES[outcome.kind] + (f"; {outcome.note}" if outcome.note else "")
        noise = f"{outcome.noise:.3f}" if outcome.noise else "none"
        yield (f"| {title} | {kind} | {number(outcome.frame_ms)} | {number(outcome.processor_ms)} | {number(outcome.ratio)} | "
               f"{number(outcome.process_s)} | {noise} | {outcome.alike:.3f} |")


def gallery(outcomes):
    """Rows of three pictures, each with its caption below."""
    outcomes = list({picture_name(outcome): outcome for outcome in outcomes}.values())
    for start in range(0, len(outcomes), 3):
        row = outcomes[start:start + 3]
        yield "| " + " | ".join(f"![{o.renderer}](pictures/{picture_name(o)})" for o in row) + " |"
        if start == 0:
            yield "|" + "---|" * len(row)
        yield "| " + " | ".join(f"{o.renderer}, {TITLES[o.kind]}" for o in row) + " |"


def text(job, outcomes, absent, loads):
    light = job["light"]
    width = math.degrees(2 * math.atan(light["radius"] / light["distance"]))
    yield "## Beside other renderers"
    yield ""
    yield from paragraph(
        f"`scripts/peers` lets others draw the same: Bonsai 256x256x256 u8 without the boards beside it, {job['size']}x{job['size']} "
        f"pixels, a parallel camera, one table of opacities and colours, light that is scattered once and alike in all directions, "
        f"from a disk {width:.0f} degrees wide or, for hard shadows, from its middle. Halflight's "
        f"sheets are a voxel apart. All ran in one go on {os.cpu_count()} threads of {processor()}, Halflight in turn with each of "
        f"the others. Load averages were {min(loads):.0f} to {max(loads):.0f}: where that is more than a few, times by the clock "
        "are long, and only processor times, of all threads together, are to be compared.")
    yield ""
    yield from table(outcomes)
    yield ""
    yield from paragraph(
        "*A frame* is the median of frames of a turning camera from a loaded, prepared volume; of vdb_render, Blender and Mitsuba "
        f"({job['samples']} samples a pixel) it is one frame. *Of Halflight's* is processor time in that of Halflight's frame with "
        "the same kind of shadows, soft ones by `cascade`. *Process* is a new one from start to end by the clock; of VolPack, VTK "
        "and ParaView with all their frames. *Noise* is the root mean square of what chance leaves in the pixels seen, of full "
        "scale, linear, found from two halves of the samples. "
        "*Alike* is the correlation of the luminance with Halflight's: framing and light agree.")
    yield ""
    yield "What each renderer lacks:"
    yield ""
    for name in dict.fromkeys(outcome.renderer for outcome in outcomes):
        yield from paragraph(f"* {name}: {LACKS[name]}.")
    for name, reason in absent.items():
        yield from paragraph(f"* {name}: not available here: {reason}.")
    yield ""
    yield from gallery(outcomes)


def paragraph(words):
    return textwrap.wrap(words, 125, subsequent_indent="  " if words.startswith("* ") else "", break_long_words=False)


def write(job, outcomes, absent, loads):
    save_pictures(outcomes)
    document = DOCUMENT.read_text()
    lines = "\n".join([BEGIN, *text(job, outcomes, absent, loads), END])
    head, rest = document.split(BEGIN)
    DOCUMENT.write_text(head + lines + rest.split(END)[1])
    print(f"wrote {DOCUMENT.relative_to(jobs.ROOT)}")
