"""Defines meshes: triangles, spheres and tubes in the world of the volumes. Meshes cast shadows on volumes, and
receive the shadows of volumes.
"""
from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any, Unpack

import numpy as np

from . import _settings, colors, mesh_sources
from ._library import call, context, ffi, lib, made, path_bytes, text_of
from ._words import check_keywords
from .arrays import matrix_of
from .keywords import MaterialSettings, MeshSettings
from .mesh_sources import Surface
from .volume import as_volume

__all__ = ["Mesh", "MeshLook"]


class MeshLook(MeshSettings, MaterialSettings, total=False):
    """Keywords of `Mesh` for the mesh's look and its place.

    Parameters
    ----------
    name : str
        The mesh's name.
    color : colour
        A name or "#rrggbb" (sRGB), or linear RGB. It is multiplied by the vertices' colours if they are given.
    """

    name: str
    color: float | Sequence[float] | str


_MATERIAL = _settings.names(lib.HL_SETTINGS_MATERIAL)
_FIELDS = _settings.names(lib.HL_SETTINGS_MESH, "color")


class Mesh:
    """Triangles, spheres and lines that share a scene with volumes.

    Parameters
    ----------
    source : path, array_like of shape (n, 3), or an object that has vertices and faces, optional
        A PLY, STL, OBJ, glTF or VTK PolyData file; vertices (x, y, z) in world units; a data set of PyVista or VTK,
        which shows its surface if it is no PolyData; a mesh of trimesh or meshio. The data are copied.
    triangles : array_like of int, shape (m, 3), optional
        Indices of vertices, if the vertices are given as an array. A triangle whose vertices run counter-clockwise
        faces the viewer.
    normals : array_like, shape (n, 3), optional
        The normals at the vertices, of any length.
    colors : array_like, shape (n, 3) or (n, 4), optional
        The colours of the vertices, with or without opacity. Numbers of uint8 are sRGB; all others are linear from 0
        to 1.
    face_colors : array_like, shape (m, 3) or (m, 4), optional
        The colours of the triangles.
    spheres : array_like, shape (n, 3) or (n, 4), optional
        The spheres' centres, with their radii unless `radius` gives one radius for all. Spheres are exact.
    sphere_colors : array_like, shape (n, 3) or (n, 4), optional
        The colours of the spheres.
    lines : sequence of array_like, each of shape (n, 3) or (n, 4), optional
        The points of lines, which are drawn as tubes, with their radii unless `radius` gives one radius for all.
    line_colors : array_like, shape (n, 3) or (n, 4), optional
        The colours of the points of all lines, one line after the other.
    radius : float, optional
        The radius of spheres and lines that have no radius of their own. For the lines and points of a data set, the
        default is a 400th of the set's diagonal.
    scalars : str, array_like or False, optional
        The values that colour the mesh: the name of one of its arrays, at vertices or cells, or the values themselves.
        Arrays of 8-bit RGB and RGBA are colours themselves. The default is the mesh's active array, if it has one and
        no colour is given. False stands for no array.
    cmap, clim, log_scale : optional
        The colours of `scalars`, as for `render`. The default is viridis over all values.
    nan_color : colour
        The colour of values that are no numbers.
    affine : array_like, shape (4, 4), optional
        A matrix by which the vertices are moved first, such as an actor's matrix.
    **look : MeshLook
        `name`, `color`, `opacity`, `smooth`, `visible`, ..., and the material: see `halflight.keywords`.

    Examples
    --------
    >>> floor = Mesh([(0, 0, 0), (9, 0, 0), (9, 9, 0), (0, 9, 0)], [(0, 1, 2), (0, 2, 3)], color="white")
    >>> floor.triangle_count
    2
    >>> Mesh(spheres=[(0, 0, 0), (2, 0, 0)], radius=0.8, sphere_colors=[(1, 0, 0), (0, 0, 1)], color=1)
    <halflight.Mesh of 2 spheres>
    >>> Mesh(lines=[[(0, 0, 0), (0, 0, 5)]], radius=0.2).triangle_count
    96
    """

    __slots__ = ("__weakref__", "_file", "_handle", "look")

    def __init__(self, source: Any = None, triangles: Any = None, *, normals: Any = None, colors: Any = None,
                 face_colors: Any = None, spheres: Any = None, sphere_colors: Any = None,
                 lines: Sequence[Any] | None = None, line_colors: Any = None, radius: float | None = None,
                 scalars: Any = None, cmap: Any = None, clim: Any = None, log_scale: bool = False, nan_color: Any = 0.5,
                 affine: Any = None, **look: Unpack[MeshLook]) -> None:
        check_keywords("Mesh()", look, ["normals", "colors", "face_colors", "spheres", "sphere_colors", "lines",
                                        "line_colors", "radius", "scalars", "cmap", "clim", "log_scale", "nan_color",
                                        "affine", *MeshLook.__annotations__])
        arrays = {"triangles": triangles, "normals": normals, "colors": colors, "face_colors": face_colors,
                  "spheres": spheres, "sphere_colors": sphere_colors, "lines": lines, "line_colors": line_colors}
        self.look: Mapping[str, Any] = dict(look)
        self._handle: Any = None
        self._file: str | None = None
        mapping = {"scalars": scalars, "cmap": cmap, "clim": clim}
        if isinstance(source, (Mesh, str, os.PathLike)):
            for word, value in mapping.items():
                if value is not None:
                    raise TypeError(f"{word} is for arrays and data sets: a {'Mesh' if isinstance(source, Mesh) else 'file'}"
                                    " has its own colours")
        if isinstance(source, Mesh) and affine is None:
            self._file, self._handle, self.look = source._file, source._handle, {**source.look, **look}
            return
        if isinstance(source, (str, os.PathLike)):
            for word, value in arrays.items():
                if value is not None:
                    raise TypeError(f"{word}: a file says them itself")
            self._file = os.fspath(source)
            self._handle = made(lib.hl_mesh_load, "hl_mesh", lib.hl_mesh_release, context, path_bytes(source),
                                path=self._file)
            if affine is None:
                return
            source, self._file = Mesh._of(self._handle, None, dict(look)), None
        if isinstance(source, Mesh):
            self.look = {**source.look, **look}
            source, given = source._arrays()
            arrays.update(given)
        elif source is not None and triangles is None:
            source = self._take(mesh_sources.find(source), arrays, mapping, radius, log_scale, nan_color)
        elif source is None and spheres is None and lines is None:
            raise TypeError("Mesh(): give a file, vertices and triangles, spheres or lines")
        elif source is not None and scalars is not None and scalars is not False:
            surface = mesh_sources.Surface(np.asarray(source), np.asarray(triangles))
            self._paint(surface, arrays, mapping, log_scale, nan_color)
        elif any(value is not None for value in (cmap, clim)):
            raise TypeError("Mesh(): cmap and clim colour scalars: give scalars=, too")
        self._handle = _create(source, arrays, radius, affine)

    def _paint(self, surface: Surface, arrays: dict[str, Any], mapping: Mapping[str, Any], log: bool, nan_color: Any) -> None:
        """Colour vertices or triangles, single points and lines by an array."""
        cmap = "viridis" if mapping["cmap"] is None else mapping["cmap"]
        rows, of_cells = mesh_sources.painted("Mesh(): ", surface, mapping["scalars"], cmap, mapping["clim"], log, nan_color)
        self.look = {"color": 1.0, **self.look}
        single, lines = len(surface.vertices), len(surface.lines)
        if of_cells:
            arrays["face_colors"] = rows[single + lines:] if len(surface.triangles) else None
            of_lines = [np.repeat(row[None], len(line), 0) for row, line in zip(rows[single:single + lines], surface.lines, strict=True)]
            of_vertices = rows[:single]
        else:
            arrays["colors"] = rows if len(surface.triangles) else None
            of_lines, of_vertices = [rows[line] for line in surface.lines], rows[surface.vertices]
        if single:
            arrays["sphere_colors"] = of_vertices
        if lines:
            arrays["line_colors"] = np.vstack(of_lines)

    def _take(self, surface: Surface, arrays: dict[str, Any], mapping: dict[str, Any], radius: float | None, log: bool,
              nan_color: Any) -> Any:
        """The vertices of another package's mesh; its other arrays go to `arrays`."""
        colored = "color" in self.look or arrays["colors"] is not None or arrays["face_colors"] is not None
        if mapping["scalars"] is None and mapping["cmap"] is None and mapping["clim"] is None and colored:
            mapping["scalars"] = False
        if mapping["scalars"] is None:
            mapping["scalars"] = surface.active
            if surface.active is None and (mapping["cmap"] is not None or mapping["clim"] is not None):
                raise TypeError("Mesh(): cmap and clim colour scalars, of which the mesh has none active: give scalars=")
        if mapping["scalars"] is not None and mapping["scalars"] is not False:
            self._paint(surface, arrays, mapping, log, nan_color)
        points = np.asarray(surface.points, dtype=np.float64)
        own = surface.of_points.get("radius")
        size = float(np.linalg.norm(np.ptp(points, axis=0))) / 400 if radius is None else radius
        radii = np.full(len(points), size) if own is None or radius is not None else np.asarray(own, dtype=float)
        solid = np.column_stack([points, radii])
        if len(surface.vertices) and arrays["spheres"] is None:
            arrays["spheres"] = solid[surface.vertices]
        if len(surface.lines) and arrays["lines"] is None:
            arrays["lines"] = [solid[line] for line in surface.lines]
        if len(surface.triangles) == 0:
            if arrays["spheres"] is None and arrays["lines"] is None:
                raise ValueError("the mesh has no triangles, lines or vertices: there is nothing to see")
            return None
        arrays["triangles"] = surface.triangles
        if arrays["normals"] is None:
            arrays["normals"] = surface.normals
        return points

    @classmethod
    def _of(cls, handle: Any, file: str | None, look: Mapping[str, Any]) -> Mesh:
        found = cls.__new__(cls)
        found._handle, found._file, found.look = handle, file, look
        return found

    def _arrays(self) -> tuple[Any, dict[str, Any]]:
        """The vertices and the other arrays. The triangles of tubes are among the other triangles."""
        struct = lib.hl_mesh_describe(self._handle)

        def rows(pointer: Any, count: int, width: int, kind: Any) -> Any:
            if pointer == ffi.NULL or count == 0:
                return None
            return np.frombuffer(ffi.buffer(pointer, 4 * count * width), kind).reshape(count, width).copy()

        arrays = {word: rows(getattr(struct, word), getattr(struct, count), width, kind) for word, count, width, kind in (
            ("triangles", "triangle_count", 3, np.uint32), ("normals", "vertex_count", 3, np.float32),
            ("colors", "vertex_count", 4, np.float32), ("face_colors", "triangle_count", 4, np.float32),
            ("spheres", "sphere_count", 4, np.float32), ("sphere_colors", "sphere_count", 4, np.float32))}
        arrays |= {"lines": None, "line_colors": None}
        return rows(struct.positions, struct.vertex_count, 3, np.float32), arrays

    def __reduce__(self) -> Any:
        return _restored, (*self._arrays(), self._file and os.path.abspath(self._file), dict(self.look))

    def __copy__(self) -> Mesh:
        return Mesh._of(self._handle, self._file, dict(self.look))

    def __deepcopy__(self, memo: dict[int, Any]) -> Mesh:
        return self.__copy__()  # meshes do not change

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Mesh):
            return NotImplemented
        if dict(self.look) != dict(other.look):
            return False
        if self._handle == other._handle:
            return True
        (one, ones), (two, twos) = self._arrays(), other._arrays()
        return np.array_equal(one, two) and all(np.array_equal(ones[word], twos[word]) for word in ones)

    def __hash__(self) -> int:
        return hash((self.vertex_count, self.triangle_count))

    @classmethod
    def floor(cls, scene: Any, size: float = 3, **look: Unpack[MeshLook]) -> Mesh:
        """A square below everything that a scene shows, `size` times as wide as the things that stand on it. It is
        matt and grey. Cuts of the scene do not cut it, unless `cut=True` is given.

        Parameters
        ----------
        scene : Scene
            The scene whose volumes and meshes stand on the floor.
        size : float
            From 1 to 1000.
        **look : MeshLook
            As for `Mesh`.
        """
        place = ffi.new("hl_mesh **")
        call(lib.hl_scene_make_floor, context, lib.hl_scene_describe(scene._handle), ffi.NULL, size, place)
        return cls._of(ffi.gc(place[0], lib.hl_mesh_release), None, {"color": 0.5, "specular": 0.0, "cut": False, **look})

    @classmethod
    def isosurface(cls, volume: Any, value: float, **look: Unpack[MeshLook]) -> Mesh:
        """The surface on which a volume has a value, as triangles in the world of the volume's file.

        Parameters
        ----------
        volume : Volume, path or array
            The volume. What cuts it in pictures does not cut the surface.
        value : float
            The value on the surface. Triangles show their fronts to the lesser values.
        **look : MeshLook
            As for `Mesh`.

        Examples
        --------
        >>> x, y, z = np.ogrid[-8:9, -8:9, -8:9]
        >>> ball = Mesh.isosurface((6 - np.sqrt(x * x + y * y + z * z)).astype(np.float32), 0)
        >>> ball.triangle_count > 500
        True
        """
        handle = made(lib.hl_mesh_of_isosurface, "hl_mesh", lib.hl_mesh_release, context, as_volume(volume)._handle,
                      _settings.number("value", value))
        return cls._of(handle, None, dict(look))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the triangles as .ply (with normals and colours), .stl or .obj (with normals), in the world's units.

        Raises
        ------
        UnsupportedError
            If the name has another ending, or the mesh has no triangles.
        """
        call(lib.hl_mesh_save, context, self._handle, path_bytes(path))

    def replace(self, **look: Unpack[MeshLook]) -> Mesh:
        """The same triangles with another look."""
        return Mesh(self, **look)

    @property
    def vertex_count(self) -> int:
        """The number of vertices."""
        count: int = lib.hl_mesh_describe(self._handle).vertex_count
        return count

    @property
    def triangle_count(self) -> int:
        """The number of triangles. Triangles without an area are left out."""
        count: int = lib.hl_mesh_describe(self._handle).triangle_count
        return count

    def __repr__(self) -> str:
        spheres = lib.hl_mesh_describe(self._handle).sphere_count
        if self.triangle_count == 0:
            return f"<halflight.Mesh of {spheres} spheres>"
        return f"<halflight.Mesh of {self.triangle_count} triangles{'' if self._file is None else f' {self._file}'}>"

    def _fill(self, struct: Any, keep: list[Any], place: str) -> None:
        """Set an hl_scene_mesh, which is valid as long as `keep`."""
        keep.append(self)
        lib.hl_scene_mesh_defaults(ffi.addressof(struct))
        struct.mesh = self._handle
        look = dict(self.look)
        if self._file is not None:
            keep.append(file := ffi.new("char[]", path_bytes(self._file)))
            struct.file = file
        if (name := look.pop("name", None)) is not None:
            keep.append(text := ffi.new("char[]", str(name).encode()))
            struct.name = text
        if (color := look.pop("color", None)) is not None:
            struct.color = colors.linear_color(f"{place}color", color)
        _settings.fill(place, struct.material, lib.HL_SETTINGS_MATERIAL, _settings.taken(look, _MATERIAL))
        _settings.fill(place, struct, lib.HL_SETTINGS_MESH, look)


def mesh_from(struct: Any) -> Mesh:
    """The mesh of an hl_scene_mesh."""
    lib.hl_mesh_retain(struct.mesh)
    look = _settings.read(struct, lib.HL_SETTINGS_MESH) | _settings.read(struct.material, lib.HL_SETTINGS_MATERIAL)
    return Mesh._of(ffi.gc(struct.mesh, lib.hl_mesh_release),
                    None if struct.file == ffi.NULL else os.fsdecode(ffi.string(struct.file)),
                    look if struct.name == ffi.NULL else look | {"name": text_of(struct.name)})


def _restored(vertices: Any, arrays: dict[str, Any], file: str | None, look: dict[str, Any]) -> Mesh:
    """The mesh with these arrays, as pickle makes it."""
    return Mesh._of(_create(vertices, arrays, None), file, look)


def _rows(place: str, values: Any, widths: Sequence[int], kind: Any) -> np.ndarray[Any, Any]:
    """A packed array of rows of one of these widths."""
    try:
        rows = np.ascontiguousarray(values)
    except (TypeError, ValueError):
        raise TypeError(f"{place}: {values!r} is no array of numbers") from None
    wanted = " or ".join(f"(n, {width})" for width in widths)
    if rows.ndim != 2 or rows.shape[1] not in widths:
        raise ValueError(f"{place}: the shape {rows.shape} is not {wanted}")
    if rows.dtype.kind not in ("iu" if kind == np.uint32 else "iuf"):
        raise TypeError(f"{place}: {rows.dtype} is no {'whole number' if kind == np.uint32 else 'number'}")
    if kind == np.uint32 and rows.size > 0 and not 0 <= rows.min() <= rows.max() < 1 << 32:
        raise ValueError(f"{place}: {rows.min() if rows.min() < 0 else rows.max()} is no number of a vertex")
    return np.ascontiguousarray(rows, kind)


def _linear(given: Any) -> np.ndarray[Any, Any]:
    """Colours of vertices, linear with opacity."""
    rows = np.asarray(given)
    values = rows / 255.0 if rows.dtype == np.uint8 else rows
    shown = _rows("colors", values, (3, 4), np.float64)
    if rows.dtype == np.uint8:
        shown[:, :3] = colors.to_linear(shown[:, :3])
    opacity = np.ones((len(shown), 1)) if shown.shape[1] == 3 else shown[:, 3:]
    return np.ascontiguousarray(np.hstack([shown[:, :3], opacity]), np.float32)


def _round(place: str, given: Any, radius: float | None) -> np.ndarray[Any, Any]:
    """Points with radii."""
    rows = _rows(place, given, (3, 4), np.float32)
    if rows.shape[1] == 4:
        return rows
    if radius is None:
        raise TypeError(f"{place}: rows of three numbers need radius=")
    return np.ascontiguousarray(np.hstack([rows, np.full((len(rows), 1), radius)]), np.float32)


def _put(description: Any, name: str, rows: np.ndarray[Any, Any]) -> None:
    kind = "uint32_t" if rows.dtype == np.uint32 else "float"
    setattr(description, name, ffi.cast(f"{kind} (*)[{rows.shape[1]}]", ffi.from_buffer(rows)))


def _move(affine: Any, rows: dict[str, np.ndarray[Any, Any]]) -> None:
    """Move points, normals and radii by an affine matrix."""
    matrix = np.array(matrix_of("affine", affine, [(4, 4), (3, 4)]))[:3]
    turn, volume = matrix[:, :3], float(np.linalg.det(matrix[:, :3]))
    if volume == 0 or not np.isfinite(matrix).all():
        raise ValueError("affine: it flattens the mesh: give a matrix that can be inverted")
    for word in ("positions", "spheres", "line_points"):
        if word in rows:
            moved = rows[word].astype(np.float64)
            moved[:, :3] = moved[:, :3] @ turn.T + matrix[:, 3]
            moved[:, 3:] *= abs(volume) ** (1 / 3)
            rows[word] = np.ascontiguousarray(moved, np.float32)
    if "normals" in rows:
        rows["normals"] = np.ascontiguousarray(rows["normals"] @ np.linalg.inv(turn), np.float32)
    if volume < 0 and "triangles" in rows:  # mirrored: counter-clockwise ones still face the viewer
        rows["triangles"] = np.ascontiguousarray(rows["triangles"][:, ::-1])


def _create(vertices: Any, given: Mapping[str, Any], radius: float | None, affine: Any = None) -> Any:
    """An hl_mesh of arrays. given: the arrays; only the ones that are not None are used."""
    description = ffi.new("hl_mesh_description *")
    lib.hl_mesh_description_defaults(description)
    rows: dict[str, np.ndarray[Any, Any]] = {}
    if vertices is not None:
        rows["positions"] = _rows("vertices", vertices, (3,), np.float32)
        rows["triangles"] = _rows("triangles", given["triangles"], (3,), np.uint32)
    if given["normals"] is not None:
        rows["normals"] = _rows("normals", given["normals"], (3,), np.float32)
    if given["spheres"] is not None:
        rows["spheres"] = _round("spheres", given["spheres"], radius)
    lengths = np.zeros(0, np.uint32)
    if given["lines"] is not None:
        lines = [_round(f"lines[{n}]", line, radius) for n, line in enumerate(given["lines"])]
        lengths = np.array([len(line) for line in lines], np.uint32)
        rows["line_points"] = np.vstack(lines) if lines else np.zeros((0, 4), np.float32)
        description.line_lengths, description.line_count = ffi.cast("uint32_t *", ffi.from_buffer(lengths)), len(lines)
    for word in ("colors", "face_colors", "sphere_colors", "line_colors"):
        if given[word] is not None:
            rows[word] = _linear(given[word])
    for word, wanted in (("normals", "positions"), ("colors", "positions"), ("face_colors", "triangles"),
                         ("sphere_colors", "spheres"), ("line_colors", "line_points")):
        count, found = len(rows.get(wanted, ())), len(rows.get(word, ()))
        if word in rows and found != count:
            thing = {"positions": "vertices", "line_points": "points of lines"}.get(wanted, wanted)
            raise ValueError(f"{word}: {found} rows for {count} {thing}")
    if affine is not None:
        _move(affine, rows)
    for name, array in rows.items():
        _put(description, name, array)
    description.vertex_count, description.triangle_count = len(rows.get("positions", ())), len(rows.get("triangles", ()))
    description.sphere_count, description.line_point_count = len(rows.get("spheres", ())), len(rows.get("line_points", ()))
    place = ffi.new("hl_mesh **")
    call(lib.hl_mesh_create, context, description, place)
    return ffi.gc(place[0], lib.hl_mesh_release)
