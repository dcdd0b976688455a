"""docs/accuracy.md: tables of what was measured."""
import re

import numpy

import faces
import lines
import measure
import scenes

PATH = scenes.ROOT / "docs" / "accuracy.md"


def number(value):
    return f"{value:.4f}".lstrip("0") if value < 1 else f"{value:.2f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


def methods_of(results):
    return [method for method in measure.METHODS if all(method in result.errors for result in results)]


def print_table(results):
    for result in results:
        for method, errors in result.errors.items():
            print(f"{result.name:12} {method:12} shadow {errors.shadow:.4f} {errors.shadow_worst:.3f}  picture {errors.picture:.4f} "
                  f"{errors.picture_worst:.3f}  cost {result.costs.get(method, float('nan')):.2f}")
        print(f"{result.name:12} hard against hard, spacing 0.5: {result.spacing[0.5].picture:.4f}")


def error_table(results, error, worst):
    """One row a scene: 'RMSE (99.9 percentile)' by method; the mean of the RMSE below."""
    methods = methods_of(results)
    rows = [[result.name] + [f"{number(getattr(result.errors[m], error))} ({number(getattr(result.errors[m], worst))})"
                             for m in methods] for result in results]
    means = [numpy.mean([getattr(result.errors[m], error) for result in results]) for m in methods]
    return table(["scene"] + methods, rows + [["**mean**"] + [f"**{number(mean)}**" for mean in means]])


def cost_table(results):
    methods = [method for method in methods_of(results) if method != "hard" and all(method in r.costs for r in results)]
    rows = [[result.name] + [f"{result.costs[m]:.2f}" for m in methods] for result in results]
    means = [numpy.mean([result.costs[m] for result in results]) for m in methods]
    return table(["scene"] + methods, rows + [["**mean**"] + [f"**{mean:.2f}**" for mean in means]])


def spacing_table(results):
    rows = [[result.name] + [number(result.spacing[s].picture) for s in measure.SPACINGS] for result in results]
    return table(["scene"] + [f"{s:g}" for s in measure.SPACINGS], rows)


def bar(text, value, limit, unit=""):
    return [text, f"{value:.3g}{unit}", f"{limit:g}{unit}", "held" if value <= limit else "missed"]


def bars(results):
    """What the program is held to, and whether it holds."""
    def ratios(method):
        return [r.errors[method].shadow / r.errors["paper"].shadow for r in results]

    def mean_ratio(method):
        return (sum(r.errors[method].shadow for r in results) / sum(r.errors["paper"].shadow for r in results))
    rows = [bar("hard shadows, spacing 0.5: greatest RMSE of the picture", max(r.spacing[0.5].picture for r in results), 0.006),
            bar("cascade: mean RMSE of the shadow factor, in those of paper", mean_ratio("cascade"), 1 / 3),
            bar("cascade: the same, worst scene", max(ratios("cascade")), 1)]
    if "sublights 4" in methods_of(results):
        rows.append(bar("sublights, M = 4: mean RMSE, in those of paper", mean_ratio("sublights 4"), 1 / 8))
    return table(["bar", "measured", "at most", ""], rows)


def section_of_page(title):
    """A section of the page as it stands: one that was not measured anew."""
    found = re.search(rf"\n## {title}\n.*?(?=\n## )", PATH.read_text(), flags=re.S)
    return found.group(0) if found else ""


def cost_section(results):
    if not all(r.costs for r in results):
        return section_of_page("Cost")
    limits = [(method, limit) for method, limit in (("cascade", 1.3), ("sublights 4", 2.5)) if method in methods_of(results)]
    rows = [bar(f"{method}: mean cost in hard frames", numpy.mean([r.costs[method] for r in results]), limit)
            for method, limit in limits]
    return f"""
## Cost

Processor time of a frame of {measure.COST_SIZE.replace("x", " x ")} pixels by one thread, after the first frame, in units of the hard-shadow frame; the camera
turns from frame to frame (`halflight bench`). The mean of {measure.COST_FRAMES} frames.

{table(["bar", "measured", "at most", ""], rows)}

{cost_table(results)}
"""


def outside_section(truth):
    if truth is None:
        return section_of_page("An outside truth")
    rows, samples = truth
    lines = [[row["light"], number(row["noise"]), number(row["sheets"]), f"{row['sheets'] / row['noise']:.2f}",
              number(row["reference"]), f"{row['reference'] / row['noise']:.2f}"] for row in rows]
    return f"""
## An outside truth

Mitsuba 3 (`volpath`, `max_depth` 2: single scattering) on a grid of 32 x 32 x 32 voxels, trilinear, extinction proportional to
density, albedo 1; Halflight with kernel `linear` and shading `none`. Both are means over pixels; one scale is fitted. RMSE in
units of the picture's maximum. Noise is Mitsuba's own with {samples} samples a pixel, from two independent halves.

{table(["light", "Mitsuba's noise", "sheets", "in noises", "reference", "in noises"], lines)}

![Mitsuba, the sheets, and ten times their difference](accuracy/mitsuba.png)

Left to right: Mitsuba, the sheets, their difference times ten (red: the sheets are brighter). Top to bottom: directional light,
point light, ball of light (cascade).
"""


def strips(results):
    methods = [m for m in methods_of(results) if m != "sublights 2"]
    parts = [f"""
## Where the differences are

Left to right: the picture (cascade), the reference's shadow factor, and the error of the shadow factor by {", ".join(methods)}:
red is too bright, blue too dark, full colour is a difference of 0.2.
"""]
    parts += [f"\n**{r.name}.** {r.text}\n\n![{r.name}](accuracy/{r.name}.png)\n" for r in results]
    return "".join(parts)


def lines_and_faces():
    """Measures the sections about lines, faces of cuts and isosurfaces."""
    open_lines = lines.section(lines.measure(measure.METHODS), table)
    shapes = {stretch: faces.shape(stretch) for stretch in faces.STRETCHES}
    return open_lines + "\n" + faces.section(faces.faces(measure.METHODS), shapes,
                                             lines.measure(measure.METHODS, iso=[{"value": faces.SURFACE}]), table)


def replace(title, following, written_sections):
    """Writes the sections from a title to the one before `following` anew; the others stay."""
    text = PATH.read_text()
    written, count = re.subn(rf"## {title}\n.*?(?=\n## {following})", lambda _: written_sections, text, flags=re.S)
    if count != 1:
        raise SystemExit(f"{PATH}: has no section {title!r}: run scripts/accuracy without options")
    PATH.write_text(written)
    print(f"wrote {PATH}")


def replace_lines(written_sections):
    """The sections about lines and faces."""
    replace("Lines", "Hard shadows", written_sections)


def replace_costs(results):
    """The section about costs."""
    replace("Cost", "An outside truth", cost_section(results).lstrip("\n"))


def write(results, truth, lines_and_faces):
    """lines_and_faces: the sections about them."""
    notes = (scenes.HERE / "notes.md").read_text()
    meshes = (scenes.HERE / "meshes.md").read_text()
    PATH.write_text(f"""# How exact the pictures are

`scripts/accuracy` writes this page; do not edit it by hand. It compares {len(results)} scenes of `tests/accuracy` (160 x 160
pixels, sheets 0.5 voxels apart unless said otherwise) with the reference. The reference is a ray marcher in double precision. It
shares no rendering code with the sheets, and marches to {scenes.LIGHT_POINTS} points of each light in steps of {scenes.STEP:g} voxels ({scenes.SHARP_STEP:g} where matter is as
sharp as the grid, {scenes.FINE_STEP:g} with hard shadows). Every fifth pixel of every fifth row is compared. *Far* lights are
directional, *near* ones stand within twice the scene's size.

Errors are root mean squares, in brackets 99.9 percentiles. The *shadow factor* is the fraction of light that reaches the visible
matter, 0 to 1 ([layers](layers.md)); its pixels count with their alpha. The *picture* is linear RGBA, 1 is full scale.

{bars(results)}

{notes.strip()}

## The shadow factor

`hard` is the error of having no penumbra at all.

{error_table(results, "shadow", "shadow_worst")}

## The picture

{error_table(results, "picture", "picture_worst")}

{lines_and_faces}
## Hard shadows, by sheet spacing

The picture with hard shadows against the reference's with hard shadows, RMSE; sheets a number of voxels apart.

{spacing_table(results)}

![Errors by sub-lights and by sheet spacing](accuracy/plots.png)
{cost_section(results)}{outside_section(truth)}
{meshes.strip()}
{strips(results)}""")
    print(f"wrote {PATH}")
