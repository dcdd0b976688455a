/* halflight/scene.h - describes scenes, which have a camera, volumes, meshes and render settings. light.h
 * describes a scene's lights.
 *
 * A description is plain data. hl_scene_create() checks it and keeps a deep copy, which never changes.
 * Lengths are in world units, angles in degrees, and colours in linear RGB. Axes are right-handed. */
#ifndef HALFLIGHT_SCENE_H
#define HALFLIGHT_SCENE_H

#include "image.h"
#include "light.h"
#include "mesh.h"
#include "shape.h"
#include "transfer_function.h"
#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hl_camera_type { HL_CAMERA_PERSPECTIVE = 0, HL_CAMERA_ORTHOGRAPHIC = 1 } hl_camera_type;

/* The camera. position, target: points of the world; the camera looks from position to target. up: the
 * direction that is up in the picture, of any length. */
typedef struct hl_camera {
  hl_camera_type type;
  double position[3], target[3], up[3];
  double fovy_deg; /* perspective camera: the vertical field of view */
  double height;   /* orthographic camera: the height of the picture in world units */
} hl_camera;

/* The ways in which the matter of a volume is lit. */
typedef enum hl_shading {
  HL_SHADING_PHONG = 0,
  HL_SHADING_NONE = 1, /* the matter is a medium: it is lit and shadowed, but has no surface */
  HL_SHADING_FLAT = 2  /* the matter has the transfer function's colour; light and shadow do not change it */
} hl_shading;

/* The numbers by which a surface reflects light, in Phong's model (docs/equations.md). */
typedef struct hl_material {
  double ambient, diffuse, specular, shininess; /* the model's factors ka, kd, ks and its exponent n */
  double emission; /* ke: the fraction of the colour that shines without any light; default 0 */
} hl_material;

/* An isosurface: a surface on which a volume has one value. The isosurface takes the same fraction of light
 * at any angle, as a sheet of paper does. The surface has the volume's material, and the volume's gradient as
 * its normal. */
typedef struct hl_isosurface {
  double value;
  double color[3];  /* linear RGB */
  double opacity;   /* 0 to 1 */
  int second_color; /* non-zero if the curves of the volume's function (HL_SECOND_VOLUME) give the colours;
                     * the surface has `color` where they keep the volume's own, or if there are none */
} hl_isosurface;

/* The shapes of cuts. A cut removes the matter inside its shape, or with HL_CUT_KEEP_INSIDE the matter
 * outside. The cut of a volume has lengths in the units of the volume's file, before the volume's transform.
 * The cut of a scene has lengths in the scene's world. */
typedef enum hl_cut_type {
  HL_CUT_PLANE = 0, /* the half space on the side to which the plane's normal points */
  HL_CUT_BOX = 1,
  HL_CUT_SPHERE = 2
} hl_cut_type;
typedef enum hl_cut_keep { HL_CUT_KEEP_OUTSIDE = 0, HL_CUT_KEEP_INSIDE = 1 } hl_cut_keep;
typedef struct hl_cut {
  hl_cut_type type;
  double point[3], normal[3]; /* plane: a point of the plane, and a normal of any length */
  double min[3], max[3];      /* box: its least and its greatest corner */
  double center[3], radius;   /* sphere: its centre and its radius */
  hl_cut_keep keep;           /* the side of the shape whose matter stays; default: the outside */
  int world; /* non-zero if a volume's cut has its lengths in the scene's world, after the volume's transform;
              * default 0 */
} hl_cut;

/* The ways in which matter is shaded at the faces that a cut, the clip box or a mask leaves. Behind the face
 * of a cut or of the clip box, this holds down to a depth of one voxel. From there on the effect fades, and
 * it ends at a depth of two voxels. */
typedef enum hl_cut_shading {
  HL_CUT_SHADING_FACE = 0,     /* the matter is shaded by the face's own normal */
  HL_CUT_SHADING_GRADIENT = 1, /* the matter is shaded by the gradient of the data, as if nothing were cut */
  HL_CUT_SHADING_NONE = 2      /* the matter is shaded as a medium, which has no normal */
} hl_cut_shading;

/* A label of a label map. The label is the region of all voxels with the label's value. */
typedef struct hl_label {
  int64_t value;
  const char *name; /* may be null */
  double color[3];  /* linear RGB */
  double opacity;   /* 1: the label is solid; below 1: the label's surface is a skin that takes this fraction
                     * of the light that crosses it */
  int visible;
  double tint;  /* only for the labels of a mask: the fraction of the label's colour that the matter takes; at
                 * 0 the matter keeps its own colour, at 1 it has `color` */
  int unlisted; /* non-zero: legends have no row for the label (a translucent "rest" of the option "show") */
} hl_label;

/* A label map that hides, reveals or colours the matter of a volume. The mask's effect is smooth at the
 * labels' borders. Within a label the volume's extinction is multiplied by the label's opacity, or by 0 if
 * the label is not visible. Where a mask hides matter, the matter beside the hidden matter gets faces.
 * HL_CUT_SHADING_FACE lights these faces by the normals of the labels' borders. */
typedef struct hl_mask {
  hl_volume *volume;      /* the label map, in the world of the volume's file; its grid may differ from the
                           * volume's. The scene retains the label map; null if there is no mask */
  const char *file;       /* the file that the label map came from, which hl_scene_to_json writes; may be
                           * null */
  int component;          /* the component of the file that the label map was read from, which
                           * hl_scene_to_json writes; default HL_COMPONENT_DEFAULT */
  const hl_label *labels; /* [label_count]; sorted by value, the least first */
  size_t label_count;
  double rest; /* the factor of the volume's extinction outside all labels: 0 (the default) hides the matter
                * outside the labels, 1 leaves it as it is. The option "show" of hl_scene_compose() takes a
                * fraction of opacity instead, and converts it to this factor */
} hl_mask;

/* A volume in a scene, with its place, its look and its cuts. */
typedef struct hl_scene_volume {
  const char *name;   /* may be null */
  const char *file;   /* the file that the voxels came from, which hl_scene_to_json writes; may be null */
  const char *shapes; /* the text of the shapes from which hl_volume_from_shapes() made the voxels; may be
                       * null */
  /* The array of the file that was read, which hl_scene_to_json writes; may be null. This member and the next
   * three are the options of hl_volume_load_options with the same names */
  const char *array;
  int component;      /* default HL_COMPONENT_DEFAULT */
  double spacing[3];  /* default 0 */
  const char *series; /* may be null */
  hl_volume *volume;  /* retained by the scene */
  double scale;       /* the volume is scaled, then rotated about the origin, then translated */
  double rotate_axis[3];
  double rotate_angle_deg;
  double translate[3];
  hl_transfer_function transfer_function;
  hl_shading shading;
  hl_material material;
  double attenuation_color[3]; /* factors of the extinction in R, G and B */
  int visible, casts_shadow, receives_shadow;
  int clipped;                     /* non-zero if the matter outside the box clip_min..clip_max is removed */
  double clip_min[3], clip_max[3]; /* the box's corners in the world of the volume's file, not transformed */
  double axis_scale[3];     /* factors of the volume's size along x, y and z of the world of its file, in
                             * addition to `scale`; the volume is stretched before it is rotated */
  int time, channel, level; /* the time step, the channel and the resolution that were read
                             * (hl_volume_load_options), which hl_scene_to_json writes; default
                             * HL_INDEX_DEFAULT */
  double anisotropy; /* the anisotropy g of Henyey and Greenstein's phase function, by which a medium scatters
                      * light: above 0 mostly forward, below 0 mostly backward, 0 (the default) evenly in all
                      * directions */
  const hl_isosurface *iso; /* [iso_count]; isosurfaces of the volume, which are shown beside the matter that
                             * the transfer function shows */
  size_t iso_count;
  double albedo[3]; /* the scattering albedo in R, G and B: the fraction of the extinguished light that a
                     * medium scatters. It multiplies the medium's colour; default 1 */
  int multiple_scattering; /* non-zero if light may be scattered several times in the medium; 0, the default,
                            * if it is scattered once */
  /* [label_count]; sorted by value, the least first. A volume with labels is a label map. It shows its
   * visible labels, with smooth borders and in their colours. The transfer function of a label map is made
   * from the labels. */
  const hl_label *labels;
  size_t label_count;
  const hl_cut *cuts; /* [cut_count]; matter stays only where none of the cuts removes it */
  size_t cut_count;
  hl_cut_shading cut_shading;
  int cut_casts_shadow; /* non-zero if the matter that `cuts` remove still casts its shadow; default 0 */
  hl_mask mask;         /* the volume's mask; a label map must not have one */
  /* Small bodies are hidden. Voxels beyond the value scraps_firm that share faces are one body. Bodies with
   * fewer voxels than the part scraps_least of the largest body's are hidden, and so is matter between
   * scraps_faint and scraps_firm that is more than four voxels from all other bodies. If scraps_firm is
   * below scraps_faint, matter has low values. Functions that show values on the other side of scraps_faint
   * hide no body. scraps_least: 0, the default, hides nothing */
  double scraps_faint, scraps_firm, scraps_least;
  /* The range of values over which the strip of a legend goes, as the option "range" states it. If legend_low
   * is not below legend_high (the default), the strip goes over the values that have opacity */
  double legend_low, legend_high;
  const char *file_space; /* see hl_volume_load_options; may be null */
} hl_scene_volume;

/* A mesh in a scene. `color` multiplies the colours of the mesh's vertices, faces or spheres, if the mesh has
 * colours. */
typedef struct hl_scene_mesh {
  const char *name; /* may be null */
  const char *file; /* the file that the mesh came from, which hl_scene_to_json writes; if null,
                     * hl_scene_to_json writes the mesh's arrays */
  hl_mesh *mesh;    /* retained by the scene */
  double scale;     /* the mesh is scaled, then rotated about the origin, then translated */
  double rotate_axis[3];
  double rotate_angle_deg;
  double translate[3];
  double color[3]; /* linear RGB */
  double opacity;  /* the fraction of light that the surface takes, 0 to 1. It is multiplied by the opacity of
                    * the mesh's vertices, faces or spheres */
  hl_material material;
  int smooth;    /* non-zero if normals are interpolated between vertices; 0 if each triangle is flat */
  int two_sided; /* non-zero if the back of a triangle is lit like its front; 0 if the back is black */
  int visible, casts_shadow, receives_shadow;
  double attenuation_color[3]; /* the fractions of red, green and blue light that the surface takes, by which
                                * `opacity` is multiplied */
  int cut;                     /* non-zero if the scene's cuts cut the mesh */
} hl_scene_mesh;

typedef enum hl_soft_method { HL_SOFT_CASCADE = 0, HL_SOFT_PAPER = 1, HL_SOFT_SUBLIGHTS = 2 } hl_soft_method;
typedef enum hl_kernel {
  HL_KERNEL_BSPLINE = 0,
  HL_KERNEL_GAUSSIAN = 1,
  HL_KERNEL_LINEAR = 2,
  HL_KERNEL_INTERPOLATING = 3 /* a cubic B-spline over coefficients that are chosen so that the field has the
                               * voxels' values at the voxels; this kernel is sharper than the others */
} hl_kernel;
typedef enum hl_reconstruction {
  HL_RECONSTRUCTION_AUTO = 0, /* the renderer uses HL_RECONSTRUCTION_GATHER, which was faster than splatting
                               * in all measurements */
  HL_RECONSTRUCTION_SPLAT = 1,
  HL_RECONSTRUCTION_GATHER = 2
} hl_reconstruction;
typedef enum hl_slicing { HL_SLICING_HALF_VECTOR = 0, HL_SLICING_IMAGE_ALIGNED = 1 } hl_slicing;
/* The ways in which transmittance is interpolated between the pixels of a shadow buffer. */
typedef enum hl_shadow_lookup {
  HL_LOOKUP_BILINEAR = 0,
  HL_LOOKUP_NEAREST = 1,
  HL_LOOKUP_CUBIC = 2, /* interpolation by cubic convolution, which is sharper than bilinear; the buffers of
                        * sub-lights are interpolated bilinearly nevertheless */
  HL_LOOKUP_AUTO = 3   /* cubic with larger pixels for two kinds of shadows: cascade shadows of lights without
                        * an emission image, and hard shadows where sheets are close; bilinear for all other
                        * shadows */
} hl_shadow_lookup;

/* The ways in which a pixel is computed from the samples along a ray. */
typedef enum hl_compositing {
  HL_COMPOSITING_LIGHT = 0,  /* lit matter is composited from front to back */
  HL_COMPOSITING_MAXIMUM = 1 /* maximum projection, without light: a pixel has the colour of the greatest
                              * value on its ray; values of opacity 0 do not count. Where several volumes
                              * overlap, each channel of the pixel is the greatest among the volumes'
                              * colours */
} hl_compositing;

/* The settings by which a scene is rendered. */
typedef struct hl_render_settings {
  hl_shadows shadows; /* off, hard or soft */
  hl_soft_method soft_method;
  int light_samples;    /* HL_SOFT_SUBLIGHTS: the number M; an extended light is replaced by M x M
                         * sub-lights */
  double sheet_spacing; /* the distance between neighbouring sheets, in units of the shortest voxel edge of
                         * the scene */
  hl_kernel kernel;
  hl_reconstruction reconstruction;
  hl_slicing slicing;
  hl_shadow_lookup shadow_lookup;
  int shadow_resolution; /* number of pixels along the longer side of a shadow buffer; if 0, the renderer
                          * chooses it */
  int threads;           /* number of threads; 0 stands for one thread for each processor */
  hl_compositing compositing;
  int slabs_at_once; /* the number of slabs after which the threads wait for each other. The picture does not
                      * depend on it; if 0, the renderer chooses the number */
  int pixel_samples; /* the number N; a pixel is the mean of at least N x N samples, which smooths the edges
                      * of cut faces. If 0, a pixel has one sample, or more if voxels are smaller than it */
} hl_render_settings;

/* The kinds of marks: the length between two points (ruler), the angle of three points at the second of them,
 * the length of a line of several pieces, an arrow that ends at the second of two points, and a text at a
 * point. */
typedef enum hl_mark_kind {
  HL_MARK_RULER = 0,
  HL_MARK_ANGLE = 1,
  HL_MARK_LINE = 2,
  HL_MARK_ARROW = 3,
  HL_MARK_TEXT = 4
} hl_mark_kind;

/* A mark: a measure or a text at places of a scene's world. Renderers do not show marks: a figure draws it
 * over the picture (hl_overlay's marks). */
typedef struct hl_mark {
  hl_mark_kind kind;
  const char *text;          /* UTF-8; the text that is written before the measure; may be null */
  const double (*points)[3]; /* [point_count]; points of the scene's world. A ruler and an arrow have 2
                              * points, an angle 3, a line 2 to 500, and a text 1 */
  size_t point_count;
} hl_mark;

/* Everything that a picture depends on. hl_scene_create() makes a scene of it. */
typedef struct hl_scene_description {
  size_t struct_size;         /* set by hl_scene_description_defaults() */
  int width, height;          /* pixels */
  double background[3];       /* linear RGB */
  int background_transparent; /* non-zero if a PNG of the picture keeps alpha */
  hl_camera camera;
  double ambient[3]; /* Ia of Phong's model: constant light that reaches all matter */
  const hl_light *lights;
  size_t light_count;
  const hl_scene_volume *volumes;
  size_t volume_count;
  hl_render_settings render;
  const char *description; /* one sentence about the scene; may be null */
  double exposure;         /* exposure in stops: picture files such as PNG show the volumes' light times
                            * 2^exposure; default 0 */
  const hl_scene_mesh *meshes;
  size_t mesh_count;
  const hl_cut *cuts; /* [cut_count]; cuts of all volumes, and of the meshes whose member `cut` is set. The
                       * faces and shadows of a cut volume follow the volume's cut_shading and
                       * cut_casts_shadow. Lengths are in the scene's world, whatever hl_cut.world says */
  size_t cut_count;
  hl_tone tone; /* the way in which picture files such as PNG show light that is brighter than white; default
                 * HL_TONE_CLIP */
  hl_sky sky;
  int background_sky;   /* non-zero if pictures show the sky in place of the background, and have alpha 1
                         * everywhere; default 0 */
  const hl_mark *marks; /* [mark_count]; marks, which change no picture; figures can draw them over a
                         * picture */
  size_t mark_count;
} hl_scene_description;

typedef struct hl_scene hl_scene; /* A scene, which never changes and is reference-counted */

/* Each of these functions fills a struct with its defaults. */
HL_API void hl_scene_description_defaults(hl_scene_description *description);
HL_API void hl_light_defaults(hl_light *light);
HL_API void hl_scene_volume_defaults(hl_scene_volume *volume);
HL_API void hl_scene_mesh_defaults(hl_scene_mesh *mesh);
HL_API void hl_isosurface_defaults(hl_isosurface *surface);
HL_API void hl_cut_defaults(hl_cut *cut);

/* Moves a point from the world of the volume's file to the scene's world: applies the volume's scale,
 * rotation and translation. Does nothing if an argument is null. */
HL_API void hl_scene_volume_place_point(const hl_scene_volume *volume, double point[3]);

/* Makes a scene: checks and copies the description, and retains its volumes. Errors name the field as a JSON
 * pointer ("/lights/0/radius"). The smooth fields of labels and masks are made later, for the scene's first
 * frame. So if none of the visible labels has voxels, or if too many labels show, this function succeeds and
 * the first frame fails. */
HL_API HL_WARN_UNUSED hl_status hl_scene_create(hl_context *context, const hl_scene_description *description,
                                                hl_scene **scene, hl_error *error);

/* Reads a scene file and the volumes that it names. Relative paths in the file are relative to the file's
 * folder. *scene is owned by the caller, who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_scene_load(hl_context *context, const char *path, hl_scene **scene,
                                              hl_error *error);

/* Reads a scene from JSON text. text: UTF-8, length bytes. base_folder: the folder to which relative paths in
 * the text are relative; null stands for the current folder. name: the text's name in errors. */
HL_API HL_WARN_UNUSED hl_status hl_scene_from_json(hl_context *context, const char *text, size_t length,
                                                   const char *base_folder, const char *name,
                                                   hl_scene **scene, hl_error *error);

/* Reads a scene like hl_scene_from_json(), for editors and viewers whose scene changes many times a second.
 * No file is opened: volumes and the lights' images are taken from the scene `like`. A volume of `like` is
 * taken if it has the same file and the same options for reading it, or the same shapes. A text with a volume
 * or an image that `like` lacks is refused with HL_ERROR_INPUT. If like is null, files are opened. */
HL_API HL_WARN_UNUSED hl_status hl_scene_from_json_like(hl_context *context, const char *text, size_t length,
                                                        const char *base_folder, const char *name,
                                                        const hl_scene *like, hl_scene **scene,
                                                        hl_error *error);

/* Writes the scene as JSON text. *text: null-terminated; free with hl_text_release(). */
HL_API HL_WARN_UNUSED hl_status hl_scene_to_json(hl_context *context, const hl_scene *scene, char **text,
                                                 hl_error *error);
/* Writes the scene as JSON text that will be stored in `folder`, or in a picture in this folder. Files in the
 * folder or below it are named relative to it. folder: "" is the current folder; null: all files are named as
 * by hl_scene_to_json(). */
HL_API HL_WARN_UNUSED hl_status hl_scene_to_json_beside(hl_context *context, const hl_scene *scene,
                                                        const char *folder, char **text, hl_error *error);
HL_API void hl_text_release(hl_context *context, char *text);

/* Makes a scene that shows one volume well without further settings: a three-quarter view, automatic transfer
 * function, key light from the upper left with soft shadows, and a sky. If the context's memory limit is
 * below the sum of 512 MiB and twice the volume's bytes, the scene has constant light in place of a sky.
 * Things beside a scanned object that hold it, such as a head rest, rails or a towel, are removed by up to 8
 * planes among the volume's cuts. These planes remove nothing of the object. A label map
 * (hl_volume_is_label_map()) gets the labels of its voxels, with the names and colours in its file. file may
 * be null (see hl_scene_volume). */
HL_API HL_WARN_UNUSED hl_status hl_scene_for_volume(hl_context *context, hl_volume *volume, const char *file,
                                                    hl_scene **scene, hl_error *error);

/* Makes a scene as hl_scene_for_volume() does, but with the look of this name (hl_look_name()), whatever the
 * data are. "mip" is the look that suits the volume, with voxels that are not smoothed. file may be null. */
HL_API HL_WARN_UNUSED hl_status hl_scene_for_volume_look(hl_context *context, hl_volume *volume,
                                                         const char *file, const char *look, hl_scene **scene,
                                                         hl_error *error);

/* Makes a scene of meshes without a volume. Like a bare volume they get a camera that frames them, a soft key
 * light, a sky and a dark grey background. meshes: [count], each with its mesh; the scene keeps references to
 * the meshes. *scene is owned by the caller, who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_scene_for_meshes(hl_context *context, const hl_scene_mesh *meshes,
                                                    size_t count, hl_scene **scene, hl_error *error);

/* Joins several scenes that hl_scene_for_volume() has made of one volume each. All volumes stand in one
 * world, each with its own look. Its unit of length is the first that a file tells; volumes of other units
 * are scaled. Light, background and render settings are the first scene's. The distance between sheets is
 * the least of all scenes, and the camera shows all volumes. A volume without a name is named after its
 * file, without folder and extensions. If another volume has this name already, "-2", "-3" and so on is
 * appended. scenes: [count], each scene has one volume; the caller may release them afterwards. */
HL_API HL_WARN_UNUSED hl_status hl_scene_join(hl_context *context, hl_scene *const *scenes, size_t count,
                                              hl_scene **scene, hl_error *error);

/* Returns the distance between sheets for a scene of several volumes, in units of its shortest voxel edge. It
 * is the least distance that one of the volumes asks for, rounded to six decimals. hl_scene_join() takes this
 * distance. spacings: [description->volume_count], the distance that each volume asks for, in units of its
 * own shortest edge. If a volume's edge has no length, or there is no volume, the function returns the
 * description's own distance. It returns 0 if an argument is null. */
HL_API double hl_scene_joined_spacing(const hl_scene_description *description, const double *spacings);

/* Makes a scene of several channels of a file, such as a microscope's. Each channel is a volume with the look
 * that hl_scene_for_volume_look() gives it, in the colour of hl_scene_channel_color(). The volume's name is
 * the channel's name in the file, or else "channel0" and so on. path, options: as for hl_volume_load_with();
 * options may be null, which stands for the defaults; options->channel and options->channel_name are not
 * used, and options->bytes is read once for each channel. channels: numbers, from 0, and names of channels,
 * separated by commas (hl_volume_load_options.channel_name); a name may hold commas of its own, and the
 * longest name that fits counts. "all" or null stands for all channels. At most HL_CHANNELS_MOST. smooth:
 * the sigma of hl_volume_smooth() for each channel; null: as hl_scene_for_volume_look() smooths it. */
enum { HL_CHANNELS_MOST = 16 };
HL_API HL_WARN_UNUSED hl_status hl_scene_for_channels(hl_context *context, const char *path,
                                                      const hl_volume_load_options *options,
                                                      const char *channels, const double *smooth,
                                                      const char *look, hl_scene **scene, hl_error *error);

/* Finds a colour, sRGB from 0 to 1, by which volume number `index` differs from the other volumes of its
 * scene. If the files give the channel of each volume a colour (OME, ImageJ, omero) and these colours differ,
 * the result is the channel's colour. Otherwise the result is one of green, magenta, cyan, yellow, orange and
 * blue, in this order. */
HL_API HL_WARN_UNUSED hl_status hl_scene_channel_color(const hl_scene_description *description, size_t index,
                                                       double srgb[3]);

/* Replaces the sky by constant light, in a description that hl_scene_for_volume() or a similar function made.
 * The picture as a whole stays about as bright, but the sky casts no shadows, and frames are faster. */
HL_API void hl_scene_level_sky(hl_scene_description *description);

/* Finds a factor by which the strengths of all lights, `ambient` and the sky's strength should be multiplied.
 * It is meant for a scene of hl_scene_for_volume() whose volume was then cut, got isosurfaces, or was made to
 * scatter light more than once: a cut face that is turned to the light, a white surface, or a cloud that
 * glows inside, would be brighter than white. look: the look that the scene was made with. *factor is 1 for
 * looks that keep their light, and for orthographic cameras. */
HL_API HL_WARN_UNUSED hl_status hl_scene_light_factor(const hl_scene_description *description,
                                                      const char *look, double *factor, hl_error *error);

/* Returns the name of light rig number `index`: studio, raking, rim or overcast; null past the last. */
HL_API const char *hl_light_rig_name(size_t index);

/* The greatest number of lights that a light rig has. */
#define HL_LIGHT_RIG_MOST 4

/* Gives a description the lights of a named rig, which move with the camera, and a sky of the rig's strength.
 * A description without a sky gets a sky that is brighter above than below, and "overcast" makes the sky
 * grey. The lights and the sky together are about as strong as the light was before. In a scene of
 * hl_scene_for_volume(), multiply all strengths by the factor of hl_scene_light_factor() afterwards. lights:
 * the caller's, [HL_LIGHT_RIG_MOST]; description->lights points to this array afterwards. Errors:
 * HL_ERROR_ARGUMENT for an unknown name. */
HL_API HL_WARN_UNUSED hl_status hl_scene_light_rig(const char *rig, hl_scene_description *description,
                                                   hl_light lights[HL_LIGHT_RIG_MOST], hl_error *error);

/* Returns the name of look number `index`: "auto" (the look that suits the volume's data), "surface",
 * "translucent", "xray", "smoke" or "vessels"; null past the last. */
HL_API const char *hl_look_name(size_t index);

/* Makes the transfer function and finds the shading that a look gives to a volume. Free *function with
 * hl_transfer_function_release(). */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_look(hl_context *context, const char *look,
                                                          const hl_volume *volume,
                                                          hl_transfer_function *function, hl_shading *shading,
                                                          hl_error *error);

/* Finds the kind of data in a volume, as hl_scene_for_volume() guesses it to choose a look: "scanned body",
 * "scanned brain", "scanned matter", "vessels" (bright tubes within other matter, as angiography shows them),
 * "labels", "field", "flow", "signed field", "smoke or cloud", "particles" or "one value". file: the volume's
 * file, as for hl_scene_for_volume(). *kind is a constant text. */
HL_API HL_WARN_UNUSED hl_status hl_volume_guess(const hl_volume *volume, const char *file, const char **kind,
                                                hl_error *error);

/* Finds the name of the look (hl_look_name()) to try next if the picture of hl_scene_for_volume() is not
 * good: because a wrong kind of data was guessed, or because the look shows too little. file: the volume's
 * file, as for hl_scene_for_volume(). *name is a constant text. */
HL_API HL_WARN_UNUSED hl_status hl_volume_next_look(const hl_volume *volume, const char *file,
                                                    const char **name, hl_error *error);

/* Returns the description that the scene keeps; it belongs to the scene. To change a scene, change a copy of
 * the description and create another scene of the copy. Returns null for null. */
HL_API const hl_scene_description *hl_scene_describe(const hl_scene *scene);

HL_API void hl_scene_retain(hl_scene *scene);
HL_API void hl_scene_release(hl_scene *scene); /* null is allowed */

/* ---- label maps ---- */

/* Lists the labels that a volume's voxels have, except 0, in rising order. All labels are visible and solid.
 * Names and colours come from the table, or else from the volume's file (.seg.nrrd). A label to which neither
 * gives a colour gets a colour that differs from the others. table: the path of a colour table of FreeSurfer
 * or Slicer, of ITK-SNAP's label descriptions or of a CSV file; null if there is none. *labels is owned by
 * the caller (hl_labels_release). HL_ERROR_INPUT: a value is no whole number. HL_ERROR_UNSUPPORTED: the map
 * lies in a scratch file or in bricks. If the map lies over ranks (ranks.h), the first call is collective:
 * each rank gets a copy of the whole map, which the map keeps. */
HL_API HL_WARN_UNUSED hl_status hl_labels_of_volume(hl_context *context, const hl_volume *map,
                                                    const char *table, hl_label **labels, size_t *count,
                                                    hl_error *error);
/* Makes a mesh of the smooth surface around all visible labels of a list, as the labels are drawn. map: the
 * label map; labels: [count], rising by value. Positions are in the world of the map's file. HL_ERROR_INPUT:
 * the map has none of the visible labels. *mesh is owned by the caller, who releases it. */
HL_API HL_WARN_UNUSED hl_status hl_mesh_of_labels(hl_context *context, hl_volume *map, const hl_label *labels,
                                                  size_t count, hl_mesh **mesh, hl_error *error);
HL_API void hl_labels_release(hl_context *context, hl_label *labels); /* null is allowed */

/* Sets *labels to 1 where the volume's values are probably labels of regions, else to 0. They probably are
 * labels if the file names segments, or if the values are few different whole numbers that fill connected
 * regions. hl_scene_for_volume() draws such a volume by its labels. */
HL_API HL_WARN_UNUSED hl_status hl_volume_is_label_map(hl_context *context, const hl_volume *volume,
                                                       int *labels, hl_error *error);

/* ---- where the camera stands ---- */

/* A direction from which the volumes are seen. */
typedef struct hl_view {
  double up[3];       /* unit vector; the direction that is up in the picture at elevation 0 and roll 0 */
  double front[3];    /* unit vector, perpendicular to up; points from the volumes to the eye at azimuth 0 and
                       * elevation 0 */
  double azimuth_deg; /* the angle by which the eye is turned about up; positive: the eye moves to its
                       * right */
  double elevation_deg; /* the angle by which the eye is raised, -90 to 90; positive: up */
  double roll_deg;      /* the angle by which the picture is turned; positive: clockwise */
} hl_view;

/* The sides from which the volumes can be seen. If the file says how a patient lies (hl_volume_info.space),
 * left is the patient's left side, and the patient's front is at the upper edge of pictures from the top and
 * from the bottom. Otherwise left is the side that lies to the left as seen from the
 * front. */
typedef enum hl_side {
  HL_SIDE_AUTOMATIC = 0, /* the three-quarter view that shows the most of the volumes */
  HL_SIDE_FRONT = 1,
  HL_SIDE_BACK = 2,
  HL_SIDE_LEFT = 3,
  HL_SIDE_RIGHT = 4,
  HL_SIDE_TOP = 5,
  HL_SIDE_BOTTOM = 6,
  HL_SIDE_ISO = 7 /* azimuth 45 and elevation 35.26: the view on a cube's corner, in which the cube's three
                   * edges at this corner look alike */
} hl_side;

/* Finds the view from a side. up: the direction that is up, of any length. If up is null, the direction
 * follows from the patient's position if the file tells it, or else is guessed from the voxels. If the file
 * does not say how a patient lies, the view from the front has +x to its right (+y where up is along x). But
 * if such a volume is the scan of a body and its back has clearly more relief, as a head's face has, all
 * sides are turned by half a turn. A scene file without a camera has the side HL_SIDE_AUTOMATIC. */
HL_API HL_WARN_UNUSED hl_status hl_view_choose(const hl_scene_description *description, hl_side side,
                                               const double up[3], hl_view *view, hl_error *error);

/* Finds the view of the description's camera, with roll 0. view->up is the camera's up vector. But if this
 * vector is an axis of the world made perpendicular to the line of sight, view->up is the axis itself. Fails
 * where position and target are the same. */
HL_API HL_WARN_UNUSED hl_status hl_view_of_camera(const hl_scene_description *description, hl_view *view);

/* Places the camera so that the visible voxels of all volumes fill the picture and are in its middle. The
 * picture leaves room for turning the camera: at zoom 1, everything stays in the picture while the camera
 * turns about view->up (hl_camera_turn()). There is also room for turns about other axes, if the visible
 * voxels still fill at least four fifths of the picture. camera->type and fovy_deg are kept. Fails where zoom
 * is not from 1e-6 to 1e6, the view or the field of view is impossible, or there is no volume
 * (HL_ERROR_ARGUMENT), and for lack of memory. */
HL_API HL_WARN_UNUSED hl_status hl_camera_frame_view(const hl_scene_description *description,
                                                     const hl_view *view, double zoom, hl_camera *camera,
                                                     hl_error *error);

/* Frames everything anew, as hl_camera_frame_view() does at zoom 1. *camera keeps the direction of the
 * description's camera. Fails as hl_view_of_camera() and hl_camera_frame_view() do. */
HL_API HL_WARN_UNUSED hl_status hl_camera_reframe(const hl_scene_description *description, hl_camera *camera,
                                                  hl_error *error);

/* Finds the planes through the sides of the picture of the description's camera, between which lies
 * everything that the picture sees: a point p of the world lies inside if a x + b y + c z + d >= 0 for each
 * plane a, b, c, d. Fails for an impossible camera or size of the picture. */
HL_API HL_WARN_UNUSED hl_status hl_scene_seen_part(const hl_scene_description *description,
                                                   double planes[4][4]);

/* Moves the camera around its target, at the same distance, until it has the given view. */
HL_API HL_WARN_UNUSED hl_status hl_camera_turn(const hl_view *view, hl_camera *camera);

/* Places the camera so that the visible voxels of all volumes fill the picture, without room for turning the
 * camera. At azimuth 0 the camera looks along the world's +y; a positive azimuth moves the eye to its right.
 * At elevation 90 the camera looks straight down along z. zoom 1 frames everything. camera->type and fovy_deg
 * are kept. */
HL_API HL_WARN_UNUSED hl_status hl_camera_frame(const hl_scene_description *description, double azimuth_deg,
                                                double elevation_deg, double zoom, hl_camera *camera);

/* Frames the visible voxels as hl_camera_frame() does, but keeps the camera's direction and up vector: it
 * changes only the position, the target and the height. */
HL_API HL_WARN_UNUSED hl_status hl_camera_fit(const hl_scene_description *description, double zoom,
                                              hl_camera *camera);

/* Finds a camera that shows everything that at least one of the given cameras shows. cameras: [count], one or
 * more, of one type, direction, up vector and field of view. aspect: a picture's width divided by its height.
 * *joined: the first camera if it shows everything. Otherwise it is the nearest camera that does; in parallel
 * projection, the one with the smallest picture. Its target is as deep as the first camera's target.
 * HL_ERROR_ARGUMENT: types, directions, up vectors or fields of view differ, or a camera is at its target. */
HL_API HL_WARN_UNUSED hl_status hl_camera_join(const hl_camera *cameras, size_t count, double aspect,
                                               hl_camera *joined);

/* Finds the direction in which a light travels, a unit vector, for a lamp that stands beside the camera.
 * azimuth, elevation: the lamp's angles from the line of sight. The lamp stands to the right of the camera if
 * azimuth is positive, and above the camera if elevation is positive. At 0, 0 the lamp stands at the camera
 * and shines along the line of sight. If camera is null, direction becomes 0, 0, 0, which hl_scene_create()
 * refuses. If direction is null, the function does nothing. */
HL_API void hl_light_direction(const hl_camera *camera, double azimuth_deg, double elevation_deg,
                               double direction[3]);
/* Finds the direction of a light as hl_light_direction() does, but in the axes of HL_LIGHT_FRAME_CAMERA. */
HL_API void hl_light_direction_beside(double azimuth_deg, double elevation_deg, double direction[3]);

#ifdef __cplusplus
}
#endif
#endif
