"""Pictures for docs/accuracy.md: differences of the shadow factor, plots, and Mitsuba's picture beside ours."""
import matplotlib
import numpy
from PIL import Image

import measure
import scenes

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot  # noqa: E402  (after the choice of what it draws with)

FOLDER = scenes.ROOT / "docs" / "accuracy"
AMPLIFIED, GAP = 5, 4


def encode(linear):
    """Linear to 8 bits of sRGB."""
    linear = numpy.clip(linear, 0, 1)
    encoded = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return numpy.round(255 * encoded).astype("u1")


def zoomed(pixels, times=scenes.STRIDE):
    return pixels.repeat(times, 0).repeat(times, 1)


def signed(difference, weight):
    """Too bright is red, too dark blue, right is white; nothing there is grey."""
    amount = numpy.clip(AMPLIFIED * difference, -1, 1)
    red, blue = 1 - numpy.maximum(-amount, 0), 1 - numpy.maximum(amount, 0)
    colors = numpy.stack([red, numpy.minimum(red, blue), blue], 2)
    return numpy.round(255 * (weight[..., None] * colors + (1 - weight[..., None]) * 0.75)).astype("u1")


def row_of(tiles):
    tile = tiles[0].shape
    gap = numpy.full((tile[0], GAP, 3), 255, "u1")
    return numpy.hstack([part for each in tiles for part in (each, gap)][:-1])


def save(pixels, name):
    FOLDER.mkdir(parents=True, exist_ok=True)
    Image.fromarray(pixels).quantize(128).save(FOLDER / name, optimize=True)


def differences(results):
    """A strip a scene: its picture, the reference's shadow factor, and the methods' differences from it."""
    for result in results:
        picture = numpy.load(scenes.WORK / f"{result.name}-cascade.npy")[:, :, :3]
        alpha = result.truth.picture[:, :, 3]
        tiles = [encode(picture), zoomed(encode((alpha * result.truth.shadow)[..., None].repeat(3, 2)))]
        tiles += [zoomed(signed(result.errors[method].difference, alpha)) for method in measure.METHODS
                  if method in result.errors and method != "sublights 2"]
        save(row_of(tiles), f"{result.name}.png")


def plot(results):
    """Error by sub-lights and by sheet spacing."""
    figure, (left, right) = pyplot.subplots(1, 2, figsize=(11, 4.4))
    for result in results:
        counts = {1: "hard", 2: "sublights 2", 4: "sublights 4", 8: "sublights 8"}
        known = [(count, result.errors[method].shadow) for count, method in counts.items() if method in result.errors]
        if len(known) > 1:
            left.loglog(*zip(*known), "o-", label=result.name, base=2)
        right.loglog(measure.SPACINGS, [result.spacing[s].picture for s in measure.SPACINGS], "o-", label=result.name)
    left.set_xlabel("M (M x M parts of the light; 1: hard shadows)")
    left.set_ylabel("RMSE of the shadow factor")
    left.set_title("Sub-lights")
    if not left.lines:
        left.text(0.5, 0.5, "not in this version", ha="center", transform=left.transAxes)
    guide = numpy.array([0.25, 2])
    right.loglog(guide, 0.004 * guide ** 2, "k--", linewidth=1, label="spacing squared")
    right.axhline(0.006, color="k", linewidth=0.5)
    right.set_xticks(measure.SPACINGS, [f"{s:g}" for s in measure.SPACINGS])
    right.set_xticks([], minor=True)
    right.set_xlabel("sheet spacing, voxels")
    right.set_ylabel("RMSE of the picture, hard shadows")
    right.set_title("Sheet spacing")
    right.legend(fontsize=6, ncol=2)
    figure.tight_layout()
    FOLDER.mkdir(parents=True, exist_ok=True)
    figure.savefig(FOLDER / "plots.png", dpi=80)


def outside(rows):
    """A row a light: Mitsuba, the sheets, and ten times their difference."""
    lines = []
    for row in rows:
        brightest = row["truth"].max()
        tiles = [zoomed(encode((each / brightest)[..., None].repeat(3, 2)), 3) for each in (row["truth"], row["ours"]["sheets"])]
        difference = 2 * (row["ours"]["sheets"] - row["truth"]) / brightest
        tiles.append(zoomed(signed(difference, numpy.ones_like(difference)), 3))
        lines += [row_of(tiles), numpy.full((GAP, row_of(tiles).shape[1], 3), 255, "u1")]
    save(numpy.vstack(lines[:-1]), "mitsuba.png")
