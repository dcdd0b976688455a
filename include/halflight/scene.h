/* halflight/scene.h - scenes: camera, volumes, meshes and render settings; light.h has the lights.
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

typedef struct hl_camera {
  hl_camera_type type;
  double position[3], target[3], up[3];
  double fovy_deg; /* perspective: vertical field of view */
  double height;   /* orthographic: world height of the picture */
} hl_camera;

typedef enum hl_shading {
  HL_SHADING_PHONG = 0,
  HL_SHADING_NONE = 1, /* a medium: lit and shadowed, without a surface */
  HL_SHADING_FLAT = 2  /* the transfer function's colour itself: neither light nor shadow changes it */
} hl_shading;

typedef struct hl_material {
  double ambient, diffuse, specular, shininess; /* ka kd ks n */
  double emission; /* ke: fraction of the colour that shines without any light; default 0 */
} hl_material;

/* A surface on which a volume has one value. It takes the same fraction of light at any angle, as a sheet
 * of paper does. The surface has the volume's material, and the volume's gradient as its normal. */
typedef struct hl_isosurface {
  double value;
  double color[3]; /* linear RGB */
  double opacity;  /* 0 to 1 */
} hl_isosurface;

/* A shape that cuts a volume. What lies inside the shape is removed; with HL_CUT_KEEP_INSIDE all the rest is.
 * A volume's cut has lengths in the units of the volume's file, before the transform; a scene's cut has
 * lengths in the scene's world. */
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
  hl_cut_keep keep;           /* the side that is left; default: the outside */
  int world; /* non-zero: the cut's lengths are in the scene's world, after the volume's transform; default
              * 0 */
} hl_cut;

/* How matter is shaded at the faces that a cut, the clip box or a mask leaves. Behind the face of a cut or of
 * the clip box this holds to a depth of a voxel, and fades until a depth of two voxels. */
typedef enum hl_cut_shading {
  HL_CUT_SHADING_FACE = 0,     /* by the face's own normal */
  HL_CUT_SHADING_GRADIENT = 1, /* by the data's gradient, as if nothing were cut */
  HL_CUT_SHADING_NONE = 2      /* as a medium, which has no normal */
} hl_cut_shading;

/* A label of a label map. It belongs to the voxels with its value. */
typedef struct hl_label {
  int64_t value;
  const char *name; /* may be null */
  double color[3];  /* linear RGB */
  double opacity;   /* 1: the label is solid; below 1: it is a skin that takes this fraction of the light
                     * that crosses it */
  int visible;
  double tint; /* in a mask, how much of the label's colour matter takes: 0: the matter has its own colour,
                * 1: `color`, between: a mixture */
} hl_label;

/* A label map that masks, colours or reveals a volume: smooth at the labels' borders. Within a label the
 * volume's extinction is multiplied by the label's opacity, or by 0 where it is not visible. Where
 * matter is hidden, faces are left. HL_CUT_SHADING_FACE lights them by the normals of the labels' borders. */
typedef struct hl_mask {
  hl_volume *volume;      /* the label map; it has any grid in the world of the volume's file; retained by the
                           * scene; null: there is no mask */
  const char *file;       /* the file that the label map came from, for hl_scene_to_json; may be null */
  int component;          /* the component of the label map's file, for hl_scene_to_json; default
                           * HL_COMPONENT_DEFAULT */
  const hl_label *labels; /* [label_count]; rising by value */
  size_t label_count;
  double rest; /* the factor of extinction outside the labels: 0 (the default) hides the matter there, 1
                * leaves it as it is; the option "show" of hl_scene_compose() takes a fraction of opacity,
                * and makes this factor of it */
} hl_mask;

typedef struct hl_scene_volume {
  const char *name;   /* may be null */
  const char *file;   /* where the voxels came from, for hl_scene_to_json; may be null */
  const char *shapes; /* the text that the voxels were made from (hl_volume_from_shapes()); may be null */
  const char *array;  /* the array of the file that was read, for hl_scene_to_json; may be null. This
                       * member and the next three are options of hl_volume_load_options */
  int component;      /* default HL_COMPONENT_DEFAULT */
  double spacing[3];  /* default 0 */
  const char *series; /* may be null */
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
  int clipped;                     /* non-zero: everything outside the box clip_min..clip_max is removed */
  double clip_min[3], clip_max[3]; /* world units of the volume's own file, before the transform */
  double axis_scale[3];     /* factors of the size along x, y and z of the volume's own file, beside scale;
                             * applied before the rotation */
  int time, channel, level; /* the time step, channel and resolution that were read
                             * (hl_volume_load_options), for hl_scene_to_json; default HL_INDEX_DEFAULT */
  double anisotropy; /* g of Henyey and Greenstein's phase function, by which a medium scatters light: above 0
                        mostly onwards, below 0 mostly back, 0 (the default) evenly */
  const hl_isosurface *iso; /* [iso_count]; surfaces beside the matter that the transfer function shows */
  size_t iso_count;
  double albedo[3]; /* the fraction of the light that the medium scatters, of the light that it takes: R,
                     * G, B; multiplies the medium's colour; default 1 */
  int multiple_scattering; /* non-zero: the medium scatters light that it has scattered before; default 0:
                            * it scatters light once */
  /* [label_count]; rising by value. Where there are any, the voxels are labels. Listed labels that are
   * visible are shown, with smooth borders and in their colours. The transfer function is then made of the
   * labels. */
  const hl_label *labels;
  size_t label_count;
  const hl_cut *cuts; /* [cut_count]; matter is left at a point where each of the cuts leaves it */
  size_t cut_count;
  hl_cut_shading cut_shading;
  int cut_casts_shadow; /* non-zero: matter that `cuts` remove casts its shadow all the same; default 0 */
  hl_mask mask;         /* masks the volume; only a volume that is no label map has one */
} hl_scene_volume;

/* A mesh among the volumes. The colours of its vertices, faces or spheres, if it has some, are multiplied by
 * `color`. */
typedef struct hl_scene_mesh {
  const char *name; /* may be null */
  const char *file; /* the file that the mesh came from, for hl_scene_to_json; null: hl_scene_to_json
                     * writes the arrays */
  hl_mesh *mesh;    /* retained by the scene */
  double scale;     /* transform: scale, then rotate, then translate */
  double rotate_axis[3];
  double rotate_angle_deg;
  double translate[3];
  double color[3]; /* linear RGB */
  double opacity;  /* the fraction of light that the surface takes, 0 to 1; multiplied by the opacity of the
                    * mesh's vertices */
  hl_material material;
  int smooth;    /* non-zero: normals are interpolated between vertices */
  int two_sided; /* non-zero: the side that faces away from the eye is lit like the front */
  int visible, casts_shadow, receives_shadow;
  double attenuation_color[3]; /* the parts of red, green and blue light that the surface takes, as factors
                                * of `opacity` */
  int cut;                     /* non-zero: the scene's cuts cut it */
} hl_scene_mesh;

typedef enum hl_soft_method { HL_SOFT_CASCADE = 0, HL_SOFT_PAPER = 1, HL_SOFT_SUBLIGHTS = 2 } hl_soft_method;
typedef enum hl_kernel {
  HL_KERNEL_BSPLINE = 0,
  HL_KERNEL_GAUSSIAN = 1,
  HL_KERNEL_LINEAR = 2,
  HL_KERNEL_INTERPOLATING = 3 /* a cubic B-spline with coefficients that make it pass through the voxels'
                               * values; it is sharper than the others */
} hl_kernel;
typedef enum hl_reconstruction {
  HL_RECONSTRUCTION_AUTO = 0, /* gather: it was the faster method wherever both were measured */
  HL_RECONSTRUCTION_SPLAT = 1,
  HL_RECONSTRUCTION_GATHER = 2
} hl_reconstruction;
typedef enum hl_slicing { HL_SLICING_HALF_VECTOR = 0, HL_SLICING_IMAGE_ALIGNED = 1 } hl_slicing;
/* How transmittance is interpolated between the pixels of a shadow buffer. */
typedef enum hl_shadow_lookup {
  HL_LOOKUP_BILINEAR = 0,
  HL_LOOKUP_NEAREST = 1,
  HL_LOOKUP_CUBIC = 2, /* cubic convolution, which is sharper; sub-lights are read bilinearly even so */
  HL_LOOKUP_AUTO = 3   /* cubic, with larger pixels, for cascade shadows of lights without an emission image,
                        * and for hard shadows where sheets are close; else bilinear */
} hl_shadow_lookup;

/* How the samples along a ray make a pixel. */
typedef enum hl_compositing {
  HL_COMPOSITING_LIGHT = 0,  /* lit matter, front to back */
  HL_COMPOSITING_MAXIMUM = 1 /* maximum projection: a pixel has the colour of the greatest value on its ray
                              * that has an opacity above 0, without light. Where several volumes overlap,
                              * each channel has the greatest number of the volumes' colours */
} hl_compositing;

typedef struct hl_render_settings {
  hl_shadows shadows; /* off, hard or soft */
  hl_soft_method soft_method;
  int light_samples;    /* sublights: M, for M x M sub-lights */
  double sheet_spacing; /* in units of the scene's smallest voxel edge */
  hl_kernel kernel;
  hl_reconstruction reconstruction;
  hl_slicing slicing;
  hl_shadow_lookup shadow_lookup;
  int shadow_resolution; /* pixels along the longer side; 0: auto */
  int threads;           /* 0: one per processor */
  hl_compositing compositing;
  int slabs_at_once; /* number of slabs after which the threads wait for each other; it changes no picture;
                      * 0: chosen by the renderer */
} hl_render_settings;

typedef struct hl_scene_description {
  size_t struct_size;         /* set by hl_scene_description_defaults() */
  int width, height;          /* pixels */
  double background[3];       /* linear RGB */
  int background_transparent; /* PNG keeps alpha */
  hl_camera camera;
  double ambient[3]; /* light that reaches everything: Ia of Phong's model */
  const hl_light *lights;
  size_t light_count;
  const hl_scene_volume *volumes;
  size_t volume_count;
  hl_render_settings render;
  const char *description; /* one sentence on the scene; may be null */
  double exposure;         /* stops: picture files such as PNG show the volumes' light times 2^exposure; 0
                            * by default */
  const hl_scene_mesh *meshes;
  size_t mesh_count;
  const hl_cut *cuts; /* [cut_count]; they cut all volumes, and the meshes with `cut`. Faces and shadows
                       * follow each volume's own cut_shading and cut_casts_shadow. Lengths are in the world,
                       * whatever `world` says */
  size_t cut_count;
  hl_tone tone; /* how picture files such as PNG show light that is brighter than white; default
                 * HL_TONE_CLIP */
  hl_sky sky;
  int background_sky; /* non-zero: pictures show the sky in place of a background, and have alpha 1
                       * everywhere; default 0 */
} hl_scene_description;

typedef struct hl_scene hl_scene; /* a scene; it never changes, and its references are counted */

/* Fill a struct with its defaults. */
HL_API void hl_scene_description_defaults(hl_scene_description *description);
HL_API void hl_light_defaults(hl_light *light);
HL_API void hl_scene_volume_defaults(hl_scene_volume *volume);
HL_API void hl_scene_mesh_defaults(hl_scene_mesh *mesh);
HL_API void hl_isosurface_defaults(hl_isosurface *surface);
HL_API void hl_cut_defaults(hl_cut *cut);

/* Moves a point from the world of the volume's file to the scene's world, by the volume's scale, rotation and
 * translation. Does nothing where an argument is null. */
HL_API void hl_scene_volume_place_point(const hl_scene_volume *volume, double point[3]);

/* Checks and copies the description, and retains the volumes. Errors name the field as a JSON pointer
 * ("/lights/0/radius"). The smooth fields of labels and masks are made for the first frame. Only that frame
 * can tell that none of the visible labels has voxels, or that too many labels show. */
HL_API HL_WARN_UNUSED hl_status hl_scene_create(hl_context *context, const hl_scene_description *description,
                                                hl_scene **scene, hl_error *error);

/* Reads a scene file and the volumes it names; relative paths are relative to the file. */
HL_API HL_WARN_UNUSED hl_status hl_scene_load(hl_context *context, const char *path, hl_scene **scene,
                                              hl_error *error);

/* Reads a scene from JSON text. text: UTF-8, length bytes. base_folder: the folder that relative paths begin
 * in (null: the current folder). name: the text's name in errors. */
HL_API HL_WARN_UNUSED hl_status hl_scene_from_json(hl_context *context, const char *text, size_t length,
                                                   const char *base_folder, const char *name,
                                                   hl_scene **scene, hl_error *error);

/* hl_scene_from_json() for editors and viewers, whose scene changes many times a second. No file is opened:
 * the scene `like` gives the volumes and the lights' images. They are found there by their file and its
 * reading options, or by their shapes. A scene that names a volume or an image which `like` lacks is
 * refused with HL_ERROR_INPUT. Where like is null, files are opened as usual. */
HL_API HL_WARN_UNUSED hl_status hl_scene_from_json_like(hl_context *context, const char *text, size_t length,
                                                        const char *base_folder, const char *name,
                                                        const hl_scene *like, hl_scene **scene,
                                                        hl_error *error);

/* The scene as JSON text, null-terminated; free with hl_text_release(). */
HL_API HL_WARN_UNUSED hl_status hl_scene_to_json(hl_context *context, const hl_scene *scene, char **text,
                                                 hl_error *error);
/* The scene as JSON text that will be stored in a folder, or in a picture there. Files in the folder or
 * below it are named relative to it; all others as hl_scene_to_json() names them. folder: "" is the current
 * folder; null: all files are named as by hl_scene_to_json(). */
HL_API HL_WARN_UNUSED hl_status hl_scene_to_json_beside(hl_context *context, const hl_scene *scene,
                                                        const char *folder, char **text, hl_error *error);
HL_API void hl_text_release(hl_context *context, char *text);

/* A scene that shows one volume well with no further choice: three-quarter view, automatic transfer
 * function, key light from the upper left with soft shadows, and a sky. Constant light takes the sky's
 * place where the context's memory limit is below 512 MiB and below twice the volume. Things that hold a
 * scanned object, such as a head rest, rails or a towel, are removed by up to 8 planes among the volume's
 * cuts. These planes lie beside the object and remove nothing of it. A label map (hl_volume_is_label_map())
 * has its labels, with the names and colours of its file. file may be null (see hl_scene_volume). */
HL_API HL_WARN_UNUSED hl_status hl_scene_for_volume(hl_context *context, hl_volume *volume, const char *file,
                                                    hl_scene **scene, hl_error *error);

/* A scene as hl_scene_for_volume() makes it, but with one of the looks of hl_look_name(), whatever the
 * volume holds. file may be null. */
HL_API HL_WARN_UNUSED hl_status hl_scene_for_volume_look(hl_context *context, hl_volume *volume,
                                                         const char *file, const char *look, hl_scene **scene,
                                                         hl_error *error);

/* Makes one scene of several scenes of one volume each, which hl_scene_for_volume() has made. All volumes
 * stand in one world, each with its own look. Light, background and render settings are the first scene's.
 * The sheets are as close as the closest of all scenes, and the camera frames all volumes. A volume without
 * a name is named after its file, without folder and extensions, and "-2" and so on is appended to names
 * that are taken. scenes: [count], each scene has one volume; the caller may release the scenes afterwards.
 */
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

/* Puts constant light in place of the sky, in a description that hl_scene_for_volume() or a similar
 * function made. The picture stays about as bright as a whole, but has no shadows of the sky, and takes
 * less time. */
HL_API void hl_scene_level_sky(hl_scene_description *description);

/* Finds a factor for the strengths of all lights, of `ambient` and of the sky, in a scene of
 * hl_scene_for_volume() after cuts or isosurfaces have changed what is seen of its volume. The strengths
 * were chosen for the whole volume. A cut face that looks at the light, or a white surface, would be too
 * bright with them and would be clipped. look: the look that the scene was made with. *factor is 1 for
 * looks that keep their light, and for orthographic cameras. */
HL_API HL_WARN_UNUSED hl_status hl_scene_light_factor(const hl_scene_description *description,
                                                      const char *look, double *factor, hl_error *error);

/* The names of light rigs: "studio", "raking", "rim" and "overcast". Null past the last. */
HL_API const char *hl_light_rig_name(size_t index);

/* The greatest number of lights that a light rig has. */
#define HL_LIGHT_RIG_MOST 4

/* Gives a description the lights of a named rig, which move with the camera, and a sky of the rig's strength.
 * A description without a sky gets one that is brighter above than below. The lights and the sky together are
 * about as strong as the light that the description had. The picture of a bare volume needs another factor,
 * which hl_scene_light_factor() gives.
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

/* The kind of data that hl_scene_for_volume() believes a volume to be. It chooses the look by this kind:
 * "scanned body", "scanned brain", "scanned matter", "vessels" (bright tubes within other matter, as
 * angiography shows them), "labels", "field", "flow", "signed field", "smoke or cloud", "particles" or "one
 * value". file: as for that function. *kind is a constant text. */
HL_API HL_WARN_UNUSED hl_status hl_volume_guess(const hl_volume *volume, const char *file, const char **kind,
                                                hl_error *error);

/* The name of the look (hl_look_name()) to try next, where hl_scene_for_volume() was wrong about the kind
 * of the volume, or where its look shows too little. file: as for that function. *name is a constant text. */
HL_API HL_WARN_UNUSED hl_status hl_volume_next_look(const hl_volume *volume, const char *file,
                                                    const char **name, hl_error *error);

/* The scene's own description, valid as long as the scene. To change a scene, change a copy of the
 * description and create another scene. Null for null. */
HL_API const hl_scene_description *hl_scene_describe(const hl_scene *scene);

HL_API void hl_scene_retain(hl_scene *scene);
HL_API void hl_scene_release(hl_scene *scene); /* null is allowed */

/* ---- label maps ---- */

/* The labels that a volume's voxels have, 0 left out, rising; all visible and solid. Names and colours come
 * from the table, else from the volume's file (.seg.nrrd); else colours are chosen that differ. table: the
 * path of a colour table of FreeSurfer or Slicer, of ITK-SNAP's label descriptions or of a CSV file; null:
 * none. *labels is owned by the caller (hl_labels_release). HL_ERROR_INPUT where a value is no whole
 * number; HL_ERROR_UNSUPPORTED for a map in a scratch file or in bricks. Where a map lies over ranks
 * (ranks.h), the first call is collective: each rank gets a copy of the whole map, which the map keeps. */
HL_API HL_WARN_UNUSED hl_status hl_labels_of_volume(hl_context *context, const hl_volume *map,
                                                    const char *table, hl_label **labels, size_t *count,
                                                    hl_error *error);
HL_API void hl_labels_release(hl_context *context, hl_label *labels); /* null is allowed */

/* Sets *labels to 1 where the volume's values are probably labels of regions, else to 0. They probably are
 * labels where the file names segments, or where the values are few whole numbers in blocks. Such a volume
 * is drawn by its labels where nothing else is asked for. */
HL_API HL_WARN_UNUSED hl_status hl_volume_is_label_map(hl_context *context, const hl_volume *volume,
                                                       int *labels, hl_error *error);

/* ---- where the camera stands ---- */

/* A direction of view. */
typedef struct hl_view {
  double up[3];       /* unit vector; the direction that is up in the picture at elevation 0 and roll 0 */
  double front[3];    /* unit vector, perpendicular to up; points from the volumes to the eye at azimuth 0 and
                       * elevation 0 */
  double azimuth_deg; /* positive: the eye moves to its right, about up */
  double elevation_deg; /* -90 to 90; positive: the eye rises */
  double roll_deg;      /* positive: the picture turns clockwise */
} hl_view;

/* Sides to look from. Where the file says how a patient lies (hl_volume_info's space), left is the patient's
 * left side; else left is what lies left as seen from the front. */
typedef enum hl_side {
  HL_SIDE_AUTOMATIC = 0, /* the three-quarter view that shows the most */
  HL_SIDE_FRONT = 1,
  HL_SIDE_BACK = 2,
  HL_SIDE_LEFT = 3,
  HL_SIDE_RIGHT = 4,
  HL_SIDE_TOP = 5,
  HL_SIDE_BOTTOM = 6,
  HL_SIDE_ISO = 7 /* azimuth 45, and elevation 35.26, at which the three edges of a cube at a corner look
                   * alike */
} hl_side;

/* Finds the view from a side. up: the direction that is up, of any length; null: it follows from how a
 * patient lies, if the file says this, or else is guessed from the voxels. Where the file does not say it,
 * the view from the front has +x to its right (+y where up is along x); so where z is up, the front is at -y.
 * A scene without a camera gets hl_camera_frame_view() of the automatic side. */
HL_API HL_WARN_UNUSED hl_status hl_view_choose(const hl_scene_description *description, hl_side side,
                                               const double up[3], hl_view *view, hl_error *error);

/* The view of the description's camera, with roll 0. view->up is the camera's up vector; where that vector
 * is an axis of the world made perpendicular to the line of sight, view->up is this axis. Fails where
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

/* The default size of a floor (hl_scene_make_floor()). */
#define HL_FLOOR_SIZE 3.0

/* Fills a mesh with the defaults of a floor, which is matt and grey, and which the scene's cuts do not cut.
 */
HL_API void hl_scene_floor_defaults(hl_scene_mesh *floor);

/* Makes the triangles of a floor: a square, perpendicular to `up`, that touches everything visible from
 * below. up: null means the camera's up. size: the length of its sides over the width of what stands on it,
 * from 1 to 1000. *mesh is owned by the caller, who adds it to the description's meshes and releases it. */
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

/* Fills the picture with the visible voxels as hl_camera_frame() does, but keeps the camera's direction and
 * up vector: the camera is only moved, and its height is set. */
HL_API HL_WARN_UNUSED hl_status hl_camera_fit(const hl_scene_description *description, double zoom,
                                              hl_camera *camera);

/* Finds the direction (unit, the way light travels) of a light whose place is given as the camera sees it:
 * azimuth (positive: right) and elevation (positive: up) from the line of sight. At 0, 0 the light shines
 * along the line of sight. camera null: direction becomes 0, 0, 0, which hl_scene_create() refuses;
 * direction null: nothing is done. */
HL_API void hl_light_direction(const hl_camera *camera, double azimuth_deg, double elevation_deg,
                               double direction[3]);
/* Finds the direction of a light at an azimuth and an elevation as hl_light_direction() does, but in the axes
 * of HL_LIGHT_FRAME_CAMERA. */
HL_API void hl_light_direction_beside(double azimuth_deg, double elevation_deg, double direction[3]);

#ifdef __cplusplus
}
#endif
#endif
