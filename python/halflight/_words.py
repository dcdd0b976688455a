"""Unknown words are refused with the nearest known one."""
from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Collection
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


def nearest(word: str, known: Collection[str]) -> str:
    """What an error adds: `": did you mean 'x'?"`, or a list of all known words where none is near."""
    import difflib

    found = difflib.get_close_matches(word.lower(), known, 1, 0.5)
    return f": did you mean '{found[0]}'?" if found else f": use one of {', '.join(known)}"


# What other programs call our keywords: the keyword, and how it is given where its name does not tell.
_ELSEWHERE = {word: (keyword, f" Give {keyword}={form}" if form[0] in "([{" else "") for keyword, form, words in (
    ("clim", "(low, high)", "vmin vmax clims contrast_limits rng scalar_range value_range window level"),
    ("size", "(width, height)", "window_size image_size figsize resolution width height shape"),
    ("iso", "[value, ...]", "isosurfaces isosurface isovalue isovalues contours iso_threshold threshold"),
    ("cmap", "name", "colormap color_map colourmap lut palette colormaps"),
    ("spacing", "(dz, dy, dx)", "voxel_size voxelsize voxel_spacing pixdim pixel_size zooms scales"),
    ("background", "color", "bg bgcolor background_color bg_color facecolor"),
    ("camera", "(azimuth, elevation)", "cpos camera_position view viewpoint azimuth elevation azim elev"),
    ("opacity_unit_distance", "length", "opacity_unit scalar_opacity_unit_distance sample_distance"),
    ("lights", "[Directional(...), ...]", "light lightkit light_position light_direction"),
    ("threads", "number", "n_threads num_threads nthreads n_jobs workers"),
    ("tf", "name or TransferFunction(...)", "transfer_function opacity_transfer_function preset alpha_map"),
    ("labels", "label map", "segmentation seg label_map labelmap segments"),
    ("meshes", "[Mesh(...), ...]", "mesh surfaces surface actors"),
    ("opacity", "number", "alpha transparency"),
    ("shade", "True or False", "shading lighting smooth_shading"),
    ("color", "name", "colour tint face_color facecolors"),
    ("cuts", "{'type': 'plane', ...}", "clipping_planes clip_planes cutting_planes slicer"),
    ("log_scale", "True", "log log_norm logscale"),
    ("ambient", "factor", "ambient_light"),
    ("spheres", "centres", "glyphs centers centres"),
    ("fovy_deg", "degrees", "fov fovy view_angle"),
    ("target", "(x, y, z)", "focal_point look_at lookat center"),
    ("height", "length", "parallel_scale ortho_scale"),
    ("up", "(x, y, z)", "view_up viewup roll"),
) for word in words.split()}


def check_keywords(place: str, given: Collection[str], known: Collection[str]) -> None:
    """Raise TypeError for the first unknown keyword, with what it is called here."""
    for word in given:
        if word not in known:
            keyword, given = _ELSEWHERE.get(word.lower(), ("", ""))
            hint = f": did you mean '{keyword}'?{given}" if keyword in known else nearest(word, known)
            raise TypeError(f"{place} has no keyword '{word}'{hint}")


def choice(place: str, word: object, known: Collection[str]) -> str:
    """`word`, if it is one of the known ones."""
    if not isinstance(word, str):
        raise TypeError(f"{place}: {word!r} is no name: use one of {', '.join(known)}")
    if word not in known:
        raise ValueError(f"{place}: there is no '{word}'{nearest(word, known)}")
    return word


def suggests_also(further: Collection[str]) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """`suggests` for a function whose ``**`` takes these keywords."""
    return lambda function: suggests(function, further)


def suggests(function: Callable[P, R], further: Collection[str] = ()) -> Callable[P, R]:
    """Make `function` answer an unknown keyword with the nearest known one. further: the keywords that its ** takes."""
    parameters = inspect.signature(function).parameters.values()
    known = [p.name for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY) and p.name != "self"]
    known += further
    place = function.__qualname__.removesuffix(".__init__") + "()"

    @functools.wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        check_keywords(place, kwargs, known)
        return function(*args, **kwargs)

    return checked
