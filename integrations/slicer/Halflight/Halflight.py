"""3D Slicer module: the picture of a 3D view by Halflight, with its volume rendering, models, segmentations, camera and ROI.

Everything is read from the view's own renderer, in which Slicer keeps world matrices, transfer functions and cropping planes.
"""
from __future__ import annotations

from typing import Any

import halflight


def scene_of_view(renderer: Any, size: Any = None, **settings: Any) -> halflight.Scene:
    """The scene of a 3D view's renderer; Slicer's world is right, front, head. Keywords of `halflight.from_vtk`.

    Slicer lights from the eye: here a lamp stands beside it, and a sky fills the shadows.
    """
    words: dict[str, Any] = {"lights": halflight.Directional.beside_camera(-40, 45, angular_diameter_deg=7, intensity=1.2), "sky": 0.5}
    return halflight.from_vtk(renderer, size=size, **{**words, **settings})


def transfer_function_of(display_node: Any) -> halflight.TransferFunction:
    """The transfer function of a vtkMRMLVolumeRenderingDisplayNode."""
    return halflight.TransferFunction.from_vtk(display_node.GetVolumePropertyNode().GetVolumeProperty())


def volume_of(node: Any, display_node: Any = None) -> halflight.Volume:
    """The voxels of a vtkMRMLScalarVolumeNode with their place in the world, and their look where a display node is given."""
    import numpy as np
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkCommonMath import vtkMatrix4x4

    matrix = vtkMatrix4x4()
    node.GetIJKToRASMatrix(matrix)
    image = node.GetImageData()
    voxels = vtk_to_numpy(image.GetPointData().GetScalars()).reshape(image.GetDimensions()[::-1])
    affine = np.array([[matrix.GetElement(row, column) for column in range(4)] for row in range(4)])
    look = {} if display_node is None else {"transfer_function": transfer_function_of(display_node)}
    return halflight.Volume(voxels, affine=affine, name=node.GetName(), copy=True, **look)


try:
    import ctk
    import qt
    import slicer
    from slicer.ScriptedLoadableModule import ScriptedLoadableModule, ScriptedLoadableModuleLogic, ScriptedLoadableModuleWidget
except ImportError:  # outside of Slicer: the converters above
    slicer = None

if slicer is not None:

    class Halflight(ScriptedLoadableModule):
        """What the module is called."""

        def __init__(self, parent: Any) -> None:
            super().__init__(parent)
            parent.title, parent.categories = "Halflight", ["Rendering"]
            parent.helpText = "Pictures of the 3D view with hard and soft shadows. Install the package by pip_install() first."

    class HalflightLogic(ScriptedLoadableModuleLogic):
        """Renders a 3D view."""

        def render(self, view: int = 0, **settings: Any) -> halflight.Image:
            """The picture of a 3D view."""
            window = slicer.app.layoutManager().threeDWidget(view).threeDView().renderWindow()
            return halflight.Renderer().render(scene_of_view(window.GetRenderers().GetFirstRenderer(), tuple(window.GetSize()), **settings))

    class HalflightWidget(ScriptedLoadableModuleWidget):
        """A softness, a file and a button."""

        def setup(self) -> None:
            """Make the panel."""
            super().setup()
            form = qt.QFormLayout()
            self.layout.addLayout(form)
            self.softness, self.path, button = ctk.ctkSliderWidget(), ctk.ctkPathLineEdit(), qt.QPushButton("Save picture")
            self.softness.maximum, self.softness.value = 40, 7
            self.path.filters, self.path.currentPath = ctk.ctkPathLineEdit.Files | ctk.ctkPathLineEdit.Writable, "halflight.png"
            form.addRow("Softness of the light (degrees)", self.softness)
            form.addRow("Picture", self.path)
            form.addRow(button)
            button.connect("clicked()", self.save)
            self.layout.addStretch(1)

        def save(self) -> None:
            """Render and write."""
            light = halflight.Directional.beside_camera(-40, 45, angular_diameter_deg=self.softness.value, intensity=1.5)
            HalflightLogic().render(lights=light).save(self.path.currentPath)
