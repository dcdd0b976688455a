"""Implements `show`, the viewer in a notebook. The browser's end of the channel is src/server/page/widget.js. Messages
from the page ask for frames. Each of them is answered by one message with the picture in its buffer. Frames are
rendered by a thread of the widget's own, so that a newer request can cancel the unfinished frame. While something
moves, the page sends only the differences from a scene that it has sent as a whole. The thread keeps this scene for
each view.
"""
from __future__ import annotations

import base64
import contextvars
import io
import json
import os
import queue
import threading
import time
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from . import _page, picture_files
from ._library import call, choices_of, composed, context, ffi, lib, made, names, text_of
from .image import Image
from .render import Asked, Renderer, scene_for
from .scene import Scene
from .transfer import colormap_points
from .volume import Source, Volume

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["show"]

_MOST_PIXELS = 64 << 20


class _OutdatedError(Exception):
    """An exception that ends a frame for which nobody waits any more."""


class _NoBaseError(Exception):
    """An error: a page has sent a difference from a scene that is not kept any more."""


def _changed(base: Any, part: Any) -> Any:
    """The value of which `part` is the difference from `base`, as src/server/page/link.js makes it; `base` may change."""
    if "to" in part:
        return part["to"]
    for key, inner in part["in"].items():
        place = int(key) if isinstance(base, list) else key
        if "gone" in inner:
            del base[place]
        else:
            base[place] = _changed(base.get(place) if isinstance(base, dict) else base[place], inner)
    return base


def _with_files(scene: Scene, names_of_files: list[str | None]) -> Scene:
    """The scene with other names of its volumes' files. None stands for no file."""
    description = ffi.new("hl_scene_description *", lib.hl_scene_describe(scene._handle)[0])
    volumes = ffi.new("hl_scene_volume[]", description.volume_count)
    ffi.memmove(volumes, description.volumes, ffi.sizeof(volumes))
    keep = [None if name is None else ffi.new("char[]", name.encode()) for name in names_of_files]
    for volume, name in zip(volumes, keep, strict=True):
        volume.file = ffi.NULL if name is None else name
    description.volumes = volumes
    return Scene._of(made(lib.hl_scene_create, "hl_scene", lib.hl_scene_release, context, description))


class _Named:
    """A scene whose text names every volume: by its file, or as "array 0" for one made from an array."""

    def __init__(self, scene: Scene) -> None:
        struct = lib.hl_scene_describe(scene._handle)
        self.files = [None if one.file == ffi.NULL else text_of(one.file)
                      for one in struct.volumes[0:struct.volume_count]]
        shapes = [one.shapes != ffi.NULL for one in struct.volumes[0:struct.volume_count]]
        names_of_files = [f"array {n}" if file is None and not shape else file
                          for n, (file, shape) in enumerate(zip(self.files, shapes, strict=True))]
        self.scene = _with_files(scene, names_of_files)

    def read(self, text: str) -> Scene:
        """Read a scene's text. Its volumes are those of this scene; no file is opened."""
        raw = text.encode()
        return Scene._of(made(lib.hl_scene_from_json_like, "hl_scene", lib.hl_scene_release, context, raw, len(raw),
                              ffi.NULL, b"scene", self.scene._handle))

    def restored(self, text: str) -> Scene:
        """The scene of a text, whose volumes have the arrays of this scene."""
        return _with_files(self.read(text), self.files)


def _described(volume: Volume) -> dict[str, Any]:
    info = volume.info()
    struct = ffi.new("hl_volume_info *")
    struct.struct_size = ffi.sizeof("hl_volume_info")
    if lib.hl_volume_get_info(volume._handle, struct) != lib.HL_OK:
        raise RuntimeError("the volume is not known")
    unit = lib.hl_volume_unit(volume._handle)
    return {"type": info.type, "dimensions": list(struct.dimensions), "origin": info.origin.tolist(),
            "axes": (info.direction * info.spacing).T.tolist(), "range": list(info.range), "space": info.space, "unit": ffi.string(unit).decode() if unit else None,
            "histogram": [int(count) for count in info.histogram]}


def _start(scene: Scene, title: str) -> dict[str, Any]:
    """The first message to the page, which is the same as the program's server sends."""
    return {"title": title, "scene": json.loads(scene.to_json()), "volumes": [_described(one) for one in scene.volumes],
            "presets": names(lib.hl_preset_name), "looks": choices_of("look"), "rigs": choices_of("light-rig"),
            "colormaps": {name: colormap_points(name) for name in names(lib.hl_colormap_name)}}


def _jpeg(image: Image, quality: int) -> tuple[str, bytes]:
    """The picture's file for a frame that is seen only for a moment: a JPEG if Pillow is installed, else a PNG."""
    codes = image.to_srgb8(background=image.scene.background if image.scene.background != "transparent" else "black")
    try:
        from PIL import Image as Pillow
    except ImportError:
        return "image/png", image.encode("png")
    place = io.BytesIO()
    Pillow.fromarray(np.ascontiguousarray(codes[..., :3])).save(place, "jpeg", quality=quality)
    return "image/jpeg", place.getvalue()


def _encoded(image: Image, asked: dict[str, Any]) -> tuple[str, bytes]:
    if asked["format"] == "jpeg":
        return _jpeg(image, min(max(int(asked["quality"]), 10), 100))
    if asked["format"] in ("exr", "npy"):
        return "image/x-exr" if asked["format"] == "exr" else "application/octet-stream", image.encode(asked["format"])
    return "image/png", image.encode("png", depth=16 if asked["depth"] == 16 else 8, metadata=bool(asked.get("metadata", True)))


def _composed(scene: Scene, choices: dict[str, str]) -> Scene:
    """The scene with the look and the light rig that the page asks for by name."""
    options = {name: choices[word] for word, name in (("look", "look"), ("rig", "light-rig")) if choices.get(word)}
    return Scene._of(composed(lib.hl_scene_describe(scene._handle), 0, options)) if options else scene


class _Frames(threading.Thread):
    """Answers the page's requests one after the other. A frame is not rendered if a newer one has been requested."""

    def __init__(self, named: _Named, title: str, send: Any, keep: Callable[[bytes], None]) -> None:
        super().__init__(name="halflight.show", daemon=True)
        self.named, self.title, self.send = named, title, send
        self.keep = keep  # a function that receives the PNG of a frame at rest
        self.scene = named.scene  # the scene that a new page shows
        self.last: Image | None = None  # the last frame that was requested as a picture
        self.asked: queue.SimpleQueue[tuple[contextvars.Context, dict[str, Any]] | None] = queue.SimpleQueue()
        self.newest: dict[tuple[str, str], int] = {}
        # For each view, the newest scene that it has sent as a whole, and the number of that scene's frame.
        self.bases: dict[str, tuple[int, str]] = {}
        self.renderer, self.quick_renderer = Renderer(), Renderer()
        self.preview: Any = None  # the scene's volumes at coarser resolutions

    def ask(self, message: dict[str, Any]) -> None:
        if message["kind"] == "frame":
            self.newest[self._lane(message)] = message["number"]
        self.asked.put((contextvars.copy_context(), message))

    @staticmethod
    def _lane(message: dict[str, Any]) -> tuple[str, str]:
        return str(message["view"]), str(message.get("lane", ""))

    def run(self) -> None:
        while (asked := self.asked.get()) is not None:
            request, message = asked
            answer = {"view": message["view"], "number": message["number"]}
            buffers: list[bytes] = []
            try:
                found, buffers = getattr(self, f"_do_{message['kind']}")(message)
                answer |= found
            except _OutdatedError:
                pass
            except _NoBaseError as problem:
                answer |= {"problem": str(problem), "no_base": True}
            except Exception as problem:  # the page shows the error, and the thread continues
                answer["problem"] = str(problem)
            # In the request's context, the answer names the request it belongs to: ipykernel 7.4 routes the page's next
            # message by the request that the answer named, and a thread's own context names none.
            request.run(self.send, answer, buffers)

    def _quick(self, scene: Scene) -> Scene:
        """The scene that is rendered while something moves (halflight/preview.h). It may be the scene itself."""
        if self.preview is None:
            self.preview = made(lib.hl_preview_create, "hl_preview", lib.hl_preview_destroy, context, self.named.scene._handle)
        handle = made(lib.hl_preview_scene, "hl_scene", lib.hl_scene_release, self.preview, scene._handle)
        return scene if handle == scene._handle else Scene._of(handle)

    def _do_start(self, message: dict[str, Any]) -> tuple[dict[str, Any], list[bytes]]:
        return {"text": json.dumps(_start(self.scene, self.title))}, []

    def _do_complete(self, message: dict[str, Any]) -> tuple[dict[str, Any], list[bytes]]:
        return {"text": _composed(self.named.read(message["scene"]), message.get("choices", {})).to_json()}, []

    def _do_leave(self, message: dict[str, Any]) -> tuple[dict[str, Any], list[bytes]]:
        """Notes that a view was closed."""
        self.bases.pop(message["view"], None)
        self.newest = {lane: number for lane, number in self.newest.items() if lane[0] != message["view"]}
        return {}, []

    def _text(self, message: dict[str, Any]) -> str:
        """The scene's text of a requested frame. If the view has sent the whole scene, it is kept for later
        differences.
        """
        if "base" not in message:
            if not message.get("lane"):
                self.bases[message["view"]] = message["number"], message["scene"]
            return str(message["scene"])
        number, base = self.bases.get(message["view"], (None, ""))
        if number != message["base"]:
            raise _NoBaseError("the kernel no longer holds the scene that this one differs from: send it whole")
        try:
            return json.dumps(_changed(json.loads(base), json.loads(message["scene"])))
        except (AttributeError, IndexError, KeyError, TypeError, ValueError):
            raise ValueError("the message is no difference from the scene of its base") from None

    def _do_frame(self, message: dict[str, Any]) -> tuple[dict[str, Any], list[bytes]]:
        lane, text = self._lane(message), self._text(message)

        def stop_if_outdated(*_: object) -> None:
            if self.newest[lane] != message["number"]:
                raise _OutdatedError

        stop_if_outdated()
        began, worked = time.monotonic(), time.process_time()
        scene = self.named.read(text)
        if scene.size[0] * scene.size[1] > _MOST_PIXELS:
            raise ValueError(f"{scene.size[0]} x {scene.size[1]} pixels are more than the viewer's {_MOST_PIXELS}")
        read = time.monotonic()
        quick = self._quick(scene) if message.get("moving") else scene
        renderer = self.renderer if quick is scene else self.quick_renderer
        image = renderer.render(quick, progress=stop_if_outdated)
        rendered = time.monotonic()
        self.last = image
        kind, content = _encoded(image, message)
        if _is_still(message):
            self.keep(content)
        times = {"read": 1e3 * (read - began), "render": 1e3 * (rendered - read),
                 "encode": 1e3 * (time.monotonic() - rendered), "processor": 1e3 * (time.process_time() - worked)}
        return {"type": kind, "times": times}, [content]


def _is_still(message: dict[str, Any]) -> bool:
    """Whether a requested frame is a frame at rest, which a page without a kernel shows (widget.js)."""
    return message["format"] == "png" and message["depth"] == 8 and not message.get("moving") and not message.get("lane")


def _make_class() -> Any:
    """The widget's class. It is made at the first use, because only notebooks need anywidget."""
    try:
        import anywidget
        import traitlets
    except ImportError:
        raise ImportError("halflight.show() needs anywidget: pip install anywidget") from None

    traits: Any = traitlets

    class Viewer(anywidget.AnyWidget):  # type: ignore[misc]
        """A viewer of one scene, whose camera and lights are traits: `observe` them, and set them.

        Attributes
        ----------
        camera : Camera
        lights : tuple of Light
        scene : Scene
            The scene that the page shows now.
        """

        camera = traits.Any()
        lights = traits.Any()
        _esm = _page.module()
        sheet = traits.Unicode(_page.style()).tag(sync=True)
        height = traits.Int(560).tag(sync=True)
        # The last frame at rest, as a PNG. A page with a kernel has this frame already, and an echo would send each frame once more.
        still = traits.Bytes().tag(sync=True, echo_update=False)

        def __init__(self, scene: Scene, title: str, height: int) -> None:
            super().__init__(height=height)
            self._named = _Named(scene)
            self._text = self._named.scene.to_json()
            self._from_page = True  # changes of the traits that come from the page are not sent to the page
            self.camera, self.lights = scene.camera, scene.lights
            self._from_page = False
            self.observe(self._set_from_python, ["camera", "lights"])
            self._frames = _Frames(self._named, title, self.send, lambda png: self.set_state({"still": png}))
            self._frames.start()
            self.on_msg(self._on_message)

        def _on_message(self, _: object, message: dict[str, Any], __: object) -> None:
            if message["kind"] == "arrived":
                self._arrive(message["scene"])
            elif message["kind"] in ("start", "complete", "frame", "leave"):
                self._frames.ask(message)

        def _arrive(self, text: str) -> None:
            """Take the scene that a page has sent as its newest one."""
            scene = self._named.read(text)
            self._text, self._from_page = text, True
            try:
                with self.hold_trait_notifications():
                    self.camera, self.lights = scene.camera, scene.lights
            finally:
                self._from_page = False
            self._frames.scene = scene

        def _set_from_python(self, change: Any) -> None:
            if self._from_page:
                return
            scene = self._named.read(self._text).replace(**{change["name"]: change["new"]})
            self._text, self._frames.scene = scene.to_json(), scene
            self.send({"show": self._text})

        @property
        def scene(self) -> Scene:
            """The scene that the page shows now."""
            return self._named.restored(self._text)

        def picture(self) -> Image:
            """The picture that the page shows now, in the scene's size."""
            last = self._frames.last
            current = self._named.read(self._text)
            if last is not None and last.scene == current:
                return last
            return Renderer().render(current)

        def to_html(self, path: str | os.PathLike[str] | None = None, *, turntable: int = 0) -> str:
            """A page that needs no other file. It shows the last frame or, with `turntable`, the frames of a turn,
            which a person turns by dragging.

            Parameters
            ----------
            path : path, optional
                A file to which the page is also written.
            turntable : int
                The number of frames of one turn about the picture's vertical axis; 0 for the last frame alone.
            """
            from .static_page import page_of

            text = page_of(self.picture(), turntable)
            if path is not None:
                picture_files.write_whole(os.fspath(path), text.encode())
            return text

        def _repr_mimebundle_(self, **words: Any) -> Any:
            """The widget, and its picture for pages that run no widgets, such as GitHub's."""
            bundle = super()._repr_mimebundle_(**words)
            plain, *rest = bundle if isinstance(bundle, tuple) else (bundle,)
            if plain is None:
                return bundle
            self.still = self.picture()._repr_png_()
            plain = {**plain, "image/png": base64.b64encode(self.still).decode()}
            return (plain, *rest) if isinstance(bundle, tuple) else plain

        def close(self) -> None:
            """End the widget and its thread."""
            self._frames.asked.put(None)
            super().close()

    return Viewer


_classes: list[Any] = []


def show(volume: Source, *, height: int = 560, title: str | None = None, **asked: Unpack[Asked]) -> Any:
    """A viewer in a notebook: turn the volume, drag its lights, edit its transfer function.

    Needs anywidget (``pip install anywidget``); frames come through the notebook's own connection, so that it works
    in JupyterLab, VS Code and Colab and behind a hub. Pillow, where it is installed, makes moving pictures smaller.
    A notebook that is exported to HTML with the state of its widgets shows the last frame.

    Parameters
    ----------
    volume : path, array, Volume, Scene or an object that has an array
        As for `render`.
    height : int
        The height of the viewer, in pixels of the page.
    title : str, optional
        The title above the picture.
    **asked
        The keywords of `render` that say what is seen: `cmap`, `tf`, `shadows`, `lights`, `camera`, ...

    Returns
    -------
    anywidget.AnyWidget
        Its ``scene`` is the `Scene` that a person has arrived at; ``camera`` and ``lights`` are traits, which follow the page
        and lead it: ``widget.observe(print, "camera")``, ``widget.lights = [Directional(...)]``. ``to_html("page.html")``
        keeps the last frame.
    """
    if not _classes:
        _classes.append(_make_class())
    scene = scene_for(volume, **asked)
    return _classes[0](scene, title if title is not None else _title_of(volume), height)


def _title_of(volume: Source) -> str:
    if isinstance(volume, str):
        return volume.rsplit("/", 1)[-1]
    return f"{type(volume).__name__}"
