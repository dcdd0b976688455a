"""Refuses unknown words, and suggests the nearest known word."""
from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Collection
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")


def nearest(word: str, known: Collection[str]) -> str:
    """The end of an error's message: `": did you mean 'x'?"`, or a list of all known words if none of them is near."""
    import difflib

    found = difflib.get_close_matches(word.lower(), known, 1, 0.6)
    return f": did you mean '{found[0]}'?" if found else f": use one of {', '.join(known)}"


# What other programs call our keywords: the keyword, and how it is given where its name does not tell. A word may stand for several: the first that a
# function has is named.
_ELSEWHERE = (
    ("clim", "(low, high)", "vmin vmax clims contrast_limits range rng scalar_range value_range window level"),
    ("size", "(width, height)", "window_size image_size figsize resolution width height shape dpi"),
    ("iso", "[value, ...]", "isosurfaces isosurface isovalue isovalues isolevel contours iso_threshold threshold"),
    ("cmap", "name", "colormap color_map colourmap lut palette colormaps colors"),
    ("spacing", "(dz, dy, dx)", "voxel_size voxelsize voxel_spacing pixdim pixel_size zooms scales"),
    ("space", "'RAS'", "orientation axcodes anatomical_space coordinate_system frame"),
    ("background", "color", "bg bgcolor background_color bg_color facecolor"),
    ("fovy_deg", "degrees", "fov fovy view_angle"),
    ("camera", "(azimuth, elevation)", "cpos camera_position view viewpoint azimuth elevation azim elev"),
    ("camera", "[position, target, up]", "focal_point look_at lookat view_up viewup"),
    ("camera", "{'fovy': degrees}", "fov fovy view_angle"),
    ("camera", "{'up': '+z', 'ortho': True, 'zoom': 1.2}", "up ortho orthographic parallel_projection zoom roll"),
    ("camera", "Camera(...)", "parallel_scale"),
    ("opacity_unit_distance", "length", "opacity_unit scalar_opacity_unit_distance sample_distance"),
    ("lights", "[Directional(...), ...]", "light lightkit light_position light_direction"),
    ("threads", "number", "n_threads num_threads nthreads n_jobs workers"),
    ("tf", "name", "transfer_function opacity_transfer_function preset alpha_map"),
    ("labels", "map", "segmentation seg label_map labelmap segments"),
    ("meshes", "[Mesh(...), ...]", "mesh surfaces surface actors"),
    ("opacity", "number", "alpha transparency opacities"),
    ("shade", "word", "shading lighting smooth_shading"),
    ("color", "name", "colour tint face_color facecolors"),
    ("cuts", "[{'type': 'plane', ...}]", "clipping_planes clip_planes cutting_planes slicer clip crop roi bounds"),
    ("log_scale", "True", "log log_norm logscale norm"),
    ("ambient", "factor", "ambient_light"),
    ("array", "name", "scalars variable field data_var"),
    ("exposure", "stops", "gamma brightness gain"),
    ("tone", "name", "tone_mapping tone_mapper tonemap tonemapping"),
    ("kernel", "name", "interpolation interp interpolation_order"),
    ("compositing", "name", "blending blend_mode rendering"),
    ("light_samples", "number", "shadow_samples"),
    ("pixel_samples", "number", "spp samples n_samples antialias anti_aliasing antialiasing supersample supersampling multi_samples"),
    ("sheet_spacing", "length", "quality step step_size sampling_rate sampling_distance"),
    ("spheres", "centres", "glyphs centers centres"),
    ("target", "(x, y, z)", "focal_point look_at lookat center"),
    ("height", "length", "parallel_scale ortho_scale"),
    ("up", "(x, y, z)", "view_up viewup roll"),
)


def _here(word: str, known: Collection[str]) -> str:
    """The name in this package of another program's keyword: `": did you mean 'x'?"`, with its form; "" if nothing is
    known of it.
    """
    for keyword, form, words in _ELSEWHERE:
        if keyword in known and word.lower() in words.split():
            given = f" Give {keyword}={form}" if not form.isalpha() else ""
            return f": did you mean '{keyword}'?{given}"
    return ""


def check_keywords(place: str, given: Collection[str], known: Collection[str]) -> None:
    """Raise TypeError for the first unknown keyword, with its name in this package."""
    for word in given:
        if word not in known:
            raise TypeError(f"{place} has no keyword '{word}'{_here(word, known) or nearest(word, known)}")


def choice(place: str, word: object, known: Collection[str]) -> str:
    """`word`, if it is one of the known ones."""
    if not isinstance(word, str):
        raise TypeError(f"{place}: {word!r} is no name: use one of {', '.join(known)}")
    if word not in known:
        raise ValueError(f"{place}: there is no '{word}'{nearest(word, known)}")
    return word


def suggests_also(further: Collection[str]) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Makes the decorator `suggests` for a function whose ``**`` takes these keywords."""
    return lambda function: suggests(function, further)


def suggests(function: Callable[P, R], further: Collection[str] = ()) -> Callable[P, R]:
    """Make `function` suggest the nearest known keyword if it is called with an unknown one. further: the keywords
    that its ** takes.
    """
    parameters = inspect.signature(function).parameters.values()
    known = [p.name for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY) and p.name != "self"]
    known += further
    place = function.__qualname__.removesuffix(".__init__") + "()"

    @functools.wraps(function)
    def checked(*args: P.args, **kwargs: P.kwargs) -> R:
        check_keywords(place, kwargs, known)
        return function(*args, **kwargs)

    return checked
