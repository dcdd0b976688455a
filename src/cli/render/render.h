/* cli/render/render.h - declares the functions that the files of `halflight render` share. */
#ifndef HL_CLI_RENDER_RENDER_H
#define HL_CLI_RENDER_RENDER_H

#include "cli/host.h"
#include "cli/options.h"
#include "cli/overlay.h"

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
  RENDER_WIDTH,
  RENDER_DPI,
  RENDER_SCALE_BAR,
  RENDER_UNIT,
  RENDER_LEGEND,
  RENDER_AXES,
  RENDER_MARKS,
  RENDER_ANNOTATE,
  RENDER_PLACE,
  RENDER_FONT_SIZE,
  RENDER_VIEW,
  RENDER_VIEWS,
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
  RENDER_SPACE,
  RENDER_SMOOTH,
  RENDER_LOOK,
  RENDER_TF,
  RENDER_COLORMAP,
  RENDER_COLOR_BY,
  RENDER_COLOR_BY_THRESHOLD,
  RENDER_RANGE,
  RENDER_RANGE_SCALE,
  RENDER_RANGE_OF_ALL,
  RENDER_THRESHOLD,
  RENDER_ISO,
  RENDER_DENSITY,
  RENDER_SLICE,
  RENDER_CLIP,
  RENDER_CUT_PLANE,
  RENDER_CUT_BOX,
  RENDER_CUT_SPHERE,
  RENDER_CUT_SHADING,
  RENDER_CUT_CASTS_SHADOW,
  RENDER_WHOLE,
  RENDER_SHADING,
  RENDER_SCATTERING,
  RENDER_FLOOR,
  RENDER_OUTLINE,
  RENDER_RULER,
  RENDER_LABELS,
  RENDER_MASK,
  RENDER_LABEL_TABLE,
  RENDER_SHOW,
  RENDER_AMBIENT,
  RENDER_SKY,
  RENDER_LIGHT_RIG,
  RENDER_LIGHT,
  RENDER_LIGHT_SIZE,
  RENDER_SHADOWS,
  RENDER_SOFT_METHOD,
  RENDER_LIGHT_SAMPLES,
  RENDER_SHADOW_RESOLUTION,
  RENDER_SHADOW_LOOKUP,
  RENDER_SHEET_SPACING,
  RENDER_PIXEL_SAMPLES,
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
  RENDER_PRINT_PLAN,
  RENDER_JSON,
  RENDER_QUIET,
  RENDER_OPTION_COUNT
};

enum { RENDER_SIZE_TEXT = 32 };

/* The choices of --instruction-set; other commands have this option, too. */
extern const cli_choice instruction_set_choices[];

extern const cli_option render_options[RENDER_OPTION_COUNT];

/* Returns whether an option concerns a single picture or its file. Commands that make several pictures do not
 * have such options. */
bool render_is_of_picture(enum render_option which);

/* render_is_series() tells whether the operands or the options ask for a series: a picture of each of several
 * files. render_series() makes these pictures. motion: the numbers that change from file to file
 * (film/film.h); its context, scene and frames are not used; null if nothing changes. *count: set to the
 * number of files, or of time steps; may be null. */
struct film_options;
bool render_is_series(const cli_value *values, char **operands);
int render_series(const cli_value *values, char **operands, const struct film_options *motion, int *count);
/* --views: pictures of several sides. */
int render_views(const cli_value *values, char **operands);

/* Returns whether the operand is a pattern of scenes' names, such as 'fig*.json'. */
bool render_are_scenes(char **operands);

/* Makes the picture of one scene; returns the exit code. */
typedef int render_one_fn(const cli_value *values, char **operands);

/* Renders each scene that the pattern finds; returns the exit code. */
int render_scenes(const cli_value *values, char **operands, render_one_fn *render_one);
/* Returns whether one of the operands is a pattern that stands for several files. */
bool render_has_pattern(char **operands);

/* Refuses options that contradict each other. */
int render_check_options(const cli_value *values);

/* Divides operands by their names into meshes and others; both lists end with null. */
void render_part_meshes(hl_context *context, char **operands, char **meshes, char **others);
/* Loads meshes and adds them to a scene. Their colours are the colours of hl_surface_color(), from number
 * `first` on. If *scene is null, a scene is made for the meshes. bare: whether the camera frames the meshes,
 * too. */
int render_add_meshes(cli_host *host, char *const *paths, size_t first, bool bare, hl_scene **scene);

/* Returns whether the options say that a bare volume is itself a label map. */
bool render_is_label_map(const cli_value *values);

/* Makes the scene of a label map's layers, with the names of --label-table for the labels. It shows the
 * labels that --show names; labels of --show that the map lacks are ignored. */
hl_status render_load_label_map(cli_host *host, const cli_value *values, const char *path,
                                const hl_volume_load_options *reading, hl_scene **scene, hl_error *error);

/* Loads the operands that are no meshes: volumes, or a scene. This is the first half of
 * render_load_inputs(). */
int render_load_volumes(cli_host *host, const cli_value *values, char **operands, bool *bare,
                        hl_scene **scene);

/* The length, in pixels, that a volume on the command line fills. The volume's resolution is chosen by it. It
 * is the picture's longer side, times the zoom if `zoomed`. */
int render_pixels(const cli_value *values, bool zoomed);

/* Finds the options for loading volumes that the command line asks for. */
void render_load_options(const cli_value *values, hl_volume_load_options *options);

/* Loads the operands into one scene: a scene file, a picture that carries a scene, or one or more volumes,
 * and meshes. *bare: whether they are volumes. Several volumes share one world, and each keeps its own look.
 * Volumes are named after their files, without folder and extensions; "-2" and so on is appended to names
 * that are taken. Returns the exit code. */
int render_load_inputs(cli_host *host, const cli_value *values, char **operands, bool *bare,
                       hl_scene **scene);

/* Puts the input's name before an error line that begins with a JSON pointer into the scene. bare: whether
 * the scene was made for volume files. */
void render_name_scene(const char *input, bool bare, hl_error *error);

/* Applies the options to *scene, which becomes a new scene (hl_scene_compose()). bare: whether the scene was
 * made for volume files. flags: further HL_COMPOSE_ flags. Returns the exit code. */
int render_change_scene(cli_host *host, const cli_value *values, bool bare, unsigned flags, hl_scene **scene);

/* The pixels for which the volumes of a scene are read first (cli_input.first_pixels). */
int render_scene_pixels(const cli_value *values);
/* The pixels for which volumes of several resolutions are read first, if pictures show a part of them
 * (--zoom); 0 if they are read once. It becomes host->preview_pixels before volumes are loaded. */
int render_first_pixels(const cli_value *values);
/* Reads the volumes of a scene that were read at a coarser resolution than the pictures need, where the
 * pictures' cameras see them. cameras: [count]. Returns the exit code. */
int render_go_nearer(cli_host *host, const hl_camera *cameras, size_t count, hl_scene **scene);

/* Refuses options about the scene that contradict each other or cannot be read. */
int render_check_scene_options(const cli_value *values);

/* Returns whether --look asks for a maximum projection. */
bool render_is_projection(const cli_value *values);

/* The layers that --layers asks for; their buffers are owned by the picture. */
typedef struct render_layers {
  hl_layers all;
  hl_light_layers *lights; /* owned */
} render_layers;

/* Adds the layers "ambient", "light0", "light0_shadow", ..., "depth_first", "depth_mean", "normal" and
 * "object" to the picture, "emission" if a volume shines by itself, and "sky" and "sky_shadow" if the scene
 * has a sky. Call render_layers_release() even after a failure. */
hl_status render_layers_create(hl_image *image, const hl_scene_description *description,
                               render_layers *layers, hl_error *error);
void render_layers_release(render_layers *layers);

/* Refuses an output .npy if the file of one of its layers is a file that the run has read. input: the scene's
 * name in errors. */
int render_layers_protect(const cli_host *host, const char *output, size_t light_count, const char *input);

/* Refuses --layers if the output's format cannot hold layers. */
int render_layers_check(const cli_value *values);

/* Reads the options that draw over pictures. Call overlay_release() even after a failure. Returns the exit
 * code. */
int render_overlay_read(const cli_value *values, cli_overlay *overlay);

/* Refuses options that draw over pictures if they contradict each other or the format of the picture's
 * file. path: the name of the file, or "-.png" and so on. */
int render_overlay_check_options(const cli_value *values, const char *path);

/* The options of --reference with which a scene is rendered. */
hl_reference_options render_reference_options(const cli_value *values,
                                              const hl_scene_description *description);

/* Sets --size to width x height, as if the user had typed it. text: memory of the caller for the typed text,
 * to which the value of --size points afterwards. */
void render_set_size(cli_value *size, double width, double height, char text[RENDER_SIZE_TEXT]);

/* Sets --size, if it is not given, to the size that --width and --dpi ask for. The picture has the
 * proportions of this scene's picture. If scene is null, it has the proportions of a bare volume's picture.
 * text: room for the text of --size, which the values borrow. */
void render_overlay_set_size(cli_value *values, const hl_scene *scene, char text[RENDER_SIZE_TEXT]);

typedef struct render_seconds {
  double load, prepare, render, write, total;
} render_seconds;

/* The data of a report on a finished rendering. */
typedef struct render_result {
  const char *input, *output;
  const char *taken_for;    /* the kind of data by which the transfer function was chosen; null if it was not
                             * chosen by a kind */
  const char *next_look;    /* the look that a user may try next for such data; null if the user asked for a
                             * look */
  const char *field_errors; /* JSON with the differences between the fields of the scene's volumes and their
                             * files; null if no difference is known */
  bool reference;
  const hl_scene_description *description;
  hl_render_statistics statistics;
  render_seconds seconds;
  const hl_ranks *ranks; /* borrowed; the ranks that made the picture; null if one process made it */
} render_result;

/* Prints the statistics as JSON on stdout, or in one line on stderr. */
int render_print_json(const render_result *result);
void render_print_summary(const render_result *result);

#endif
