"""The dock: light, softness, look, a picture, and what becomes of it."""
from __future__ import annotations

from typing import Any

import halflight
import numpy as np
from napari.qt.threading import thread_worker
from qtpy.QtCore import Qt
from qtpy.QtGui import QImage, QPixmap
from qtpy.QtWidgets import QComboBox, QFileDialog, QFormLayout, QHBoxLayout, QLabel, QPushButton, QSlider, QVBoxLayout, QWidget

from ._layers import scene_of

LOOKS = ("layers", "surface", "translucent", "xray", "smoke", "vessels")


class Dock(QWidget):
    """Renders the viewer's layers as they are seen now."""

    def __init__(self, napari_viewer: Any) -> None:
        super().__init__()
        self.viewer, self.image, self._worker = napari_viewer, None, None
        self._renderer = halflight.Renderer()
        self.azimuth, self.elevation, self.softness = self._slider(-90, 90, -40), self._slider(-90, 90, 45), self._slider(0, 40, 7)
        self.look = QComboBox()
        self.look.addItems(LOOKS)
        self.render_button, self.layer_button, self.save_button = (QPushButton(text) for text in ("Render", "As layer", "Save ..."))
        self.picture, self.message = QLabel(), QLabel()
        self.message.setWordWrap(True)
        form = QFormLayout()
        for text, widget in (("Light from left to right", self.azimuth), ("Light from below to above", self.elevation),
                             ("Softness", self.softness), ("Look", self.look)):
            form.addRow(text, widget)
        buttons = QHBoxLayout()
        for button, action in ((self.render_button, self.render), (self.layer_button, self.add_layer), (self.save_button, self.ask_where)):
            button.clicked.connect(lambda _=False, action=action: action())
            buttons.addWidget(button)
        whole = QVBoxLayout(self)
        whole.addLayout(form)
        whole.addLayout(buttons)
        whole.addWidget(self.picture)
        whole.addWidget(self.message)
        whole.addStretch()
        self._finish()

    @staticmethod
    def _slider(low: int, high: int, value: int) -> QSlider:
        slider = QSlider(Qt.Orientation.Horizontal)
        slider.setRange(low, high)
        slider.setValue(value)
        return slider

    def scene(self) -> halflight.Scene:
        """What would be rendered now."""
        return scene_of(self.viewer, look=self.look.currentText(), light=(self.azimuth.value(), self.elevation.value()),
                        softness=float(self.softness.value()))

    def render(self) -> None:
        """Render in a thread, so that napari goes on."""
        try:
            scene = self.scene()
        except (TypeError, ValueError) as problem:
            self.message.setText(str(problem))
            return
        self.render_button.setEnabled(False)
        self.message.setText("rendering ...")
        self._worker = thread_worker(self._renderer.render, connect={"returned": self.show_image, "errored": self._fail, "finished": self._finish})(scene)

    def show_image(self, image: halflight.Image) -> None:
        """Show a picture in the dock."""
        self.image = image
        self.message.setText(f"{image.size[0]} x {image.size[1]} pixels in {image.statistics['render_seconds']:.1f} s" if "render_seconds" in image.statistics else "")
        codes = np.ascontiguousarray(image.to_srgb8())
        shown = QImage(codes.data, codes.shape[1], codes.shape[0], codes.strides[0], QImage.Format.Format_RGBA8888)
        self.picture.setPixmap(QPixmap.fromImage(shown.copy()).scaledToWidth(min(360, codes.shape[1]), Qt.TransformationMode.SmoothTransformation))
        self._finish()

    def add_layer(self) -> Any:
        """Add the picture to the viewer; later pictures leave it out."""
        return self.viewer.add_image(self.image.to_srgb8(), name="Halflight", rgb=True, metadata={"halflight": True})

    def save(self, path: str) -> None:
        """Write the picture."""
        self.image.save(path)

    def ask_where(self) -> None:
        """Ask for a file, and write the picture."""
        path, _ = QFileDialog.getSaveFileName(self, "Save the picture", "picture.png", "Pictures (*.png *.exr *.npy *.tif *.jpg *.pdf)")
        if path:
            self.save(path)

    def _fail(self, problem: Exception) -> None:
        self.message.setText(str(problem))

    def _finish(self) -> None:
        self.render_button.setEnabled(True)
        for button in (self.layer_button, self.save_button):
            button.setEnabled(self.image is not None)
