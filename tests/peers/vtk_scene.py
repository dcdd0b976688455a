"""VTK's ray caster for processors (vtkFixedPointVolumeRayCastMapper), by Debian's python3-vtk9: frames of a turning camera.

usage: vtk_scene.py JOB.json FRAMES      prints what was measured as JSON; the picture goes to vtk-off.npy, linear RGB
"""
import json
import sys
import time

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

job = json.load(open(sys.argv[1]))
frames = int(sys.argv[2])
camera, function = job["camera"], job["transfer_function"]

reader = vtk.vtkStructuredPointsReader()
reader.SetFileName(job["work"] + "/volume.vtk")
reader.Update()
opacity, color = vtk.vtkPiecewiseFunction(), vtk.vtkColorTransferFunction()
for value, o in function["opacity"]:
    opacity.AddPoint(value, o)
for point in function["color"]:
    color.AddRGBPoint(*point)
look = vtk.vtkVolumeProperty()
look.SetScalarOpacity(opacity)
look.SetColor(color)
look.SetScalarOpacityUnitDistance(1)
look.SetInterpolationTypeToLinear()
look.ShadeOff()
mapper = vtk.vtkFixedPointVolumeRayCastMapper()
mapper.SetInputConnection(reader.GetOutputPort())
mapper.AutoAdjustSampleDistancesOff()
mapper.SetSampleDistance(1)
mapper.SetImageSampleDistance(1)
volume = vtk.vtkVolume()
volume.SetMapper(mapper)
volume.SetProperty(look)
renderer = vtk.vtkRenderer()
renderer.AddVolume(volume)
eye = renderer.GetActiveCamera()
eye.ParallelProjectionOn()
eye.SetParallelScale(camera["height"] / 2)
eye.SetPosition(camera["position"])
eye.SetFocalPoint(camera["target"])
eye.SetViewUp(camera["up"])
renderer.ResetCameraClippingRange()
window = vtk.vtkRenderWindow()
window.SetOffScreenRendering(1)
window.SetMultiSamples(0)
window.SetSize(job["size"], job["size"])
window.AddRenderer(renderer)


times, processor = [], []


def frame():
    begin, begin_processor = time.perf_counter(), time.process_time()
    window.Render()
    window.WaitForCompletion()
    times.append(1e3 * (time.perf_counter() - begin))
    processor.append(1e3 * (time.process_time() - begin_processor))


frame()
grab = vtk.vtkWindowToImageFilter()
grab.SetInput(window)
grab.ReadFrontBufferOff()
grab.Update()
picture = vtk_to_numpy(grab.GetOutput().GetPointData().GetScalars()).reshape(job["size"], job["size"], -1)
numpy.save(job["work"] + "/vtk-off.npy", picture[::-1, :, :3] / 255.0)
for _ in range(frames):
    eye.Azimuth(5)
    renderer.ResetCameraClippingRange()
    frame()
print(json.dumps({"version": vtk.vtkVersion.GetVTKVersion(),
                  "off": {"first_ms": times[0], "frame_ms": times[1:], "processor_ms": processor[1:]}}))
