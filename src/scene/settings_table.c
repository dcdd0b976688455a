/* scene/settings_table.c - defines the tables of settings: one row for each key of a scene.
 *
 * A new setting needs a field in a public struct and a row in this file. scripts/settings then writes the
 * setting into the schema and the manual page. Ranges, defaults and names of settings stand only in this
 * file. */
#include <stddef.h>

#include <halflight/settings.h>

#include "scene/check/limits.h"
#include "scene/light/light_kinds.h"
#include "scene/settings.h"
#include "scene/soft_methods.h"

/* The rows of the tables are laid out by hand, in a few lines each. */
/* clang-format off */

static const hl_setting_choice camera_types[] = {
    {"perspective", HL_CAMERA_PERSPECTIVE}, {"orthographic", HL_CAMERA_ORTHOGRAPHIC}, {NULL, 0}};
#define CHOICE(with, value, name, settings) {#name, value},
static const hl_setting_choice light_types[] = {HL_LIGHT_KINDS(CHOICE, 0){NULL, 0}};
static const hl_setting_choice light_frames[] = {
    {"world", HL_LIGHT_FRAME_WORLD}, {"camera", HL_LIGHT_FRAME_CAMERA}, {NULL, 0}};
static const hl_setting_choice falloffs[] = {
    {"none", HL_FALLOFF_NONE}, {"inverse_square", HL_FALLOFF_INVERSE_SQUARE}, {NULL, 0}};
static const hl_setting_choice shadows[] = {
    {"off", HL_SHADOWS_OFF}, {"hard", HL_SHADOWS_HARD}, {"soft", HL_SHADOWS_SOFT}, {NULL, 0}};
static const hl_setting_choice shadings[] = {
    {"phong", HL_SHADING_PHONG}, {"none", HL_SHADING_NONE}, {"flat", HL_SHADING_FLAT}, {NULL, 0}};
#define HL_SOFT_METHOD(value, name) {#name, value},
static const hl_setting_choice soft_methods[] = {HL_SOFT_METHODS{NULL, 0}};
static const hl_setting_choice kernels[] = {{"bspline", HL_KERNEL_BSPLINE},
                                            {"gaussian", HL_KERNEL_GAUSSIAN},
                                            {"linear", HL_KERNEL_LINEAR},
                                            {"interpolating", HL_KERNEL_INTERPOLATING},
                                            {NULL, 0}};
static const hl_setting_choice reconstructions[] = {{"auto", HL_RECONSTRUCTION_AUTO},
                                                    {"splat", HL_RECONSTRUCTION_SPLAT},
                                                    {"gather", HL_RECONSTRUCTION_GATHER},
                                                    {NULL, 0}};
static const hl_setting_choice slicings[] = {
    {"half-vector", HL_SLICING_HALF_VECTOR}, {"image-aligned", HL_SLICING_IMAGE_ALIGNED}, {NULL, 0}};
static const hl_setting_choice lookups[] = {{"auto", HL_LOOKUP_AUTO},
                                            {"bilinear", HL_LOOKUP_BILINEAR},
                                            {"cubic", HL_LOOKUP_CUBIC},
                                            {"nearest", HL_LOOKUP_NEAREST},
                                            {NULL, 0}};
static const hl_setting_choice compositings[] = {
    {"light", HL_COMPOSITING_LIGHT}, {"maximum", HL_COMPOSITING_MAXIMUM}, {NULL, 0}};
static const hl_setting_choice tones[] = {{"clip", HL_TONE_CLIP}, {"filmic", HL_TONE_FILMIC}, {NULL, 0}};
static const hl_setting_choice skies[] = {{"none", HL_SKY_NONE},
                                          {"uniform", HL_SKY_UNIFORM},
                                          {"gradient", HL_SKY_GRADIENT},
                                          {"image", HL_SKY_IMAGE},
                                          {NULL, 0}};
static const hl_setting_choice cut_types[] = {
    {"plane", HL_CUT_PLANE}, {"box", HL_CUT_BOX}, {"sphere", HL_CUT_SPHERE}, {NULL, 0}};
static const hl_setting_choice cut_keeps[] = {
    {"outside", HL_CUT_KEEP_OUTSIDE}, {"inside", HL_CUT_KEEP_INSIDE}, {NULL, 0}};
static const hl_setting_choice cut_shadings[] = {{"face", HL_CUT_SHADING_FACE},
                                                 {"gradient", HL_CUT_SHADING_GRADIENT},
                                                 {"none", HL_CUT_SHADING_NONE},
                                                 {NULL, 0}};
static const hl_setting_choice automatic_resolution[] = {{"auto", 0}, {NULL, 0}};

#define ONE(type) (1u << (type))
#define SHINING   (ONE(HL_SKY_UNIFORM) | ONE(HL_SKY_GRADIENT) | ONE(HL_SKY_IMAGE))
/* Sets of types of light, as bits: the types that have a setting (light_kinds.h). */
#define ONE_IF(with, value, name, settings) | ((settings) & (with) ? ONE(value) : 0)
#define LIGHTS_WITH(setting)                (0u HL_LIGHT_KINDS(ONE_IF, setting))

/* Parts that many rows of the tables have in common. */
#define FIELD(structure, name) .field = #name, .offset = offsetof(structure, name)
#define A_POINT                                                                                      \
  .type = HL_SETTING_POINT, .unit = "world units", .low = -HL_LIMIT_LENGTH, .high = HL_LIMIT_LENGTH, \
  .mend = "give a coordinate between {low} and {high}"
#define A_DIRECTION                                                                           \
  .type = HL_SETTING_DIRECTION, .unit = "", .low = -HL_LIMIT_LENGTH, .high = HL_LIMIT_LENGTH, \
  .mend = "give a coordinate between {low} and {high}"
#define A_CHOICE(names) .type = HL_SETTING_CHOICE, .unit = "", .choices = names
#define A_FLAG          .type = HL_SETTING_FLAG, .unit = "", .high = 1

static const hl_setting scene_rows[] = {
    {.key = "ambient", FIELD(hl_scene_description, ambient), .type = HL_SETTING_COLOR, .unit = "linear RGB",
     .high = HL_LIMIT_LENGTH, .standard = {0.2, 0.2, 0.2}, .option = "ambient",
     .sentence = "Light from everywhere.", .mend = "give linear RGB, none below 0"}};

static const hl_setting image_rows[] = {
    {.key = "width", FIELD(hl_scene_description, width), .type = HL_SETTING_WHOLE, .unit = "pixels",
     .low = 1, .high = HL_LIMIT_PIXELS, .standard = {512}, .option = "size",
     .sentence = "Pixels across the picture.", .mend = "give a number of pixels from {low} to {high}"},
    {.key = "height", FIELD(hl_scene_description, height), .type = HL_SETTING_WHOLE, .unit = "pixels",
     .low = 1, .high = HL_LIMIT_PIXELS, .standard = {512}, .option = "size",
     .sentence = "Pixels down the picture.", .mend = "give a number of pixels from {low} to {high}"},
    {.key = "background", FIELD(hl_scene_description, background), .type = HL_SETTING_COLOR,
     .unit = "linear RGB", .high = 1, .option = "background",
     .sentence = "The colour behind the volumes in a PNG.",
     .mend = "give linear RGB, each from {low} to {high}"},
    {.key = "background_transparent", FIELD(hl_scene_description, background_transparent), A_FLAG,
     .optional = 1, .option = "background",
     .sentence = "A PNG keeps its alpha, and no background is added."},
    {.key = "background_sky", FIELD(hl_scene_description, background_sky), A_FLAG, .optional = 1,
     .option = "background", .sentence = "Pictures show the sky behind all else."},
    {.key = "exposure", FIELD(hl_scene_description, exposure), .type = HL_SETTING_NUMBER, .unit = "stops",
     .low = -HL_LIMIT_EXPOSURE, .high = HL_LIMIT_EXPOSURE, .optional = 1, .option = "exposure",
     .sentence = "A PNG shows the volumes' light times 2^exposure.",
     .mend = "give stops from {low} to {high}: each doubles the light"},
    {.key = "tone", FIELD(hl_scene_description, tone), A_CHOICE(tones), .optional = 1, .option = "tone",
     .sentence = "How a PNG shows light brighter than white: cut, or ever more slowly near white, its hue kept."}};

static const hl_setting camera_rows[] = {
    {.key = "type", FIELD(hl_camera, type), A_CHOICE(camera_types), .option = "ortho",
     .sentence = "The projection."},
    {.key = "position", FIELD(hl_camera, position), A_POINT, .standard = {0, -1, 0}, .sentence = "The eye."},
    {.key = "target", FIELD(hl_camera, target), A_POINT,
     .sentence = "The point in the middle of the picture."},
    {.key = "up", FIELD(hl_camera, up), A_DIRECTION, .standard = {0, 0, 1}, .option = "up",
     .sentence = "The direction that points up in the picture."},
    {.key = "fovy_deg", FIELD(hl_camera, fovy_deg), .type = HL_SETTING_NUMBER, .unit = "degrees",
     .low = 1e-6, .high = 179.999, .standard = {30}, .only_for = ONE(HL_CAMERA_PERSPECTIVE),
     .option = "fovy", .sentence = "The vertical field of view.",
     .mend = "give an angle in degrees, above 0 and below 180"},
    {.key = "height", FIELD(hl_camera, height), .type = HL_SETTING_NUMBER, .unit = "world units",
     .high = HL_LIMIT_LENGTH, .open_low = 1, .standard = {1}, .only_for = ONE(HL_CAMERA_ORTHOGRAPHIC),
     .sentence = "The height of the world that the picture shows.",
     .mend = "give the picture's height in world units, above 0"}};

static const hl_setting light_rows[] = {
    {.key = "type", FIELD(hl_light, type), A_CHOICE(light_types), .sentence = "The shape of the light."},
    {.key = "frame", FIELD(hl_light, frame), A_CHOICE(light_frames), .optional = 1,
     .sentence = "The axes of the light's positions and directions: the world's, or the camera's (right, up, "
                 "towards the viewer; from its target), with which the light goes."},
    {.key = "position", FIELD(hl_light, position), A_POINT, .only_for = LIGHTS_WITH(LIGHT_POSITION),
     .sentence = "The centre of the light."},
    {.key = "direction", FIELD(hl_light, direction), A_DIRECTION, .standard = {0, 0, -1},
     .only_for = LIGHTS_WITH(LIGHT_DIRECTION), .option = "light",
     .sentence = "The way the light travels."},
    {.key = "angular_diameter_deg", FIELD(hl_light, angular_diameter_deg), .type = HL_SETTING_NUMBER,
     .unit = "degrees", .high = 120, .only_for = LIGHTS_WITH(LIGHT_ANGULAR_DIAMETER), .option = "light-size",
     .sentence = "The diameter of the disk that the light comes from, as seen from the volumes; above 0 "
                 "its shadows are soft.",
     .mend = "give an angle in degrees from {low} (a sharp light) to {high}"},
    {.key = "edge1", FIELD(hl_light, edge1), A_POINT, .standard = {1, 0, 0}, .only_for = LIGHTS_WITH(LIGHT_EDGES),
     .sentence = "One full edge of the parallelogram; of no length, the light is a line."},
    {.key = "edge2", FIELD(hl_light, edge2), A_POINT, .standard = {0, 1, 0}, .only_for = LIGHTS_WITH(LIGHT_EDGES),
     .sentence = "The other full edge of the parallelogram, likewise."},
    {.key = "normal", FIELD(hl_light, normal), A_DIRECTION, .standard = {0, 0, -1},
     .only_for = LIGHTS_WITH(LIGHT_NORMAL), .sentence = "The direction that the disk faces."},
    {.key = "opening_angle_deg", FIELD(hl_light, opening_angle_deg), .type = HL_SETTING_NUMBER,
     .unit = "degrees", .low = 0.01, .high = 179, .standard = {40}, .only_for = LIGHTS_WITH(LIGHT_CONE),
     .sentence = "The full angle of the cone, beyond which it is dark.",
     .mend = "give the cone's full angle in degrees, from {low} to {high}"},
    {.key = "falloff_angle_deg", FIELD(hl_light, falloff_angle_deg), .type = HL_SETTING_NUMBER,
     .unit = "degrees", .high = 89.5, .standard = {5}, .only_for = LIGHTS_WITH(LIGHT_CONE),
     .sentence = "The width of the smooth edge inside the cone, at most half the opening angle.",
     .mend = "give the width of the cone's smooth edge in degrees, from {low} to half the opening angle"},
    {.key = "radius", FIELD(hl_light, radius), .type = HL_SETTING_NUMBER, .unit = "world units",
     .high = HL_LIMIT_LENGTH, .only_for = LIGHTS_WITH(LIGHT_RADIUS),
     .sentence = "The radius of the sphere or the disk; above 0 its shadows are soft.",
     .mend = "give a length in world units, {low} for a point"},
    {.key = "falloff", FIELD(hl_light, falloff), A_CHOICE(falloffs),
     .sentence = "How the light falls with the distance from its centre."},
    {.key = "color", FIELD(hl_light, color), .type = HL_SETTING_COLOR, .unit = "linear RGB",
     .high = HL_LIMIT_LENGTH, .standard = {1, 1, 1}, .sentence = "The colour of the light.",
     .mend = "give linear RGB, none below 0"},
    {.key = "intensity", FIELD(hl_light, intensity), .type = HL_SETTING_NUMBER, .unit = "",
     .high = HL_LIMIT_INTENSITY, .standard = {1}, .sentence = "A factor on the colour: a sample gets their product.",
     .mend = "give a factor, {low} or more"},
    {.key = "shadows", FIELD(hl_light, shadows), A_CHOICE(shadows), .standard = {HL_SHADOWS_DEFAULT},
     .optional = 1, .option = "shadows",
     .sentence = "The light's shadows; by default as the render settings say."}};

#define MATERIAL_MEND "give a factor from {low} to {high}"
static const hl_setting material_rows[] = {
    {.key = "ambient", FIELD(hl_material, ambient), .type = HL_SETTING_NUMBER, .unit = "", .high = 1000,
     .standard = {1}, .sentence = "ka: the factor on the light from everywhere.", .mend = MATERIAL_MEND},
    {.key = "diffuse", FIELD(hl_material, diffuse), .type = HL_SETTING_NUMBER, .unit = "", .high = 1000,
     .standard = {0.7}, .sentence = "kd: the factor on light that is scattered evenly.",
     .mend = MATERIAL_MEND},
    {.key = "specular", FIELD(hl_material, specular), .type = HL_SETTING_NUMBER, .unit = "", .high = 1000,
     .standard = {0.3}, .sentence = "ks: the factor on the highlight.", .mend = MATERIAL_MEND},
    {.key = "shininess", FIELD(hl_material, shininess), .type = HL_SETTING_NUMBER, .unit = "",
     .high = HL_LIMIT_SHININESS, .standard = {32},
     .sentence = "n: the exponent of the highlight; larger is smaller.",
     .mend = "give an exponent from {low} to {high}"},
    {.key = "emission", FIELD(hl_material, emission), .type = HL_SETTING_NUMBER, .unit = "",
     .high = HL_LIMIT_EMISSION, .optional = 1,
     .sentence = "ke: the fraction of the colour that shines by itself.",
     .mend = "give the part of the colour that shines by itself, from {low} to {high}"}};

static const hl_setting transfer_function_rows[] = {
    {.key = "unit_distance", FIELD(hl_transfer_function, unit_distance), .type = HL_SETTING_NUMBER,
     .unit = "world units", .high = HL_LIMIT_LENGTH, .open_low = 1, .standard = {1},
     .sentence = "The length that the opacities are for.",
     .mend = "give the length in world units that the opacities are for, above 0"}};

static const hl_setting volume_rows[] = {
    {.key = "transform/scale", FIELD(hl_scene_volume, scale), .type = HL_SETTING_NUMBER, .unit = "",
     .high = HL_LIMIT_LENGTH, .open_low = 1, .standard = {1},
     .sentence = "A factor, or three along the axes of the volume's own file.",
     .mend = "give a factor above 0"},
    {.key = "transform/rotate/axis", FIELD(hl_scene_volume, rotate_axis), A_DIRECTION, .standard = {0, 0, 1},
     .sentence = "The axis that the volume is turned about."},
    {.key = "transform/rotate/angle_deg", FIELD(hl_scene_volume, rotate_angle_deg),
     .type = HL_SETTING_NUMBER, .unit = "degrees", .low = -1e6, .high = 1e6,
     .sentence = "The angle that the volume is turned by.", .mend = "give an angle in degrees"},
    {.key = "transform/translate", FIELD(hl_scene_volume, translate), A_POINT,
     .sentence = "The vector that the volume is moved by, after it was scaled and turned."},
    {.key = "shading", FIELD(hl_scene_volume, shading), A_CHOICE(shadings), .option = "shading",
     .sentence = "Surfaces, a medium such as smoke, or the colours themselves without light."},
    {.key = "attenuation_color", FIELD(hl_scene_volume, attenuation_color), .type = HL_SETTING_COLOR,
     .unit = "", .high = 1000, .standard = {1, 1, 1},
     .sentence = "Relative extinction of red, green and blue.",
     .mend = "give relative extinctions from {low} to {high}, 1 for as much as the opacity says"},
    {.key = "scattering/anisotropy", FIELD(hl_scene_volume, anisotropy), .type = HL_SETTING_NUMBER,
     .unit = "", .low = -0.99, .high = 0.99, .optional = 1,
     .sentence = "g: how a medium scatters light; above 0 onwards, below 0 back to where it comes from, 0 evenly.",
     .mend = "give the mean cosine of the angle that light is turned by, from {low} to {high}"},
    {.key = "scattering/albedo", FIELD(hl_scene_volume, albedo), .type = HL_SETTING_COLOR, .unit = "",
     .high = 1, .standard = {1, 1, 1}, .optional = 1,
     .sentence = "The fraction of the light met that a medium scatters, times its colour; the rest is lost.",
     .option = "scattering", .mend = "give a fraction for red, green and blue, each from {low} to {high}"},
    {.key = "scattering/multiple", FIELD(hl_scene_volume, multiple_scattering), A_FLAG, .optional = 1,
     .option = "scattering",
     .sentence = "Scattered light is scattered again: clouds and wax glow from inside."},
    {.key = "visible", FIELD(hl_scene_volume, visible), A_FLAG, .standard = {1},
     .sentence = "The eye sees the volume; a volume that it does not see still casts shadows."},
    {.key = "casts_shadow", FIELD(hl_scene_volume, casts_shadow), A_FLAG, .standard = {1},
     .sentence = "The volume takes light from what lies behind it."},
    {.key = "receives_shadow", FIELD(hl_scene_volume, receives_shadow), A_FLAG, .standard = {1},
     .sentence = "The volume is darkened by shadows."},
    {.key = "clip/min", FIELD(hl_scene_volume, clip_min), A_POINT,
     .sentence = "The least corner of the box that is kept, in the units of the volume's own file."},
    {.key = "clip/max", FIELD(hl_scene_volume, clip_max), A_POINT,
     .sentence = "The greatest corner of the box that is kept."},
    {.key = "cut_shading", FIELD(hl_scene_volume, cut_shading), A_CHOICE(cut_shadings), .optional = 1,
     .option = "cut-shading",
     .sentence = "The normal of surfaces at the faces of `cuts` and `clip`: the face's, the data's, or none, as in a medium."},
    {.key = "cut_casts_shadow", FIELD(hl_scene_volume, cut_casts_shadow), A_FLAG, .optional = 1,
     .option = "cut-casts-shadow",
     .sentence = "What `cuts` remove goes on taking light from what lies behind it."},
    {.key = "scraps/faint", FIELD(hl_scene_volume, scraps_faint), .type = HL_SETTING_NUMBER, .unit = "",
     .low = -HL_LIMIT_VOXEL_VALUE, .high = HL_LIMIT_VOXEL_VALUE, .optional = 1,
     .sentence = "The value from which on matter is seen; nothing is hidden from functions that show other values.",
     .mend = "give a value of the volume"},
    {.key = "scraps/firm", FIELD(hl_scene_volume, scraps_firm), .type = HL_SETTING_NUMBER, .unit = "",
     .low = -HL_LIMIT_VOXEL_VALUE, .high = HL_LIMIT_VOXEL_VALUE, .optional = 1,
     .sentence = "Voxels beyond this value that share faces are one body.",
     .mend = "give a value of the volume"},
    {.key = "scraps/least", FIELD(hl_scene_volume, scraps_least), .type = HL_SETTING_NUMBER, .unit = "",
     .high = 1, .optional = 1,
     .sentence = "Bodies with fewer voxels than this part of the largest body's are hidden; 0: none.",
     .mend = "give a fraction from {low} to {high}"},
    {.key = "legend/low", FIELD(hl_scene_volume, legend_low), .type = HL_SETTING_NUMBER, .unit = "data units",
     .low = -HL_LIMIT_VOXEL_VALUE, .high = HL_LIMIT_VOXEL_VALUE, .optional = 1,
     .sentence = "The value at which the strip of a legend begins.", .mend = "give a value of the volume"},
    {.key = "legend/high", FIELD(hl_scene_volume, legend_high), .type = HL_SETTING_NUMBER,
     .unit = "data units", .low = -HL_LIMIT_VOXEL_VALUE, .high = HL_LIMIT_VOXEL_VALUE, .optional = 1,
     .sentence = "The value at which the strip ends; if it is not above `low`, the strip goes over the values that have opacity.",
     .mend = "give a value of the volume"}};

static const hl_setting mesh_rows[] = {
    {.key = "transform/scale", FIELD(hl_scene_mesh, scale), .type = HL_SETTING_NUMBER, .unit = "",
     .high = HL_LIMIT_LENGTH, .open_low = 1, .standard = {1}, .sentence = "A factor on the mesh's size.",
     .mend = "give a factor above 0"},
    {.key = "transform/rotate/axis", FIELD(hl_scene_mesh, rotate_axis), A_DIRECTION, .standard = {0, 0, 1},
     .sentence = "The axis that the mesh is turned about."},
    {.key = "transform/rotate/angle_deg", FIELD(hl_scene_mesh, rotate_angle_deg), .type = HL_SETTING_NUMBER,
     .unit = "degrees", .low = -1e6, .high = 1e6, .sentence = "The angle that the mesh is turned by.",
     .mend = "give an angle in degrees"},
    {.key = "transform/translate", FIELD(hl_scene_mesh, translate), A_POINT,
     .sentence = "The vector that the mesh is moved by, after it was scaled and turned."},
    {.key = "color", FIELD(hl_scene_mesh, color), .type = HL_SETTING_COLOR, .unit = "linear RGB", .high = 1,
     .standard = {0.8, 0.8, 0.8}, .sentence = "The colour, times that of the vertices where they have one.",
     .mend = "give linear RGB, each from {low} to {high}"},
    {.key = "opacity", FIELD(hl_scene_mesh, opacity), .type = HL_SETTING_NUMBER, .unit = "", .high = 1,
     .standard = {1}, .sentence = "The fraction of light that the surface stops.",
     .mend = "give a fraction from {low} to {high}"},
    {.key = "smooth", FIELD(hl_scene_mesh, smooth), A_FLAG, .standard = {1},
     .sentence = "Normals are interpolated between the vertices; else each triangle is flat."},
    {.key = "two_sided", FIELD(hl_scene_mesh, two_sided), A_FLAG, .standard = {1},
     .sentence = "Both sides of the surface are lit; else the back is black."},
    {.key = "visible", FIELD(hl_scene_mesh, visible), A_FLAG, .standard = {1},
     .sentence = "The eye sees the mesh; a mesh that it does not see still casts shadows."},
    {.key = "casts_shadow", FIELD(hl_scene_mesh, casts_shadow), A_FLAG, .standard = {1},
     .sentence = "The mesh takes light from what lies behind it."},
    {.key = "receives_shadow", FIELD(hl_scene_mesh, receives_shadow), A_FLAG, .standard = {1},
     .sentence = "The mesh is darkened by shadows."},
    {.key = "attenuation_color", FIELD(hl_scene_mesh, attenuation_color), .type = HL_SETTING_COLOR,
     .unit = "", .high = 1, .standard = {1, 1, 1},
     .sentence = "The fractions of the opacity that the mesh takes of red, green and blue light.",
     .mend = "give fractions from 0 to 1, 1 for as much as the opacity says"},
    {.key = "cut", FIELD(hl_scene_mesh, cut), A_FLAG, .standard = {1},
     .sentence = "The scene's `cuts` cut the mesh, too; a floor's default is false."}};

static const hl_setting iso_rows[] = {
    {.key = "value", FIELD(hl_isosurface, value), .type = HL_SETTING_NUMBER, .unit = "data units",
     .low = -HL_LIMIT_VOXEL_VALUE, .high = HL_LIMIT_VOXEL_VALUE,
     .sentence = "The value that the volume has everywhere on the surface.", .option = "iso",
     .mend = "give one of the volume's values"},
    {.key = "color", FIELD(hl_isosurface, color), .type = HL_SETTING_COLOR, .unit = "linear RGB", .high = 1,
     .standard = {0.8, 0.8, 0.8}, .sentence = "The surface's colour.",
     .mend = "give linear RGB, each from {low} to {high}"},
    {.key = "opacity", FIELD(hl_isosurface, opacity), .type = HL_SETTING_NUMBER, .unit = "", .high = 1,
     .standard = {1}, .sentence = "The fraction of light that the surface stops, from any angle.",
     .mend = "give a fraction from {low} to {high}"},
    {.key = "second_color", FIELD(hl_isosurface, second_color), A_FLAG, .option = "color-by",
     .sentence = "Whether the surface has the colours that the curves of the volume's transfer function give to "
                 "another volume's values."}};

static const hl_setting cut_rows[] = {
    {.key = "type", FIELD(hl_cut, type), A_CHOICE(cut_types), .sentence = "The shape of the cut."},
    {.key = "point", FIELD(hl_cut, point), A_POINT, .only_for = ONE(HL_CUT_PLANE), .option = "cut-plane",
     .sentence = "A point of the plane, in the units of the volume's own file."},
    {.key = "normal", FIELD(hl_cut, normal), A_DIRECTION, .standard = {0, 0, 1},
     .only_for = ONE(HL_CUT_PLANE), .option = "cut-plane",
     .sentence = "The direction in which all is cut away."},
    {.key = "min", FIELD(hl_cut, min), A_POINT, .only_for = ONE(HL_CUT_BOX), .option = "cut-box",
     .sentence = "The least corner of the box, in the units of the volume's own file."},
    {.key = "max", FIELD(hl_cut, max), A_POINT, .standard = {1, 1, 1}, .only_for = ONE(HL_CUT_BOX),
     .option = "cut-box", .sentence = "The greatest corner of the box."},
    {.key = "center", FIELD(hl_cut, center), A_POINT, .only_for = ONE(HL_CUT_SPHERE), .option = "cut-sphere",
     .sentence = "The sphere's centre, in the units of the volume's own file."},
    {.key = "radius", FIELD(hl_cut, radius), .type = HL_SETTING_NUMBER, .unit = "world units",
     .high = HL_LIMIT_LENGTH, .open_low = 1, .standard = {1}, .only_for = ONE(HL_CUT_SPHERE),
     .option = "cut-sphere", .sentence = "The sphere's radius.", .mend = "give a radius above 0"},
    {.key = "keep", FIELD(hl_cut, keep), A_CHOICE(cut_keeps), .optional = 1,
     .sentence = "What is left: all outside the shape, or only its inside."},
    {.key = "world", FIELD(hl_cut, world), A_FLAG, .optional = 1,
     .sentence = "Lengths are in the scene's world, after the volume's transform; those of a scene's cuts always are."}};

static const hl_setting render_rows[] = {
    {.key = "shadows", FIELD(hl_render_settings, shadows), A_CHOICE(shadows), .standard = {HL_SHADOWS_SOFT},
     .option = "shadows", .sentence = "The shadows of all lights that do not say otherwise."},
    {.key = "soft_method", FIELD(hl_render_settings, soft_method), A_CHOICE(soft_methods),
     .standard = {HL_SOFT_CASCADE}, .option = "soft-method", .sentence = "How soft shadows are made."},
    {.key = "light_samples", FIELD(hl_render_settings, light_samples), .type = HL_SETTING_WHOLE, .unit = "",
     .low = 1, .high = HL_LIMIT_LIGHT_SAMPLES, .standard = {4}, .option = "light-samples",
     .sentence = "M: sublights stand for a light by M x M points.",
     .mend = "give M from {low} to {high}, for M x M parts of the light"},
    {.key = "sheet_spacing", FIELD(hl_render_settings, sheet_spacing), .type = HL_SETTING_NUMBER,
     .unit = "smallest voxel edges", .low = 0.01, .high = 100, .standard = {0.5}, .option = "sheet-spacing",
     .sentence = "The distance of neighbouring sheets; more than 4 is as 4.",
     .mend = "give voxels between sheets, from {low} to {high}"},
    {.key = "kernel", FIELD(hl_render_settings, kernel), A_CHOICE(kernels), .standard = {HL_KERNEL_BSPLINE},
     .option = "kernel", .sentence = "The function that spreads a voxel's value around it."},
    {.key = "reconstruction", FIELD(hl_render_settings, reconstruction), A_CHOICE(reconstructions),
     .option = "reconstruction",
     .sentence = "Whether voxels are splatted onto sheets or samples gather voxels."},
    {.key = "slicing", FIELD(hl_render_settings, slicing), A_CHOICE(slicings), .option = "slicing",
     .sentence = "The direction that the sheets are perpendicular to."},
    {.key = "shadow_lookup", FIELD(hl_render_settings, shadow_lookup), A_CHOICE(lookups),
     .standard = {HL_LOOKUP_AUTO}, .option = "shadow-lookup",
     .sentence = "How light is read between the pixels of a shadow buffer."},
    {.key = "shadow_resolution", FIELD(hl_render_settings, shadow_resolution), .type = HL_SETTING_WHOLE,
     .unit = "pixels", .low = 1, .high = 16384, .choices = automatic_resolution,
     .option = "shadow-resolution", .sentence = "Pixels along the longer side of a shadow buffer.",
     .mend = "give pixels from {low} to {high}, or auto"},
    {.key = "threads", FIELD(hl_render_settings, threads), .type = HL_SETTING_WHOLE, .unit = "",
     .high = HL_LIMIT_THREADS, .option = "threads", .sentence = "0: one thread per processor.",
     .mend = "give a number of threads up to {high}, 0 for one per processor"},
    {.key = "compositing", FIELD(hl_render_settings, compositing), A_CHOICE(compositings), .optional = 1,
     .sentence = "What a pixel shows: lit matter, or the greatest value along its ray, without light."},
    {.key = "slabs_at_once", FIELD(hl_render_settings, slabs_at_once), .type = HL_SETTING_WHOLE, .unit = "",
     .high = HL_LIMIT_SLABS_AT_ONCE, .optional = 1,
     .sentence = "Slabs between two waits of the threads for each other; changes no picture. 0: automatic.",
     .mend = "give a number of slabs up to {high}, 0 for automatic"},
    {.key = "pixel_samples", FIELD(hl_render_settings, pixel_samples), .type = HL_SETTING_WHOLE, .unit = "",
     .high = HL_LIMIT_PIXEL_SAMPLES, .optional = 1, .option = "pixel-samples",
     .sentence = "N: a pixel is the mean of N x N samples at least. 0: one, and more of voxels smaller than pixels.",
     .mend = "give N up to {high}, for N x N samples in a pixel, 0 for automatic"}};

#define A_RADIANCE                                                                          \
  .type = HL_SETTING_COLOR, .unit = "linear RGB", .high = HL_LIMIT_RADIANCE,                \
  .mend = "give linear RGB, each from {low} to {high}"

static const hl_setting sky_rows[] = {
    {.key = "type", FIELD(hl_sky, type), A_CHOICE(skies), .standard = {HL_SKY_NONE},
     .sentence = "Where the colours of the light from all directions come from."},
    {.key = "color", FIELD(hl_sky, color), A_RADIANCE, .standard = {1, 1, 1},
     .only_for = ONE(HL_SKY_UNIFORM), .sentence = "The radiance from every direction."},
    {.key = "zenith", FIELD(hl_sky, zenith), A_RADIANCE, .standard = {0.8, 0.9, 1},
     .only_for = ONE(HL_SKY_GRADIENT), .sentence = "The radiance from straight above."},
    {.key = "horizon", FIELD(hl_sky, horizon), A_RADIANCE, .standard = {1, 1, 1},
     .only_for = ONE(HL_SKY_GRADIENT), .sentence = "The radiance from the horizon."},
    {.key = "ground", FIELD(hl_sky, ground), A_RADIANCE, .standard = {0.3, 0.27, 0.24},
     .only_for = ONE(HL_SKY_GRADIENT), .sentence = "The radiance from straight below."},
    {.key = "rotation_deg", FIELD(hl_sky, rotation_deg), .type = HL_SETTING_NUMBER, .unit = "degrees",
     .low = -1e6, .high = 1e6, .only_for = ONE(HL_SKY_IMAGE), 
     .sentence = "The angle that the image is turned by about up, counterclockwise as seen from above.",
     .mend = "give degrees from {low} to {high}"},
    {.key = "up", FIELD(hl_sky, up), A_DIRECTION, .standard = {0, 0, 1}, .only_for = SHINING,
     .sentence = "The direction of the zenith."},
    {.key = "hemisphere", FIELD(hl_sky, hemisphere), A_FLAG, .only_for = SHINING,
     .sentence = "Nothing shines below the horizon."},
    {.key = "strength", FIELD(hl_sky, strength), .type = HL_SETTING_NUMBER, .unit = "",
     .high = HL_LIMIT_RADIANCE, .standard = {1}, .only_for = SHINING,
     .sentence = "A factor on the sky's colours.", .mend = "give a factor from {low} to {high}"},
    {.key = "suns", FIELD(hl_sky, suns), A_FLAG, .standard = {1}, .only_for = ONE(HL_SKY_IMAGE), .optional = 1,
     .sentence = "Up to four compact bright spots of the image cast shadows as parallel lights do."}};

/* clang-format on */

#define TABLE(rows) \
  { rows, sizeof rows / sizeof *rows }
static const struct {
  const hl_setting *rows;
  size_t count;
} tables[] = {
    [HL_SETTINGS_SCENE] = TABLE(scene_rows),
    [HL_SETTINGS_IMAGE] = TABLE(image_rows),
    [HL_SETTINGS_CAMERA] = TABLE(camera_rows),
    [HL_SETTINGS_LIGHT] = TABLE(light_rows),
    [HL_SETTINGS_VOLUME] = TABLE(volume_rows),
    [HL_SETTINGS_MATERIAL] = TABLE(material_rows),
    [HL_SETTINGS_RENDER] = TABLE(render_rows),
    [HL_SETTINGS_MESH] = TABLE(mesh_rows),
    [HL_SETTINGS_SKY] = TABLE(sky_rows),
    [HL_SETTINGS_ISO] = TABLE(iso_rows),
    [HL_SETTINGS_CUT] = TABLE(cut_rows),
    [HL_SETTINGS_TRANSFER_FUNCTION] = TABLE(transfer_function_rows),
};

size_t hl_setting_count(hl_setting_kind kind) {
  return (int)kind >= 0 && (size_t)kind < sizeof tables / sizeof *tables ? tables[kind].count : 0;
}

const hl_setting *hl_setting_get(hl_setting_kind kind, size_t index) {
  return index < hl_setting_count(kind) ? &tables[kind].rows[index] : NULL;
}
