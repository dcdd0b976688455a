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
  RENDER_BACKGROUND,
  RENDER_EXPOSURE,
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
  RENDER_THRESHOLD,
  RENDER_CLIP,
  RENDER_SHADING,
  RENDER_AMBIENT,
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
  RENDER_DATA,
  RENDER_THREADS,
  RENDER_INSTRUCTION_SET,
  RENDER_MAX_MEMORY,
  RENDER_PRINT_SCENE,
  RENDER_JSON,
  RENDER_QUIET,
  RENDER_OPTION_COUNT
};

/* Choices that other commands have too. */
extern const cli_choice look_choices[], instruction_set_choices[];

extern const cli_option render_options[RENDER_OPTION_COUNT];

/* Refuses options that contradict each other. */
int render_check_options(const cli_value *values);

/* The scene of the operands: a scene, a picture that carries one, or volumes; *bare: one that was made for
 * volumes. Each of several volumes has its own look, in one world, and is called by its file's name without
 * folder and extensions, with -2 and so on behind it where that is taken. Returns the exit code. */
int render_load_inputs(cli_host *host, const cli_value *values, char **operands, bool *bare,
                       hl_scene **scene);

/* A place in a scene (a JSON pointer) that an error begins with follows the input's name. */
void render_name_scene(const char *input, bool bare, hl_error *error);

/* Replaces *scene by one that differs from it as the options say. bare: the scene was made for a
 * volume file, so that camera and key light follow the options. Returns the exit code. */
int render_change_scene(cli_host *host, const cli_value *values, bool bare, hl_scene **scene);

/* Whether --tf, --colormap, --range or --threshold were given. */
bool render_recolors(const cli_value *values);

/* --look: whether it gives volumes other transfer functions, the one of a volume, and what else it changes.
 * bare: see render_change_scene. */
bool render_look_recolors(const cli_value *values, bool bare);
hl_status render_look_function(cli_host *host, const cli_value *values, const hl_volume *volume,
                               hl_transfer_function *function, hl_error *error);
void render_change_look(const cli_value *values, bool bare, hl_scene_description *description);

/* Whether the picture is a maximum projection: --look decides, else the scene. */
bool render_is_maximum(const cli_value *values, const hl_scene_description *description);

/* Says which options were given that light alone makes seen, where there is none; true where there is
 * none. */
bool render_warn_of_no_light(const cli_value *values, const hl_scene_description *description);

/* The transfer function that they make of that of volume number `index`. Its points are owned by the caller,
 * also after a failure (render_release_function); the volume's own function is left alone. */
int render_transfer_function(cli_host *host, const cli_value *values, const hl_scene_description *description,
                             size_t index, hl_transfer_function *function);
void render_release_function(hl_transfer_function *function);

/* What --tf and --colormap NAME=... call a volume: its name in the scene, else its file's without folder and
 * extensions. */
void render_volume_name(const hl_scene_volume *volume, size_t index, char *name, size_t size);

/* Refuses --tf and --colormap NAME=... for names that no volume has. */
int render_check_names(const cli_value *values, const hl_scene_description *description);

/* Refuses what is no range. */
int render_check_clip(const cli_value *clip);

/* Cuts a volume's clip box as --clip says. */
int render_clip(const cli_value *clip, hl_scene_volume *volume);

/* The layers that --layers asks for: buffers of the picture's. */
typedef struct render_layers {
  hl_layers all;
  hl_light_layers *lights; /* owned */
} render_layers;

/* Adds a layer "ambient", "light0", "light0_shadow", ..., "depth_first", "depth_mean" and "normal" to the
 * picture, and "emission" where a volume shines by itself. Released in any case. */
hl_status render_layers_create(hl_image *image, const hl_scene_description *description,
                               render_layers *layers, hl_error *error);
void render_layers_release(render_layers *layers);

/* Refuses an OUT whose layers, in files of their own, would be written over a file that the run has read;
 * input: what errors call the scene. */
int render_layers_protect(const cli_host *host, const char *output, size_t light_count, const char *input);

/* Refuses --layers for an OUT that cannot hold them. */
int render_layers_check(const cli_value *values);

typedef struct render_seconds {
  double load, prepare, render, write, total;
} render_seconds;

/* What is known when the picture is written. */
typedef struct render_result {
  const char *input, *output;
  const char *taken_for; /* the kind of data that the transfer function was chosen for; null: it was not */
  bool reference;
  const hl_scene_description *description;
  hl_render_statistics statistics;
  render_seconds seconds;
} render_result;

/* The statistics as JSON on stdout, or one line on stderr. */
int render_print_json(const render_result *result);
void render_print_summary(const render_result *result);

#endif
