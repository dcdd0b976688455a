/* halflight/scene.h - scenes: camera, lights, volumes and render settings.
 *
 * A description is plain data; hl_scene_create() checks it and keeps a deep copy, immutable from
 * then on. Lengths in world units, angles in degrees, colours linear RGB, right-handed.
 */
#ifndef HALFLIGHT_SCENE_H
#define HALFLIGHT_SCENE_H

#include "image.h"
#include "mesh.h"
#include "shape.h"
#include "transfer_function.h"
#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum hl_camera_type { HL_CAMERA_PERSPECTIVE = 0, HL_CAMERA_ORTHOGRAPHIC = 1 } hl_camera_type;

typedef struct hl_camera {
  hl_camera_type type;
  double position[3], target[3], up[3];
  double fovy_deg; /* perspective: vertical field of view */
  double height;   /* orthographic: world height of the picture */
} hl_camera;

typedef enum hl_light_type {
  HL_LIGHT_DIRECTIONAL = 0,
  HL_LIGHT_POINT = 1,
  HL_LIGHT_SPOT = 2,
  HL_LIGHT_RECT = 3,
  HL_LIGHT_DISK = 4,
  HL_LIGHT_POLYGON = 5
} hl_light_type;

typedef enum hl_shadows {
  HL_SHADOWS_DEFAULT = 0, /* of a light: as the render settings say */
  HL_SHADOWS_OFF = 1,
  HL_SHADOWS_HARD = 2,
  HL_SHADOWS_SOFT = 3
} hl_shadows;

typedef enum hl_falloff { HL_FALLOFF_NONE = 0, HL_FALLOFF_INVERSE_SQUARE = 1 } hl_falloff;

/* An image that a light projects, like a slide (section 4 of the paper). It stands on a screen, a
 * parallelogram in space. A ray of the light has, over its whole length, the image's colour where it crosses
 * the screen; rays that miss the screen are dark. Bilinear between the middles of pixels. */
typedef struct hl_light_texture {
  const char *file;    /* where the pixels came from, for hl_scene_to_json; may be null */
  const float *pixels; /* [height][width][3]: linear RGB, top row first; null: the light has no texture */
  int width, height;
  double screen_center[3];
  double screen_right[3]; /* from the centre to the middle of the image's right edge */
  double screen_up[3];    /* from the centre to the middle of its top edge */
} hl_light_texture;

/* An image on the surface of an extended light: each point of the surface sends its colour, times color and
 * intensity. Soft shadows have the image's shape and colours; a light without soft shadows has its mean
 * colour. On a rect, edge1 points to the image's right edge and edge2 to its top. On a disk or polygon the
 * image fills the square or rectangle around it, with its top towards `up`, and is not mirrored as seen from
 * the side that the normal points to. A sphere or a directional light shows every sample the image from the
 * front. Bilinear between the middles of pixels. */
typedef struct hl_light_emission {
  const char *file;    /* where the pixels came from, for hl_scene_to_json; may be null */
  const float *pixels; /* [height][width][3]: linear RGB, top row first; null: the light is even */
  int width, height;
  double up[3]; /* not for rects; if it is parallel to the light's normal, [0, 1, 0] is used instead */
} hl_light_emission;

/* The axes that a light's positions and directions are measured in. */
typedef enum hl_light_frame {
  HL_LIGHT_FRAME_WORLD = 0,
  HL_LIGHT_FRAME_CAMERA = 1 /* x right, y up, z towards the viewer; the origin is the camera's target: the
                               light moves with the camera */
} hl_light_frame;

typedef struct hl_light {
  hl_light_type type;
  hl_light_frame frame;        /* of all vectors below, those of texture and emission included */
  double direction[3];         /* directional, spot: the way the light travels */
  double angular_diameter_deg; /* directional: > 0 is soft */
  double position[3];          /* point, spot, rect, disk (its centre) */
  double radius;               /* point and spot (spheres), disk */
  double normal[3];            /* disk */
  double edge1[3], edge2[3];   /* rect: full edges */
  double opening_angle_deg;    /* spot: full angle of its cone, beyond which it is dark */
  double falloff_angle_deg;    /* spot: width of the smooth edge inside the cone */
  const double (*vertices)[3]; /* polygon; [vertex_count][3] */
  size_t vertex_count;
  double color[3];
  double
      intensity; /* a sample receives color * intensity, however far away the light, unless falloff is set */
  hl_falloff falloff;
  hl_shadows shadows;
  hl_light_texture texture;   /* copied with its pixels by hl_scene_create() */
  hl_light_emission emission; /* the image on the light's own surface; copied with its pixels; a light has
                                 this or a texture, not both */
} hl_light;

typedef enum hl_sky_type {
  HL_SKY_NONE = 0,
  HL_SKY_UNIFORM = 1,  /* one colour */
  HL_SKY_GRADIENT = 2, /* from the horizon to the zenith and to the ground, linear in the sine of the
                          elevation */
  HL_SKY_IMAGE = 3     /* an environment: an equirectangular image */
} hl_sky_type;

/* Light from all directions, attenuated by all that casts shadows. A surface gets
 * diffuse / pi times the integral of radiance x transmittance x cosine, a medium the mean of radiance x
 * transmittance x phase function over all directions: an even sky of radiance 1 that nothing hides lights
 * both by 1. It makes no highlights.
 *
 * The image's top row is the zenith, its bottom row the opposite point. Its middle column lies in the
 * direction up x right, and right of it lies `right`: the world's x axis made perpendicular to up, or its y
 * axis where up is within 8 degrees of x. So with up along z, the middle lies towards +y and is not mirrored
 * as seen from within. Bilinear between the middles of pixels. */
typedef struct hl_sky {
  hl_sky_type type;
  double color[3];                         /* uniform: radiance */
  double zenith[3], horizon[3], ground[3]; /* gradient: radiance */
  const char *file;    /* image: where the pixels came from, for hl_scene_to_json; may be null */
  const float *pixels; /* image: [height][width][3]: linear RGB, copied by hl_scene_create() */
  int width, height;
  double rotation_deg; /* image: turned by so much about up, counterclockwise as seen from above */
  double up[3];        /* direction of the zenith, of any length; world */
  int hemisphere;      /* non-zero: nothing shines below the horizon */
  double strength;     /* a factor on all colours */
  int suns;            /* image: non-zero (the default): up to four compact bright spots of it shine as
                          parallel lights, where the scene has shadows; the image's light stays the same */
} hl_sky;

typedef enum hl_shading {
  HL_SHADING_PHONG = 0,
  HL_SHADING_NONE = 1, /* a medium: lit and shadowed, without a surface */
  HL_SHADING_FLAT = 2  /* the transfer function's colour itself: neither light nor shadow changes it */
} hl_shading;

typedef struct hl_material {
  double ambient, diffuse, specular, shininess; /* ka kd ks n */
  double emission; /* ke: fraction of the colour that shines without any light; default 0 */
} hl_material;

/* A surface on which a volume has one value, as if it were a sheet of paper: seen and shadowed from any angle
 * it takes the same fraction of light. The volume's material lights it, with its gradient as normal. */
typedef struct hl_isosurface {
  double value;
  double color[3]; /* linear RGB */
  double opacity;  /* 0 to 1 */
} hl_isosurface;

/* A part of space that is cut out of a volume: its inside, or with keep all but its inside. Lengths are in
 * the units of the volume's own file, before the transform; those of a scene's cuts in its world. */
typedef enum hl_cut_type {
  HL_CUT_PLANE = 0, /* the half space on the side that the normal points to */
  HL_CUT_BOX = 1,
  HL_CUT_SPHERE = 2
} hl_cut_type;
typedef enum hl_cut_keep { HL_CUT_KEEP_OUTSIDE = 0, HL_CUT_KEEP_INSIDE = 1 } hl_cut_keep;
typedef struct hl_cut {
  hl_cut_type type;
  double point[3], normal[3]; /* plane: a point on it, and a direction of any length */
  double min[3], max[3];      /* box */
  double center[3], radius;   /* sphere */
  hl_cut_keep keep;           /* which side is left: default the outside */
  int world; /* non-zero: lengths are in the scene's world, after the volume's transform; default 0 */
} hl_cut;

/* How surfaces are shaded within a voxel of the face of a cut or of the clip box (at twice the depth they are
 * as anywhere), and at faces that a mask leaves. */
typedef enum hl_cut_shading {
  HL_CUT_SHADING_FACE = 0,     /* by the face's own normal */
  HL_CUT_SHADING_GRADIENT = 1, /* by the data's gradient, as if nothing were cut */
  HL_CUT_SHADING_NONE = 2      /* as a medium, which has no normal */
} hl_cut_shading;

/* A label of a label map: what the voxels with this value are. */
typedef struct hl_label {
  int64_t value;
  const char *name; /* may be null */
  double color[3];  /* linear RGB */
  double opacity;   /* 1: solid; below: a skin that takes this fraction of the light that crosses it */
  int visible;
  double tint; /* in a mask: how much the matter takes of `color`, from 0, its own colour, to 1 */
} hl_label;

/* A label map that masks, colours or reveals a volume: smooth at the labels' borders. Within a label the
 * volume's extinction is multiplied by the label's opacity, or by 0 where it is not visible. What is hidden
 * leaves faces, which cut_shading HL_CUT_SHADING_FACE lights by the normals of the labels' borders. */
typedef struct hl_mask {
  hl_volume *volume; /* the label map, in the world of the volume's file; any grid; retained by the scene;
                        null: there is no mask */
  const char *file;  /* where it came from, for hl_scene_to_json; may be null */
  int component;     /* likewise; HL_COMPONENT_DEFAULT is the default */
  const hl_label *labels; /* [label_count]; rising by value */
  size_t label_count;
  double
      rest; /* what extinction is multiplied by outside the labels: 0, hidden (the default), to 1; the option
               "show" of hl_scene_compose() takes a fraction of opacity, and makes this factor of it */
} hl_mask;

typedef struct hl_scene_volume {
  const char *name;   /* may be null */
  const char *file;   /* where the voxels came from, for hl_scene_to_json; may be null */
  const char *shapes; /* or the text that the voxels were made from (hl_volume_from_shapes); may be null */
  const char *array;  /* options that the file was read with (hl_volume_load_options), for hl_scene_to_json;
                         may be null */
  int component;      /* likewise; HL_COMPONENT_DEFAULT and 0 are the defaults */
  double spacing[3];
  const char *series; /* likewise: hl_volume_load_options.series; may be null */
  hl_volume *volume;  /* retained by the scene */
  double scale;       /* transform: scale, then rotate, then translate */
  double rotate_axis[3];
  double rotate_angle_deg;
  double translate[3];
  hl_transfer_function transfer_function;
  hl_shading shading;
  hl_material material;
  double attenuation_color[3]; /* relative extinction of R, G, B */
  int visible, casts_shadow, receives_shadow;
  int clipped;                     /* non-zero: only the box clip_min..clip_max is there */
  double clip_min[3], clip_max[3]; /* world units of the volume's own file, before the transform */
  double axis_scale[3]; /* times `scale`: along x, y and z of the volume's own file, before the rotation */
  int time, channel, level; /* of the file (hl_volume_load_options), for hl_scene_to_json; default
                               HL_INDEX_DEFAULT */
  double anisotropy; /* g of Henyey and Greenstein's phase function, by which a medium scatters light; above
                        0: mostly onwards, below 0: mostly back; default 0: evenly */
  const hl_isosurface *iso; /* [iso_count]; beside what the transfer function shows */
  size_t iso_count;
  double albedo[3];        /* the fraction of the light met that a medium scatters, times its colour, R, G, B;
                              default 1 */
  int multiple_scattering; /* non-zero: light is scattered again and again; default 0: once */
  /* If there are any, the voxels are labels, and those that are listed and visible show: smooth, in their
   * colours, over the transfer function, which is then made of them. [label_count]; rising by value. */
  const hl_label *labels;
  size_t label_count;
  const hl_cut *cuts; /* [cut_count]; what is left is in all that is kept and in nothing that is cut out */
  size_t cut_count;
  hl_cut_shading cut_shading;
  int cut_casts_shadow; /* non-zero: what `cuts` remove goes on taking light; default 0 */
  hl_mask mask;         /* of a volume that is no label map itself */
} hl_scene_volume;

/* A mesh among the volumes. Its colour is that of its vertices, faces or spheres, where it has some, times
 * `color`. */
typedef struct hl_scene_mesh {
  const char *name; /* may be null */
  const char *file; /* where the mesh came from, for hl_scene_to_json; null: it writes the arrays */
  hl_mesh *mesh;    /* retained by the scene */
  double scale;     /* transform: scale, then rotate, then translate */
  double rotate_axis[3];
  double rotate_angle_deg;
  double translate[3];
  double color[3]; /* linear RGB */
  double opacity;  /* what the surface takes of light through it: 0 to 1; times that of its vertices */
  hl_material material;
  int smooth;    /* non-zero: normals are interpolated between vertices */
  int two_sided; /* non-zero: the side that faces away from the eye is lit like the front */
  int visible, casts_shadow, receives_shadow;
  double attenuation_color[3]; /* the fractions of `opacity` that it takes of red, green and blue light */
  int cut;                     /* non-zero: the scene's cuts cut it */
} hl_scene_mesh;

typedef enum hl_soft_method { HL_SOFT_CASCADE = 0, HL_SOFT_PAPER = 1, HL_SOFT_SUBLIGHTS = 2 } hl_soft_method;
typedef enum hl_kernel {
  HL_KERNEL_BSPLINE = 0,
  HL_KERNEL_GAUSSIAN = 1,
  HL_KERNEL_LINEAR = 2,
  HL_KERNEL_INTERPOLATING =
      3 /* the B-spline over coefficients with which it passes through the voxels' values: sharper */
} hl_kernel;
typedef enum hl_reconstruction {
  HL_RECONSTRUCTION_AUTO = 0, /* gather; the faster method of the two wherever both were measured */
  HL_RECONSTRUCTION_SPLAT = 1,
  HL_RECONSTRUCTION_GATHER = 2
} hl_reconstruction;
typedef enum hl_slicing { HL_SLICING_HALF_VECTOR = 0, HL_SLICING_IMAGE_ALIGNED = 1 } hl_slicing;
/* How transmittance is interpolated between the pixels of a shadow buffer. */
typedef enum hl_shadow_lookup {
  HL_LOOKUP_BILINEAR = 0,
  HL_LOOKUP_NEAREST = 1,
  HL_LOOKUP_CUBIC = 2, /* cubic convolution: sharper; sub-lights are read bilinearly all the same */
  HL_LOOKUP_AUTO = 3 /* cubic, with larger pixels, for cascade shadows of lights without an emission image and
                        for hard shadows with close sheets; else bilinear */
} hl_shadow_lookup;

/* How the samples along a ray make a pixel. */
typedef enum hl_compositing {
  HL_COMPOSITING_LIGHT = 0, /* lit matter, front to back */
  HL_COMPOSITING_MAXIMUM =
      1 /* maximum projection: the colour of the greatest value that the transfer function shows (opacity
           above 0), without light; of several volumes, the greatest of each channel */
} hl_compositing;

typedef struct hl_render_settings {
  hl_shadows shadows; /* off, hard or soft */
  hl_soft_method soft_method;
  int light_samples;    /* sublights: M, for M x M sub-lights */
  double sheet_spacing; /* in voxels: the smallest voxel edge of the scene */
  hl_kernel kernel;
  hl_reconstruction reconstruction;
  hl_slicing slicing;
  hl_shadow_lookup shadow_lookup;
  int shadow_resolution; /* pixels along the longer side; 0: auto */
  int threads;           /* 0: one per processor */
  hl_compositing compositing;
  int slabs_at_once; /* slabs between two waits of the threads for each other, which change no picture; 0:
                        auto */
} hl_render_settings;

typedef struct hl_scene_description {
  size_t struct_size;         /* set by hl_scene_description_defaults() */
  int width, height;          /* pixels */
  double background[3];       /* linear RGB */
  int background_transparent; /* PNG keeps alpha */
  hl_camera camera;
  double ambient[3]; /* Ia */
  const hl_light *lights;
  size_t light_count;
  const hl_scene_volume *volumes;
  size_t volume_count;
  hl_render_settings render;
  const char *description; /* one sentence on the scene; may be null */
  double exposure;         /* stops: a PNG shows the volumes' light times 2^exposure; 0 by default */
  const hl_scene_mesh *meshes;
  size_t mesh_count;
  const hl_cut
      *cuts; /* [cut_count]; cut out of all volumes, with each one's own cut_shading and
                cut_casts_shadow; in the world, whatever `world` says; and out of the meshes with `cut` */
  size_t cut_count;
  hl_tone tone; /* how a PNG shows light that is brighter than white; default HL_TONE_CLIP */
  hl_sky sky;
  int background_sky; /* non-zero: pictures show the sky behind all else, in place of a background; they have
                         alpha 1. default 0 */
} hl_scene_description;

typedef struct hl_scene hl_scene; /* immutable and counted */

/* Fill a struct with its defaults. */
HL_API void hl_scene_description_defaults(hl_scene_description *description);
HL_API void hl_light_defaults(hl_light *light);
HL_API void hl_scene_volume_defaults(hl_scene_volume *volume);
HL_API void hl_scene_mesh_defaults(hl_scene_mesh *mesh);
HL_API void hl_isosurface_defaults(hl_isosurface *surface);
HL_API void hl_cut_defaults(hl_cut *cut);

/* Takes a point from the world of the volume's file to the scene's world, by the volume's scale, rotation and
 * translation. Where one of them is null, nothing is done. */
HL_API void hl_scene_volume_place_point(const hl_scene_volume *volume, double point[3]);

/* Checks and copies the description, and retains the volumes. Errors name the field as a JSON pointer
 * ("/lights/0/radius"). */
HL_API HL_WARN_UNUSED hl_status hl_scene_create(hl_context *context, const hl_scene_description *description,
                                                hl_scene **scene, hl_error *error);

/* Reads a scene file and the volumes it names; relative paths are relative to the file. */
HL_API HL_WARN_UNUSED hl_status hl_scene_load(hl_context *context, const char *path, hl_scene **scene,
                                              hl_error *error);

/* text: UTF-8, length bytes. base_folder: where relative paths start (null: the current folder).
 * name: what errors call the text. */
HL_API HL_WARN_UNUSED hl_status hl_scene_from_json(hl_context *context, const char *text, size_t length,
                                                   const char *base_folder, const char *name,
                                                   hl_scene **scene, hl_error *error);

/* hl_scene_from_json() for editors and viewers, whose scene changes many times a second: no file is opened.
 * Volumes and lights' images are those of `like`, found by their file and how it was read, or by their
 * shapes; a scene that names another one is refused with HL_ERROR_INPUT. like may be null: nothing is
 * refused. */
HL_API HL_WARN_UNUSED hl_status hl_scene_from_json_like(hl_context *context, const char *text, size_t length,
                                                        const char *base_folder, const char *name,
                                                        const hl_scene *like, hl_scene **scene,
                                                        hl_error *error);

/* The scene as JSON text, null-terminated; free with hl_text_release(). */
HL_API HL_WARN_UNUSED hl_status hl_scene_to_json(hl_context *context, const hl_scene *scene, char **text,
                                                 hl_error *error);
/* The same for a text that will lie in a folder, or in a picture there: files in the folder or below are
 * named relative to it, others as hl_scene_to_json() does. folder: "" is the current one; null: all as there.
 */
HL_API HL_WARN_UNUSED hl_status hl_scene_to_json_beside(hl_context *context, const hl_scene *scene,
                                                        const char *folder, char **text, hl_error *error);
HL_API void hl_text_release(hl_context *context, char *text);

/* A scene that shows one volume well with no further choice: three-quarter view, automatic transfer
 * function, key light from the upper left with soft shadows, and a sky; where the context's memory limit is
 * below 512 MiB and twice the volume, constant light in place of the sky. What holds a scanned object - a
 * head rest, rails, a towel - is left out: the volume's cuts are up to 8 planes beside the object, which
 * remove nothing of it. A label map (hl_volume_is_label_map()) has its labels, with the names and colours of
 * its file. file may be null (see hl_scene_volume). */
HL_API HL_WARN_UNUSED hl_status hl_scene_for_volume(hl_context *context, hl_volume *volume, const char *file,
                                                    hl_scene **scene, hl_error *error);

/* The same with one of the looks of hl_look_name(), whatever the volume holds. file may be null. */
HL_API HL_WARN_UNUSED hl_status hl_scene_for_volume_look(hl_context *context, hl_volume *volume,
                                                         const char *file, const char *look, hl_scene **scene,
                                                         hl_error *error);

/* One scene of the scenes of several bare volumes, as hl_scene_for_volume() makes them: all volumes in one
 * world, each with its own look. Light, background and render settings are those of the first scene, sheets
 * are as close as the closest, and the camera frames all volumes. A volume without a name is named after its
 * file, without folder and extensions, and "-2" and so on is appended to names that are taken. scenes:
 * [count], each with a volume; they may be released afterwards. */
HL_API HL_WARN_UNUSED hl_status hl_scene_join(hl_context *context, hl_scene *const *scenes, size_t count,
                                              hl_scene **scene, hl_error *error);

/* A scene of several channels of a file, as of a microscope: each is a volume with the look that
 * hl_scene_for_volume_look() gives it, in the colour of hl_scene_channel_color(), named as the file names the
 * channel, or else "channel0" and so on. path, options (null: the defaults): as for hl_volume_load_with();
 * options->channel is not used, and options->bytes is read once for each channel. channels: [count], their
 * numbers from 0; count 0: all, at most HL_CHANNELS_MOST. */
enum { HL_CHANNELS_MOST = 16 };
HL_API HL_WARN_UNUSED hl_status hl_scene_for_channels(hl_context *context, const char *path,
                                                      const hl_volume_load_options *options,
                                                      const int *channels, size_t count, const char *look,
                                                      hl_scene **scene, hl_error *error);

/* The colour, sRGB from 0 to 1, that tells volume number `index` from the others of its scene: the colour
 * that its file has for its channel (OME, ImageJ, omero), if the files have one for each volume and they
 * differ; else green and magenta, and then cyan, yellow, orange, blue. */
HL_API HL_WARN_UNUSED hl_status hl_scene_channel_color(const hl_scene_description *description, size_t index,
                                                       double srgb[3]);

/* Puts constant light in place of the sky of a description that one of these functions made: about as bright
 * over the whole picture, without the shadow of the sky, and without the time that the sky takes. */
HL_API void hl_scene_level_sky(hl_scene_description *description);

/* What to multiply the strengths of all lights, `ambient` and the sky of such a scene by after a change of
 * what is seen of its volume, as by cuts or isosurfaces: they are made for the whole volume, and a cut face
 * that looks at the light, or a white surface, would be clipped. look: the one that the scene was made with.
 * *factor is 1 for looks that keep their light, and for orthographic cameras. */
HL_API HL_WARN_UNUSED hl_status hl_scene_light_factor(const hl_scene_description *description,
                                                      const char *look, double *factor, hl_error *error);

/* The names of light rigs: "studio", "raking", "rim" and "overcast". Null past the last. */
HL_API const char *hl_light_rig_name(size_t index);

/* Lights of a light rig at most. */
#define HL_LIGHT_RIG_MOST 4

/* Gives a description the lights of a named rig, which go with the camera, and a sky of the rig's strength:
 * the one that it has, or one brighter above than below. Together they are about as strong as the light that
 * the description had; hl_scene_light_factor() says what else brings a bare volume's picture to its exposure.
 * lights: the caller's, [HL_LIGHT_RIG_MOST], to which description->lights points afterwards. Errors:
 * HL_ERROR_ARGUMENT for an unknown name. */
HL_API HL_WARN_UNUSED hl_status hl_scene_light_rig(const char *rig, hl_scene_description *description,
                                                   hl_light lights[HL_LIGHT_RIG_MOST], hl_error *error);

/* The names of looks: "auto", which the data choose, "surface", "translucent", "xray", "smoke" and "vessels".
 * Null past the last. */
HL_API const char *hl_look_name(size_t index);

/* The transfer function and the shading of a look, for one volume of a scene. Free *function with
 * hl_transfer_function_release(). */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_look(hl_context *context, const char *look,
                                                          const hl_volume *volume,
                                                          hl_transfer_function *function, hl_shading *shading,
                                                          hl_error *error);

/* The kind of data that hl_scene_for_volume() takes a volume for, and chooses its look by: "scanned body",
 * "scanned brain", "scanned matter", "vessels" (bright tubes within other matter, as angiography shows them),
 * "labels", "field", "flow", "signed field", "smoke or cloud", "particles" or "one value". file: as for that
 * function. *kind is a constant text. */
HL_API HL_WARN_UNUSED hl_status hl_volume_guess(const hl_volume *volume, const char *file, const char **kind,
                                                hl_error *error);

/* The look by name (hl_look_name()) that shows a volume best where hl_scene_for_volume() took it for what it
 * is not, or where its own look shows too little. file: as for that function. *name is a constant text. */
HL_API HL_WARN_UNUSED hl_status hl_volume_next_look(const hl_volume *volume, const char *file,
                                                    const char **name, hl_error *error);

/* The scene's own description, valid as long as the scene. To change a scene, change a copy of the
 * description and create another scene. Null for null. */
HL_API const hl_scene_description *hl_scene_describe(const hl_scene *scene);

HL_API void hl_scene_retain(hl_scene *scene);
HL_API void hl_scene_release(hl_scene *scene); /* null is allowed */

/* ---- label maps ---- */

/* The labels that a volume's voxels have, 0 left out, rising; all visible and solid. Names and colours are
 * those of the table (a path: FreeSurfer's or Slicer's colour table, ITK-SNAP's label descriptions, CSV;
 * null: none), else of the file (.seg.nrrd), else colours that differ. *labels is owned by the caller
 * (hl_labels_release). HL_ERROR_INPUT where a value is no whole number; HL_ERROR_UNSUPPORTED for a map in a
 * scratch file or in bricks. Of a map over ranks (ranks.h) each rank gets a copy, which the map keeps: the
 * first call with it is collective. */
HL_API HL_WARN_UNUSED hl_status hl_labels_of_volume(hl_context *context, const hl_volume *map,
                                                    const char *table, hl_label **labels, size_t *count,
                                                    hl_error *error);
HL_API void hl_labels_release(hl_context *context, hl_label *labels); /* null is allowed */

/* Sets *labels to 1 where the volume's values look like names of regions, else to 0: its file names segments,
 * or it has few whole numbers, in blocks. A bare volume of which this is true is drawn by its labels. */
HL_API HL_WARN_UNUSED hl_status hl_volume_is_label_map(hl_context *context, const hl_volume *volume,
                                                       int *labels, hl_error *error);

/* ---- where the camera stands ---- */

/* A direction of view. */
typedef struct hl_view {
  double up[3]; /* unit: up in the picture, at elevation 0 and roll 0 */
  double
      front[3]; /* unit, at a right angle to up: from the volumes to the eye at azimuth 0 and elevation 0 */
  double azimuth_deg;   /* positive: the eye moves to its right, about up */
  double elevation_deg; /* -90 to 90; positive: the eye rises */
  double roll_deg;      /* positive: the picture turns clockwise */
} hl_view;

/* Sides to look from. Where the file tells the anatomy (hl_volume_info's space), left is the patient's left
 * side; else it is the left as seen from the front. */
typedef enum hl_side {
  HL_SIDE_AUTOMATIC = 0, /* the three-quarter view that shows most */
  HL_SIDE_FRONT = 1,
  HL_SIDE_BACK = 2,
  HL_SIDE_LEFT = 3,
  HL_SIDE_RIGHT = 4,
  HL_SIDE_TOP = 5,
  HL_SIDE_BOTTOM = 6,
  HL_SIDE_ISO = 7 /* azimuth 45 and the elevation at which three edges of a cube look alike, 35.26 */
} hl_side;

/* The view from a side. up: of any length; null: by the file's anatomy, or else a guess from the voxels.
 * Without anatomy, the view from the front has +x to its right (+y where up is along x); so where z is up,
 * the front is at -y. A scene without a camera gets hl_camera_frame_view() of the automatic side. */
HL_API HL_WARN_UNUSED hl_status hl_view_choose(const hl_scene_description *description, hl_side side,
                                               const double up[3], hl_view *view, hl_error *error);

/* The view of the description's camera, with roll 0. view->up is the camera's up vector; where that vector
 * was made perpendicular to the line of sight from an axis of the world, it is this axis. Fails where
 * position and target are the same. */
HL_API HL_WARN_UNUSED hl_status hl_view_of_camera(const hl_scene_description *description, hl_view *view);

/* Places the camera so that the visible voxels of all volumes fill the picture and are in its middle, with
 * room for turning: at zoom 1 nothing leaves the picture while the camera turns about view->up
 * (hl_camera_turn). Turns about other axes get room as well, unless it would shrink this view to less than
 * four fifths of the picture. camera->type and fovy_deg are kept. Fails where zoom is not from 1e-6 to 1e6,
 * the view or the field of view is impossible, or there is no volume (HL_ERROR_ARGUMENT), and for lack of
 * memory. */
HL_API HL_WARN_UNUSED hl_status hl_camera_frame_view(const hl_scene_description *description,
                                                     const hl_view *view, double zoom, hl_camera *camera,
                                                     hl_error *error);

/* The usual size of a floor. */
#define HL_FLOOR_SIZE 3.0

/* A mesh's defaults, but those of a floor: matt, grey and whole: the scene's cuts do not cut it. */
HL_API void hl_scene_floor_defaults(hl_scene_mesh *floor);

/* Makes the triangles of a floor: a square below all that is seen, which lies at a right angle to `up` and
 * touches it; null: what is up for the camera. Its sides are `size` times as long as what stands on it is
 * wide, from 1 to 1000. *mesh is owned by the caller (release it); add it to the description's meshes. */
HL_API HL_WARN_UNUSED hl_status hl_scene_make_floor(hl_context *context,
                                                    const hl_scene_description *description,
                                                    const double up[3], double size, hl_mesh **mesh,
                                                    hl_error *error);

/* Turns the camera about its target to a view; the distance to the target is kept. */
HL_API HL_WARN_UNUSED hl_status hl_camera_turn(const hl_view *view, hl_camera *camera);

/* Places the camera so that the visible voxels of all volumes fill the picture, without room for turning.
 * Azimuth 0 looks along the world's +y, a positive one moves the eye to its right; elevation 90 looks
 * straight down z. zoom 1 frames everything. camera->type and fovy_deg are kept. */
HL_API HL_WARN_UNUSED hl_status hl_camera_frame(const hl_scene_description *description, double azimuth_deg,
                                                double elevation_deg, double zoom, hl_camera *camera);

/* The same for a camera that keeps its own direction and up: it is only moved (and its height set). */
HL_API HL_WARN_UNUSED hl_status hl_camera_fit(const hl_scene_description *description, double zoom,
                                              hl_camera *camera);

/* The direction (unit, the way light travels) of a light that stands, seen by the camera, at azimuth
 * (positive: right) and elevation (positive: up) from the line of sight: 0,0 is a headlight. camera null:
 * direction becomes 0, 0, 0, which hl_scene_create() refuses; direction null: nothing is done. */
HL_API void hl_light_direction(const hl_camera *camera, double azimuth_deg, double elevation_deg,
                               double direction[3]);
/* The same for a light in HL_LIGHT_FRAME_CAMERA. */
HL_API void hl_light_direction_beside(double azimuth_deg, double elevation_deg, double direction[3]);

#ifdef __cplusplus
}
#endif
#endif
