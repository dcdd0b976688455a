"""Keywords that the tables of settings name. Written by scripts/settings."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, TypedDict


class VolumeSettings(TypedDict, total=False):
    """Keywords of `Volume`, from the scene file's volumes.

    Parameters
    ----------
    rotate_axis : Sequence[float]
        The axis that the volume is turned about. Default: [0, 0, 1].
    rotate_angle_deg : float
        The angle that the volume is turned by. Degrees, -1e6 to 1e6. Default: 0.
    translate : Sequence[float]
        The vector that the volume is moved by, after it was scaled and turned. World units. Default: [0, 0,
        0].
    shading : str
        Surfaces, a medium such as smoke, or the colours themselves without light. "phong", "none", "flat".
    attenuation_color : Sequence[float]
        Relative extinction of red, green and blue. Default: [1, 1, 1].
    anisotropy : float
        g: how a medium scatters light; above 0 onwards, below 0 back to where it comes from, 0 evenly. -0.99
        to 0.99. Default: 0.
    albedo : Sequence[float]
        The fraction of the light met that a medium scatters, times its colour; the rest is lost. Default: [1,
        1, 1].
    multiple_scattering : bool
        Scattered light is scattered again: clouds and wax glow from inside. Default: False.
    visible : bool
        The eye sees the volume; a volume that it does not see still casts shadows. Default: True.
    casts_shadow : bool
        The volume takes light from what lies behind it. Default: True.
    receives_shadow : bool
        The volume is darkened by shadows. Default: True.
    cut_shading : str
        The normal of surfaces at the faces of `cuts` and `clip`: the face's, the data's, or none, as in a
        medium. "face", "gradient", "none". Default: "face".
    cut_casts_shadow : bool
        What `cuts` remove goes on taking light from what lies behind it. Default: False.
    scraps_faint : float
        The value from which on matter is seen; nothing is hidden from functions that show other values. -1e36
        to 1e36. Default: 0.
    scraps_firm : float
        Voxels beyond this value that share faces are one body. -1e36 to 1e36. Default: 0.
    scraps_least : float
        Bodies with fewer voxels than this part of the largest body's are hidden; 0: none. 0 to 1. Default: 0.
    legend_low : float
        The value at which the strip of a legend begins. Data units, -1e36 to 1e36. Default: 0.
    legend_high : float
        The value at which the strip ends; if it is not above `low`, the strip goes over the values that have
        opacity. Data units, -1e36 to 1e36. Default: 0.
    """

    rotate_axis: Sequence[float]
    rotate_angle_deg: float
    translate: Sequence[float]
    shading: Literal["phong", "none", "flat"]
    attenuation_color: Sequence[float]
    anisotropy: float
    albedo: Sequence[float]
    multiple_scattering: bool
    visible: bool
    casts_shadow: bool
    receives_shadow: bool
    cut_shading: Literal["face", "gradient", "none"]
    cut_casts_shadow: bool
    scraps_faint: float
    scraps_firm: float
    scraps_least: float
    legend_low: float
    legend_high: float


class MaterialSettings(TypedDict, total=False):
    """Keywords of `Volume`, from the scene file's materials.

    Parameters
    ----------
    ambient : float
        ka: the factor on the light from everywhere. 0 to 1000. Default: 1.
    diffuse : float
        kd: the factor on light that is scattered evenly. 0 to 1000. Default: 0.7.
    specular : float
        ks: the factor on the highlight. 0 to 1000. Default: 0.3.
    shininess : float
        n: the exponent of the highlight; larger is smaller. 0 to 10000. Default: 32.
    emission : float
        ke: the fraction of the colour that shines by itself. 0 to 1e6. Default: 0.
    """

    ambient: float
    diffuse: float
    specular: float
    shininess: float
    emission: float


class MeshSettings(TypedDict, total=False):
    """Keywords of `Mesh`, from the scene file's meshes.

    Parameters
    ----------
    scale : float
        A factor on the mesh's size. Above 0, to 1e15. Default: 1.
    rotate_axis : Sequence[float]
        The axis that the mesh is turned about. Default: [0, 0, 1].
    rotate_angle_deg : float
        The angle that the mesh is turned by. Degrees, -1e6 to 1e6. Default: 0.
    translate : Sequence[float]
        The vector that the mesh is moved by, after it was scaled and turned. World units. Default: [0, 0, 0].
    opacity : float
        The fraction of light that the surface stops. 0 to 1. Default: 1.
    smooth : bool
        Normals are interpolated between the vertices; else each triangle is flat. Default: True.
    two_sided : bool
        Both sides of the surface are lit; else the back is black. Default: True.
    visible : bool
        The eye sees the mesh; a mesh that it does not see still casts shadows. Default: True.
    casts_shadow : bool
        The mesh takes light from what lies behind it. Default: True.
    receives_shadow : bool
        The mesh is darkened by shadows. Default: True.
    attenuation_color : Sequence[float]
        The fractions of the opacity that the mesh takes of red, green and blue light. Default: [1, 1, 1].
    cut : bool
        The scene's `cuts` cut the mesh, too; a floor's default is false. Default: True.
    """

    scale: float
    rotate_axis: Sequence[float]
    rotate_angle_deg: float
    translate: Sequence[float]
    opacity: float
    smooth: bool
    two_sided: bool
    visible: bool
    casts_shadow: bool
    receives_shadow: bool
    attenuation_color: Sequence[float]
    cut: bool


class SkySettings(TypedDict, total=False):
    """Keywords of `Sky`, from the scene file's sky.

    Parameters
    ----------
    type : str
        Where the colours of the light from all directions come from. "none", "uniform", "gradient", "image".
        Default: "none".
    color : Sequence[float]
        The radiance from every direction. Linear RGB. Default: [1, 1, 1].
    zenith : Sequence[float]
        The radiance from straight above. Linear RGB. Default: [0.8, 0.9, 1].
    horizon : Sequence[float]
        The radiance from the horizon. Linear RGB. Default: [1, 1, 1].
    ground : Sequence[float]
        The radiance from straight below. Linear RGB. Default: [0.3, 0.27, 0.24].
    rotation_deg : float
        The angle that the image is turned by about up, counterclockwise as seen from above. Degrees, -1e6 to
        1e6. Default: 0.
    up : Sequence[float]
        The direction of the zenith. Default: [0, 0, 1].
    hemisphere : bool
        Nothing shines below the horizon. Default: False.
    strength : float
        A factor on the sky's colours. 0 to 1e6. Default: 1.
    suns : bool
        Up to four compact bright spots of the image cast shadows as parallel lights do. Default: True.
    """

    type: Literal["none", "uniform", "gradient", "image"]
    color: Sequence[float]
    zenith: Sequence[float]
    horizon: Sequence[float]
    ground: Sequence[float]
    rotation_deg: float
    up: Sequence[float]
    hemisphere: bool
    strength: float
    suns: bool


class PictureSettings(TypedDict, total=False):
    """Keywords of `Scene`, from the scene file's image and top level.

    Parameters
    ----------
    background_sky : bool
        Pictures show the sky behind all else. Default: False.
    exposure : float
        A PNG shows the volumes' light times 2^exposure. Stops, -32 to 32. Default: 0.
    tone : str
        How a PNG shows light brighter than white: cut, or ever more slowly near white, its hue kept. "clip",
        "filmic". Default: "clip".
    """

    background_sky: bool
    exposure: float
    tone: Literal["clip", "filmic"]


class RenderSettings(TypedDict, total=False):
    """Keywords of `Scene`, from the scene file's render settings.

    Parameters
    ----------
    shadows : str
        The shadows of all lights that do not say otherwise. "off", "hard", "soft". Default: "soft".
    soft_method : str
        How soft shadows are made. "cascade", "paper", "sublights". Default: "cascade".
    light_samples : int
        M: sublights stand for a light by M x M points. 1 to 64. Default: 4.
    sheet_spacing : float
        The distance of neighbouring sheets; more than 4 is as 4. Smallest voxel edges, 0.01 to 100. Default:
        0.5.
    kernel : str
        The function that spreads a voxel's value around it. "bspline", "gaussian", "linear", "interpolating".
        Default: "bspline".
    reconstruction : str
        Whether voxels are splatted onto sheets or samples gather voxels. "auto", "splat", "gather". Default:
        "auto".
    slicing : str
        The direction that the sheets are perpendicular to. "half-vector", "image-aligned". Default:
        "half-vector".
    shadow_lookup : str
        How light is read between the pixels of a shadow buffer. "auto", "bilinear", "cubic", "nearest".
        Default: "auto".
    shadow_resolution : int | Literal["auto"]
        Pixels along the longer side of a shadow buffer. Pixels, "auto" or 1 to 16384. Default: "auto".
    threads : int
        0: one thread per processor. 0 to 1024. Default: 0.
    compositing : str
        What a pixel shows: lit matter, or the greatest value along its ray, without light. "light",
        "maximum". Default: "light".
    slabs_at_once : int
        Slabs between two waits of the threads for each other; changes no picture. 0: automatic. 0 to 64.
        Default: 0.
    pixel_samples : int
        N: a pixel is the mean of N x N samples at least. 0: one, and more of voxels smaller than pixels. 0 to
        8. Default: 0.
    """

    shadows: Literal["off", "hard", "soft"]
    soft_method: Literal["cascade", "paper", "sublights"]
    light_samples: int
    sheet_spacing: float
    kernel: Literal["bspline", "gaussian", "linear", "interpolating"]
    reconstruction: Literal["auto", "splat", "gather"]
    slicing: Literal["half-vector", "image-aligned"]
    shadow_lookup: Literal["auto", "bilinear", "cubic", "nearest"]
    shadow_resolution: int | Literal["auto"]
    threads: int
    compositing: Literal["light", "maximum"]
    slabs_at_once: int
    pixel_samples: int


class FurtherSettings(TypedDict, total=False):
    """Keywords of `render` beyond those of its signature.
    """

    rotate_axis: Sequence[float]
    rotate_angle_deg: float
    translate: Sequence[float]
    attenuation_color: Sequence[float]
    anisotropy: float
    albedo: Sequence[float]
    multiple_scattering: bool
    visible: bool
    casts_shadow: bool
    receives_shadow: bool
    cut_shading: Literal["face", "gradient", "none"]
    cut_casts_shadow: bool
    scraps_faint: float
    scraps_firm: float
    scraps_least: float
    legend_low: float
    legend_high: float
    emission: float
    background_sky: bool
    exposure: float
    tone: Literal["clip", "filmic"]
    soft_method: Literal["cascade", "paper", "sublights"]
    light_samples: int
    sheet_spacing: float
    kernel: Literal["bspline", "gaussian", "linear", "interpolating"]
    reconstruction: Literal["auto", "splat", "gather"]
    slicing: Literal["half-vector", "image-aligned"]
    shadow_lookup: Literal["auto", "bilinear", "cubic", "nearest"]
    shadow_resolution: int | Literal["auto"]
    compositing: Literal["light", "maximum"]
    slabs_at_once: int
    pixel_samples: int
