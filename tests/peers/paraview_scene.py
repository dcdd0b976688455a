"""Runs in pvpython: ParaView's volume rendering, without shadows and with those of global illumination reach.

usage: paraview_scene.py JOB.json FRAMES     prints what was measured as JSON; pictures go to paraview-*.npy, linear RGB
"""
import json
import sys
import time

import numpy
from paraview import servermanager, simple
from paraview.vtk.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkRenderingCore import vtkWindowToImageFilter

job = json.load(open(sys.argv[1]))
frames = int(sys.argv[2])
camera, function, size = job["camera"], job["transfer_function"], job["size"]

view = simple.CreateView("RenderView")
view.ViewSize = [size, size]
view.Background = [0, 0, 0]
view.UseColorPaletteForBackground = 0
view.OrientationAxesVisibility = 0
view.MultiSamples = 0
view.UseLight = 0
light = simple.AddLight(view=view)
light.Coords, light.Type = "Scene", "Directional"
light.Position, light.FocalPoint = job["light"]["position"], camera["target"]

data = simple.LegacyVTKReader(FileNames=[job["work"] + "/volume.vtk"])
display = simple.Show(data, view)
display.Representation = "Volume"
colors = simple.GetColorTransferFunction("density")
colors.ColorSpace, colors.RGBPoints = "RGB", [x for point in function["color"] for x in point]
opacity = simple.GetOpacityTransferFunction("density")
opacity.Points = [x for value, o in function["opacity"] for x in (value, o, 0.5, 0)]
display.ColorArrayName = ["POINTS", "density"]
display.LookupTable, display.ScalarOpacityFunction = colors, opacity
display.ScalarOpacityUnitDistance = 1
display.VolumeRenderingMode = "GPU Based"


def look(turn=0.0):
    view.CameraParallelProjection = 1
    view.CameraParallelScale = camera["height"] / 2
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = camera["position"], camera["target"], camera["up"]
    view.GetActiveCamera().Azimuth(turn)


def frame():
    """(milliseconds by the clock, of all threads together)"""
    begin, processor = time.perf_counter(), time.process_time()
    view.StillRender()
    view.GetRenderWindow().WaitForCompletion()
    return 1e3 * (time.perf_counter() - begin), 1e3 * (time.process_time() - processor)


def save(name):
    grab = vtkWindowToImageFilter()
    grab.SetInput(view.GetRenderWindow())
    grab.ReadFrontBufferOff()
    grab.SetShouldRerender(0)
    grab.Update()
    pixels = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(size, size, -1)
    numpy.save(f"{job['work']}/paraview-{name}.npy", pixels[::-1, :, :3] / 255.0)


def measure(name, count, **settings):
    for key, value in settings.items():
        setattr(display, key, value)
    look()
    first, _ = frame()
    save(name)
    times = []
    for turn in range(count):
        look(5 * (turn + 1))
        times.append(frame())
    return {"first_ms": first, "frame_ms": [clock for clock, _ in times], "processor_ms": [processor for _, processor in times]}


result = {"version": simple.GetParaViewSourceVersion().split()[-1],
          "off": measure("off", frames, Shade=0)}
if hasattr(display, "GlobalIlluminationReach"):
    result["hard"] = measure("hard", min(frames, 1), Shade=1, GlobalIlluminationReach=1.0, VolumetricScatteringBlending=2.0)
print(json.dumps(result))
