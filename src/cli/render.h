/* cli/render.h - shared by the files of `halflight render`. */
#ifndef HL_CLI_RENDER_H
#define HL_CLI_RENDER_H

#include "host.h"
#include "options.h"

enum render_option {
  RENDER_OUTPUT,
  RENDER_FORMAT,
  RENDER_SIZE,
  RENDER_DEPTH,
  RENDER_NO_METADATA,
  RENDER_BACKGROUND,
  RENDER_EXPOSURE,
  RENDER_TONE,
  RENDER_LAYERS,
  RENDER_VIEW,
  RENDER_UP,
  RENDER_AZIMUTH,
  RENDER_ELEVATION,
  RENDER_ROLL,
  RENDER_ZOOM,
  RENDER_FOVY,
  RENDER_ORTHO,
  RENDER_ARRAY,
  RENDER_COMPONENT,
  RENDER_SERIES,
  RENDER_TIME,
  RENDER_CHANNEL,
  RENDER_LEVEL,
  RENDER_SPACING,
  RENDER_LOOK,
  RENDER_TF,
  RENDER_COLORMAP,
  RENDER_RANGE,
  RENDER_RANGE_SCALE,
  RENDER_RANGE_OF_ALL,
  RENDER_THRESHOLD,
  RENDER_ISO,
  RENDER_CLIP,
  RENDER_CUT_PLANE,
  RENDER_CUT_BOX,
  RENDER_CUT_SPHERE,
  RENDER_CUT_SHADING,
  RENDER_CUT_CASTS_SHADOW,
  RENDER_WHOLE,
  RENDER_SHADING,
  RENDER_FLOOR,
  RENDER_LABELS,
  RENDER_MASK,
  RENDER_LABEL_TABLE,
  RENDER_SHOW,
  RENDER_AMBIENT,
  RENDER_SKY,
  RENDER_LIGHT,
  RENDER_LIGHT_SIZE,
  RENDER_SHADOWS,
  RENDER_SOFT_METHOD,
  RENDER_LIGHT_SAMPLES,
  RENDER_SHADOW_RESOLUTION,
  RENDER_SHADOW_LOOKUP,
  RENDER_SHEET_SPACING,
  RENDER_KERNEL,
  RENDER_RECONSTRUCTION,
  RENDER_SLICING,
  RENDER_REFERENCE,
  RENDER_LIGHT_POINTS,
  RENDER_STEP,
  RENDER_PATHS,
  RENDER_RAYS,
  RENDER_DATA,
  RENDER_PART,
  RENDER_RANKS,
  RENDER_STRIPS,
  RENDER_VOLUME,
  RENDER_THREADS,
  RENDER_INSTRUCTION_SET,
  RENDER_DEVICE,
  RENDER_MAX_MEMORY,
  RENDER_PRINT_SCENE,
  RENDER_JSON,
  RENDER_QUIET,
  RENDER_OPTION_COUNT
};

/* Choices that other commands have too. */
extern const cli_choice look_choices[], instruction_set_choices[];

extern const cli_option render_options[RENDER_OPTION_COUNT];

/* Whether the operands or the options ask for a picture of each of several files; makes these pictures. */
bool render_is_series(const cli_value *values, char **operands);
int render_series(const cli_value *values, char **operands);

/* Refuses options that contradict each other. */
int render_check_options(const cli_value *values);

/* Parts operands into meshes, by their names, and others; both lists end with null. */
void render_part_meshes(char **operands, char **meshes, char **others);
/* Loads one mesh, in the colour of the index-th; the caller releases mesh->mesh. */
hl_status render_load_mesh(hl_context *context, const char *path, size_t index, hl_scene_mesh *mesh,
                           hl_error *error);
/* Adds meshes to a scene, in the colours from `first` on; *scene null: makes one for them. bare: the camera
 * frames them too. */
int render_add_meshes(cli_host *host, char *const *paths, size_t first, bool bare, hl_scene **scene);

/* Adds the label map of --labels to a scene, gives its volumes that of --mask, or makes one of its bare
 * volume, with what --label-table and
 * --show say. */
int render_add_labels(cli_host *host, const cli_value *values, bool bare, hl_scene **scene);

enum { RENDER_MOST_LABEL_LAYERS = 64 };

/* The layers of a label map's file, as volumes whose labels and voxels are owned here. */
typedef struct render_label_layers {
  hl_scene_volume volumes[RENDER_MOST_LABEL_LAYERS];
  size_t count;
} render_label_layers;

/* Whether the options say that a bare volume is a label map itself. */
bool render_is_label_map(const cli_value *values);

/* Loads such a volume, named by --label-table; of its labels those of --show show, and those of --show that
 * it lacks are passed over. Call render_release_label_layers() even after a failure. Returns the exit code.
 */
int render_load_label_map(cli_host *host, const cli_value *values, const char *path,
                          const hl_volume_load_options *reading, render_label_layers *layers);
void render_release_label_layers(hl_context *context, render_label_layers *layers);

/* Loads the volumes, or the scene, of operands that are no meshes: the first half of render_load_inputs(). */
int render_load_volumes(cli_host *host, const cli_value *values, char **operands, bool *bare,
                        hl_scene **scene);

/* The channels that --channel names; *count: 0: all, or the option was not given. Refuses others. */
int render_channels(const cli_value *values, int channels[HL_CHANNELS_MOST], size_t *count);

/* Whether the options ask for more than one channel: "all" may be one, too. */
bool render_has_channels(const cli_value *values);

/* The reading of volumes that the options ask for. */
void render_load_options(const cli_value *values, hl_volume_load_options *options);

/* Loads the operands into one scene: a scene file, a picture that carries a scene, or one or more volumes,
 * and meshes; *bare: they are volumes. Several volumes share one world, and each keeps its own look. They are
 * named like their files without folder and extensions; "-2" and so on is appended to names that are taken.
 * Returns the exit code. */
int render_load_inputs(cli_host *host, const cli_value *values, char **operands, bool *bare,
                       hl_scene **scene);

/* Puts the input's name before an error that begins with a JSON pointer into the scene. */
void render_name_scene(const char *input, bool bare, hl_error *error);

/* Replaces *scene by one with the options applied. bare: the scene was made for volume files, so the camera
 * is framed anew where an option changes the picture's shape or what is seen. Returns the exit code. */
int render_change_scene(cli_host *host, const cli_value *values, bool bare, hl_scene **scene);

/* True if --tf, --colormap, --range or --threshold was given. */
bool render_recolors(const cli_value *values);

/* The library's look that --look asks for; null: none, or a maximum projection. */
const char *render_look_name(const cli_value *values);

/* For --look: true if it replaces the volumes' transfer functions; gives one volume its transfer function
 * (free with hl_transfer_function_release) and shading; applies its other changes. bare: see
 * render_change_scene().
 */
bool render_look_recolors(const cli_value *values, bool bare);
hl_status render_look_volume(cli_host *host, const cli_value *values, hl_scene_volume *volume,
                             hl_error *error);
void render_change_look(const cli_value *values, bool bare, hl_scene_description *description);

/* True if the picture is a maximum projection, by --look or else by the scene. */
bool render_is_maximum(const cli_value *values, const hl_scene_description *description);

/* Where the picture is made without light, warns of options that concern light, and returns true. */
bool render_warn_of_no_light(const cli_value *values, const hl_scene_description *description);

/* The colour that --look mip gives volume number `index` among several bare ones, so that channels differ, as
 * "#rrggbb"; false: none, as the volume is alone or has a --tf. */
bool render_channel_color(const cli_value *values, const hl_scene_description *description, size_t index,
                          char color[8]);

/* The transfer function of volume number `index` with --tf, --range, --threshold and --colormap applied, or
 * `color` where no --colormap is for this volume and color is not null. Its points are owned by the caller,
 * after a failure too (render_release_function). Returns the exit code. */
int render_transfer_function(cli_host *host, const cli_value *values, const hl_scene_description *description,
                             size_t index, const char *color, hl_transfer_function *function);
void render_release_function(hl_transfer_function *function);

/* Copies a function of two numbers; false without memory. The copy is released afterwards, too. */
bool render_copy_plane(const hl_function_plane *from, hl_function_plane *to);
void render_release_plane(hl_function_plane *plane);

/* Moves the scene's camera along its direction and zooms so that all that there is now fits into the picture.
 */
hl_status render_frame_anew(hl_scene_description *description, hl_error *error);

/* The name of a volume in --tf NAME=... and --colormap NAME=...: its name in the scene, else its file's
 * without folder and extensions, else "volume1" and so on. */
void render_volume_name(const hl_scene_volume *volume, size_t index, char *name, size_t size);

/* The text after "NAME=" of such an option; null: it is for every volume. A text that names an existing file
 * is that file, even with a '=' in it. */
const char *render_after_name(const char *text);

/* Whether such an option is for the volume with this name. */
bool render_is_for(const char *text, const char *name);

/* Refuses --tf, --colormap and --iso NAME=... for names that no volume has. */
int render_check_names(const cli_value *values, const hl_scene_description *description);

/* The colour of a mesh or an isosurface that has none of its own, linear RGB: ivory, blue, ochre, green,
 * rose, violet, and again. */
const double *render_surface_color(size_t index);

/* Refuses values of --iso that cannot be read. */
int render_check_iso(const cli_value *iso);

/* Gives volume number `index` the surfaces of --iso that are for it, and makes its transfer function, whose
 * points are the caller's, clear where no option sets it. surfaces: room for all values of --iso, which the
 * volume borrows. Returns the exit code. */
int render_iso(const cli_host *host, const cli_value *values, size_t index, hl_scene_volume *volume,
               hl_isosurface *surfaces);

/* A coordinate on the command line: a bare number is a fraction of the box around the volume's voxels, a
 * number with a unit is a coordinate of the file's world. */
typedef struct render_coordinate {
  bool given, fraction;
  double number;
} render_coordinate;

/* Reads "0.25", "10mm" or nothing, and moves *text past it. False if something else is there. */
bool render_read_coordinate(const char **text, render_coordinate *coordinate);

/* The coordinate; otherwise: where it is left out; low, high: the ends of the volume's box. */
double render_coordinate_of(const render_coordinate *coordinate, double otherwise, double low, double high);

/* A range along an axis: "x=LO:HI". Moves *text past it; false if something else is there. */
typedef struct render_axis_range {
  int axis;
  render_coordinate ends[2];
} render_axis_range;
bool render_read_range(const char **text, render_axis_range *range);

/* Refuses values of --cut-plane, --cut-box and --cut-sphere that cannot be read. */
int render_check_cuts(const cli_value *values);

/* How many cuts the options ask for. */
size_t render_cut_count(const cli_value *values);

/* Adds the options' cuts to a volume's own. cuts: room for all of them, which the volume borrows. */
int render_cuts(const cli_value *values, hl_scene_volume *volume, hl_cut *cuts);

/* Adds them to a scene's own, for all its volumes; fractions are of the box around these. cuts: as above. */
int render_scene_cuts(const cli_value *values, hl_scene_description *scene, hl_cut *cuts);

/* Refuses values of --clip that cannot be read. */
int render_check_clip(const cli_value *clip);

/* Cuts a volume's clip box by --clip. */
int render_clip(const cli_value *clip, hl_scene_volume *volume);

/* Refuses a value of --sky that cannot be read. */
int render_check_sky(const cli_value *sky);

/* Gives the scene the sky of --sky, if it was given: without a sky before, upright as the camera is. *pixels:
 * an image's, borrowed by the description; the caller frees them. Returns the exit code. */
int render_sky(cli_host *host, const cli_value *value, hl_scene_description *description, float **pixels);

/* The layers that --layers asks for; their buffers are owned by the picture. */
typedef struct render_layers {
  hl_layers all;
  hl_light_layers *lights; /* owned */
} render_layers;

/* Adds the layers "ambient", "light0", "light0_shadow", ..., "depth_first", "depth_mean", "normal" and
 * "object" to the picture, "emission" where a volume shines by itself, "sky" and "sky_shadow" where the scene
 * has a sky. Call render_layers_release() even after a failure.
 */
hl_status render_layers_create(hl_image *image, const hl_scene_description *description,
                               render_layers *layers, hl_error *error);
void render_layers_release(render_layers *layers);

/* Refuses an .npy OUT if one of its layers' files is a file that the run has read; input: what errors call
 * the scene. */
int render_layers_protect(const cli_host *host, const char *output, size_t light_count, const char *input);

/* Refuses --layers for an OUT that cannot hold them. */
int render_layers_check(const cli_value *values);

typedef struct render_seconds {
  double load, prepare, render, write, total;
} render_seconds;

/* The data of a report on a finished rendering. */
typedef struct render_result {
  const char *input, *output;
  const char *taken_for; /* the kind of data that the transfer function was chosen for; null: not chosen */
  bool reference;
  const hl_scene_description *description;
  hl_render_statistics statistics;
  render_seconds seconds;
  const hl_ranks *ranks; /* borrowed; the picture's; null: one process */
} render_result;

/* Prints the statistics as JSON on stdout, or in one line on stderr. */
int render_print_json(const render_result *result);
void render_print_summary(const render_result *result);

#endif
