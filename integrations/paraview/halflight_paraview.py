"""Halflight for ParaView: `save_picture(path)` of a render view in pvpython, and a filter that makes pictures of volumes.

As a plugin (Tools > Manage Plugins > Load New) it adds the filter "Halflight Picture"; as a macro (Macros > Import) it asks
for a file and saves the active view.
"""
from __future__ import annotations

from typing import Any

import halflight


def scene_of(view: Any = None, **settings: Any) -> halflight.Scene:
    """The scene of a render view, by default the active one; keywords of `halflight.from_vtk`."""
    from paraview import simple

    shown = view if view is not None else simple.GetActiveView()
    simple.Render(shown)
    width, height = shown.ViewSize
    return halflight.from_vtk(shown.GetRenderer(), size=settings.pop("size", (width, height)), **settings)


def save_picture(path: str, view: Any = None, **settings: Any) -> None:
    """Save what a render view shows, lit and shadowed: .png, .exr, .npy, ..."""
    halflight.Renderer().render(scene_of(view, **settings)).save(path)


try:
    from paraview.util.vtkAlgorithm import smdomain, smproperty, smproxy
    from vtkmodules.util.numpy_support import numpy_to_vtk
    from vtkmodules.util.vtkAlgorithm import VTKPythonAlgorithmBase
except ImportError:  # outside of ParaView
    smproxy = None

if smproxy is not None:

    @smproxy.filter(name="HalflightPicture", label="Halflight Picture")
    @smproperty.input(name="Input")
    @smdomain.datatype(dataTypes=["vtkImageData"], composite_data_supported=False)
    class HalflightPicture(VTKPythonAlgorithmBase):
        """A picture of image data as image data of 8-bit RGBA."""

        def __init__(self) -> None:
            super().__init__(nInputPorts=1, nOutputPorts=1, inputType="vtkImageData", outputType="vtkImageData")
            self._size, self._look = [512, 512], "auto"

        @smproperty.intvector(name="Size", default_values=[512, 512])
        def SetSize(self, width: int, height: int) -> None:
            self._size = [width, height]
            self.Modified()

        @smproperty.stringvector(name="Look", default_values="auto")
        def SetLook(self, look: str) -> None:
            self._look = look
            self.Modified()

        def RequestInformation(self, request: Any, inputs: Any, outputs: Any) -> int:
            from vtkmodules.vtkCommonExecutionModel import vtkStreamingDemandDrivenPipeline

            outputs.GetInformationObject(0).Set(vtkStreamingDemandDrivenPipeline.WHOLE_EXTENT(), [0, self._size[0] - 1, 0, self._size[1] - 1, 0, 0], 6)
            return 1

        def RequestData(self, request: Any, inputs: Any, outputs: Any) -> int:
            from vtkmodules.vtkCommonDataModel import vtkImageData

            codes = halflight.render(vtkImageData.GetData(inputs[0]), size=tuple(self._size), look=self._look).to_srgb8()
            made = vtkImageData.GetData(outputs)
            made.SetDimensions(self._size[0], self._size[1], 1)
            array = numpy_to_vtk(codes[::-1].reshape(-1, 4), deep=True)
            array.SetName("picture")
            made.GetPointData().SetScalars(array)
            return 1


if __name__ == "__vtkconsole__" or __name__ == "__main__":
    from paraview import simple as _simple

    if _simple.GetActiveView() is not None:
        save_picture("halflight.png")
