"""Every volume-rendering preset of 3D Slicer beside VTK, which Slicer renders with.

usage: presets.py HALFLIGHT PRESETS.xml DATA OUT [--only NAME]

Each preset is rendered of a CT and of an MR, or, where it is for values from 0 to 1, of the MR's as fractions of their greatest (FA), by the same camera and without light, by Halflight (shading flat, kernel linear)
and by VTK's vtkFixedPointVolumeRayCastMapper (shading off). OUT gets a picture of each pair, sheets of all of them and table.md:
how far the two are apart, in linear light, where the picture shows anything. VTK mixes colours as they are displayed; for the
figures it is given colours in linear light, and held against itself with steps of half a voxel's edge.
"""
import argparse
import json
import pathlib
import subprocess
import xml.etree.ElementTree

import numpy
import vtk
from PIL import Image, ImageDraw
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

SIZE = 256
VOLUMES = {"CT": "cranium_mha/cranium.mha", "MR": "stroke_t1_nii/T1.nii.gz", "FA": "stroke_t1_nii/T1.nii.gz"}
CLOSE = 0.02  # of mean difference, of white: what sampling and 8 bits explain


def linear(srgb):
    srgb = numpy.asarray(srgb, float)
    return numpy.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def displayed(light):
    light = numpy.clip(light, 0, 1)
    return numpy.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)


def numbers(text, width):
    read = [float(word) for word in text.split()]
    assert read[0] == len(read) - 1 and read[0] % width == 0, text
    rows = [read[n:n + width] for n in range(1, len(read), width)]
    for before, row in zip(rows, rows[1:]):
        row[0] = max(row[0], numpy.nextafter(before[0], numpy.inf))  # as Slicer keeps two points apart
    return rows


class Preset:
    def __init__(self, element):
        self.name = element.get("name")
        self.opacity = numbers(element.get("scalarOpacity"), 2)
        self.gradient = numbers(element.get("gradientOpacity"), 2)
        self.color = numbers(element.get("colorTransfer"), 4)
        # Of others' values it shows shells that are far thinner than any step: VTK's pictures then change as much with each step.
        self.of_fractions = element.get("effectiveRange") == "0 1"

    def property(self, in_linear_light):
        opacity, gradient, color = vtk.vtkPiecewiseFunction(), vtk.vtkPiecewiseFunction(), vtk.vtkColorTransferFunction()
        for point in self.opacity:
            opacity.AddPoint(*point)
        for point in self.gradient:
            gradient.AddPoint(*point)
        for point in self.color:
            color.AddRGBPoint(*point)
        if in_linear_light:
            exact, color = color, vtk.vtkColorTransferFunction()
            at = numpy.array([point[0] for point in self.color])
            for x in numpy.unique(numpy.concatenate([at, *[at[:-1] + t * numpy.diff(at) for t in numpy.arange(1, 64) / 64]])):
                color.AddRGBPoint(x, *linear(exact.GetColor(x)))
        look = vtk.vtkVolumeProperty()
        look.SetScalarOpacity(opacity)
        look.SetGradientOpacity(gradient)
        look.SetColor(color)
        look.SetInterpolationTypeToLinear()
        look.ShadeOff()
        return look


class Volume:
    def __init__(self, kind, halflight, data, out):
        source = data / VOLUMES[kind]
        info = json.loads(subprocess.run([halflight, "info", "--json", source], check=True, capture_output=True).stdout)
        self.kind, self.spacing = kind, info["spacing"]
        self.file = out / f"{kind}_{'x'.join(map(str, info['dimensions']))}_{info['type']}.raw"
        subprocess.run([halflight, "convert", source, self.file, "--quiet"], check=True)
        self.voxels = numpy.fromfile(self.file, info["type"]).reshape(info["dimensions"][::-1])
        if kind == "FA":
            self.voxels = (self.voxels / self.voxels.max()).astype(numpy.float32)
            self.voxels.tofile(self.file)
        self.header = out / f"{kind}.nhdr"
        kinds = {"int16": "short", "uint8": "uchar", "float32": "float"}
        self.header.write_text("NRRD0004\ndimension: 3\n" f"type: {kinds[str(self.voxels.dtype)]}\nendian: little\nencoding: raw\n"
                               f"sizes: {' '.join(map(str, self.voxels.shape[::-1]))}\n"
                               f"spacings: {' '.join(map(str, self.spacing))}\ndata file: {self.file.name}\n")
        lengths = (numpy.array(self.voxels.shape[::-1]) - 1) * self.spacing
        info = json.loads(subprocess.run([halflight, "info", "--json", self.header], check=True, capture_output=True).stdout)
        self.origin = numpy.array(info["origin"])
        self.target = self.origin + lengths / 2
        direction = numpy.array([-0.45, -1, 0.3])
        self.position = self.target + direction / numpy.linalg.norm(direction) * 600
        self.height = float(numpy.linalg.norm(lengths)) * 0.85
        self.image = vtk.vtkImageData()
        self.image.SetDimensions(*self.voxels.shape[::-1])
        self.image.SetSpacing(*self.spacing)
        self.image.SetOrigin(*self.origin)
        self.image.GetPointData().SetScalars(numpy_to_vtk(self.voxels.ravel().astype(numpy.float32), deep=1))

    def by_vtk(self, preset, in_linear_light, step=0.25):
        mapper = vtk.vtkFixedPointVolumeRayCastMapper()
        mapper.SetInputData(self.image)
        mapper.AutoAdjustSampleDistancesOff()
        mapper.SetSampleDistance(step)
        mapper.SetImageSampleDistance(1)
        volume = vtk.vtkVolume()
        volume.SetMapper(mapper)
        volume.SetProperty(preset.property(in_linear_light))
        renderer = vtk.vtkRenderer()
        renderer.AddVolume(volume)
        eye = renderer.GetActiveCamera()
        eye.ParallelProjectionOn()
        eye.SetParallelScale(self.height / 2)
        eye.SetPosition(self.position)
        eye.SetFocalPoint(self.target)
        eye.SetViewUp(0, 0, 1)
        renderer.ResetCameraClippingRange()
        window = vtk.vtkRenderWindow()
        window.SetOffScreenRendering(1)
        window.SetMultiSamples(0)
        window.SetSize(SIZE, SIZE)
        window.AddRenderer(renderer)
        window.Render()
        grab = vtk.vtkWindowToImageFilter()
        grab.SetInput(window)
        grab.ReadFrontBufferOff()
        grab.Update()
        picture = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(SIZE, SIZE, 3)
        return picture[::-1] / 255

    def by_halflight(self, halflight, presets, preset, out):
        scene = {
            "halflight": 1,
            "image": {"width": SIZE, "height": SIZE},
            "camera": {"type": "orthographic", "position": list(self.position), "target": list(self.target), "up": [0, 0, 1],
                       "height": self.height},
            "lights": [],
            "volumes": [{"file": self.header.name, "shading": "flat",
                         "transfer_function": {"file": f"{presets}:{preset.name}"}}],
            "render": {"sheet_spacing": 0.25, "kernel": "linear"},
        }
        (out / "scene.json").write_text(json.dumps(scene))
        done = subprocess.run([halflight, "render", out / "scene.json", "-o", out / "scene.npy", "--quiet"], capture_output=True,
                              text=True)
        if done.returncode != 0 or done.stderr:
            raise SystemExit(f"{preset.name}, {self.kind}: {done.stderr}")
        return numpy.load(out / "scene.npy")[..., :3].astype(float)


def compare(ours, theirs):
    """Mean difference where either shows anything, its signed part, and the correlation of the two."""
    seen = numpy.maximum(ours.max(-1), theirs.max(-1)) > 0.004
    if not seen.any():
        return None
    a, b = ours[seen], theirs[seen]
    spread = a.std() * b.std()
    return abs(a - b).mean(), (a - b).mean(), ((a - a.mean()) * (b - b.mean())).mean() / spread if spread > 0 else 1.0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("halflight")
    parser.add_argument("presets", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--only")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    presets = [Preset(e) for e in xml.etree.ElementTree.parse(args.presets).getroot().iter("VolumeProperty")]
    table = ["| preset | data | mean difference | signed | correlation | VTK, step 0.5 against 0.25 |", "|---|---|---|---|---|---|"]
    apart = 0
    for kind in VOLUMES:
        volume = Volume(kind, args.halflight, args.data, args.out)
        tiles = []
        for preset in presets:
            if args.only not in (None, preset.name) or preset.of_fractions != (kind == "FA"):
                continue
            ours = volume.by_halflight(args.halflight, args.presets.resolve(), preset, args.out)
            theirs, slicer = volume.by_vtk(preset, True), volume.by_vtk(preset, False)
            found, own = compare(ours, theirs), compare(volume.by_vtk(preset, True, 0.5), theirs)
            own = own[0] if own is not None else 0
            row = "nothing shows | | |" if found is None else " | ".join(f"{number:.4f}" for number in (*found, own))
            apart += found is not None and found[0] > CLOSE + own
            table.append(f"| {preset.name} | {kind} | {row} |")
            print(table[-1], flush=True)
            pair = Image.fromarray((numpy.hstack([displayed(ours), displayed(theirs), slicer]) * 255 + 0.5).astype(numpy.uint8))
            ImageDraw.Draw(pair).text((4, 4), f"{preset.name}: Halflight, VTK in linear light, VTK", fill=(255, 255, 0))
            pair.save(args.out / f"{kind}-{preset.name}.png")
            tiles.append(pair)
        if not tiles:
            continue
        rows = (len(tiles) + 1) // 2
        sheet = Image.new("RGB", (2 * tiles[0].width, rows * tiles[0].height))
        for n, pair in enumerate(tiles):
            sheet.paste(pair, (n % 2 * pair.width, n // 2 * pair.height))
        sheet.save(args.out / f"{kind}.png")
    (args.out / "table.md").write_text("\n".join(table) + "\n")
    print(f"{len(table) - 2} pairs, {apart} further apart than VTK from itself by {CLOSE}: {args.out}/table.md, CT.png, MR.png, FA.png")


main()
