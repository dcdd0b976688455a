/* cli/render/inputs.c - makes one scene from the operands of `halflight render`: a scene, or volumes.
 *
 * If there are several volumes, each of them keeps the look that it would have alone. Light, background and
 * render settings come from the first volume; the camera frames all volumes, and the distance between sheets
 * suits the finest volume. */
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/input.h"
#include "render.h"
#include "text/plain.h"

/* Puts the input's name before an error of its scene. For a bare volume, "/volumes/0/file" is removed from
 * the error, because INPUT is that file. An error that already begins with the input's name, which may begin
 * with a slash too, is left alone. */
void render_name_scene(const char *input, bool bare, hl_error *error) {
  char line[sizeof error->message];
  if (error->message[0] != '/' || strncmp(error->message, input, strlen(input)) == 0) return;
  static const char file[] = "/volumes/0/file: ";
  bool itself = bare && strncmp(error->message, file, sizeof file - 1) == 0;
  snprintf(line, sizeof line, "%s", error->message + (itself ? sizeof file - 1 : 0));
  snprintf(error->message, sizeof error->message, "%.300s: %.690s",
           strcmp(input, "-") == 0 ? "standard input" : input, line);
}

/* Refuses several inputs if one of them is no volume, and refuses options for reading volumes beside a
 * scene. */
static int check_kinds(const cli_value *values, const cli_input *inputs, size_t count) {
  for (size_t n = 0; n < count && count > 1; n++)
    if (inputs[n].kind != INPUT_VOLUME)
      return fail(EXIT_CODE_USAGE,
                  "'%s' is no volume file: several INPUTs are the volumes of one picture, and a scene is a "
                  "picture of its own",
                  inputs[n].path);
  if (inputs[0].kind == INPUT_VOLUME) return EXIT_CODE_OK;
  for (int which = RENDER_ARRAY; which <= RENDER_SMOOTH; which++)
    if (values[which].given)
      return fail(EXIT_CODE_USAGE,
                  "--%s is for volume files, and '%s' is a scene: write \"%s\" beside its \"file\"",
                  render_options[which].name, inputs[0].path, render_options[which].name);
  return EXIT_CODE_OK;
}

/* The anatomical space of the first volume, to which all further volumes are converted. */
static hl_space space_of(const hl_scene *scene) {
  hl_volume_info info = {.struct_size = sizeof info};
  const hl_scene_description *description = hl_scene_describe(scene);
  bool known = description->volume_count > 0 &&
               hl_volume_get_info(description->volumes[0].volume, &info) == HL_OK;
  return known ? info.space : HL_SPACE_UNKNOWN;
}

int render_pixels(const cli_value *values, bool zoomed) {
  hl_scene_description description;
  hl_scene_description_defaults(&description);
  double width = values[RENDER_SIZE].given ? values[RENDER_SIZE].number[0] : description.width;
  double height = values[RENDER_SIZE].given ? values[RENDER_SIZE].number[1] : description.height;
  zoomed = zoomed && values[RENDER_ZOOM].given && values[RENDER_ZOOM].number[0] > 1;
  double zoom = zoomed ? values[RENDER_ZOOM].number[0] : 1;
  double pixels = ceil(fmax(width, height) * zoom);
  return pixels < INT_MAX ? (int)pixels : INT_MAX;
}

void render_load_options(const cli_value *values, hl_volume_load_options *options) {
  input_load_options(&values[RENDER_ARRAY], &values[RENDER_SPACING], options);
  if (input_has_channels(&values[RENDER_CHANNEL])) options->channel_name = NULL;
  options->pixels = render_pixels(values, true);
}

/* The scene of several channels of one file. */
static hl_status load_channels(cli_host *host, const cli_value *values, const cli_input *input,
                               hl_volume_load_options options, hl_scene **scene, hl_error *error) {
  options.bytes = input->bytes;
  options.byte_count = input->length;
  return hl_scene_for_channels(host->context, input->title, &options, values[RENDER_CHANNEL].text,
                               input->smooth, input->look != NULL ? input->look : "auto", scene, error);
}

/* Volumes on the command line that are shown as slices are not smoothed: a slice shows the voxels. */
static const double unsmoothed = 0;

static int load_each(cli_host *host, const cli_value *values, cli_input *inputs, size_t count,
                     hl_scene **scenes) {
  hl_volume_load_options options;
  render_load_options(values, &options);
  for (size_t n = 0; n < count; n++) {
    hl_error error = {0};
    bool bare = inputs[n].kind == INPUT_VOLUME;
    inputs[n].first_pixels = render_scene_pixels(values);
    inputs[n].look = values[RENDER_LOOK].given ? values[RENDER_LOOK].text : NULL;
    inputs[n].smooth = values[RENDER_SMOOTH].given  ? &values[RENDER_SMOOTH].number[0]
                       : values[RENDER_SLICE].given ? &unsmoothed
                                                    : NULL;
    /* A volume that must be read at its final resolution gets no coarser first resolution: a pipe cannot be
     * read again, and --smooth is measured in voxels of the resolution that the picture shows. */
    bool is_read_once = inputs[n].bytes != NULL || inputs[n].smooth != NULL;
    options.preview_pixels = is_read_once ? 0 : host->preview_pixels;
    hl_status status = bare && input_has_channels(&values[RENDER_CHANNEL])
                           ? load_channels(host, values, &inputs[n], options, &scenes[n], &error)
                           : input_load(host->context, &inputs[n], bare ? &options : NULL, &scenes[n],
                                        &error);
    if (bare) render_name_scene(inputs[n].path, true, &error);
    if (status != HL_OK) return host_fail(host, PHASE_READ, status, &error);
    if (options.space == HL_SPACE_UNKNOWN) options.space = space_of(scenes[n]);
  }
  return EXIT_CODE_OK;
}

/* Makes one scene of the scenes of several volumes. */
static int join(cli_host *host, hl_scene *const *scenes, size_t count, hl_scene **scene) {
  hl_error error = {0};
  hl_status status = hl_scene_join(host->context, scenes, count, scene, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}

int render_load_volumes(cli_host *host, const cli_value *values, char **operands, bool *bare,
                        hl_scene **scene) {
  cli_input inputs[MAXIMUM_OPERANDS] = {{0}};
  hl_scene *scenes[MAXIMUM_OPERANDS] = {NULL};
  size_t count = 0;
  int exit_code = EXIT_CODE_OK;
  for (; operands[count] != NULL && exit_code == EXIT_CODE_OK; count++)
    exit_code = input_open(operands[count], values[RENDER_MAX_MEMORY].bytes, &inputs[count]);
  if (exit_code == EXIT_CODE_OK) exit_code = check_kinds(values, inputs, count);
  *bare = inputs[0].kind == INPUT_VOLUME;
  if (exit_code == EXIT_CODE_OK) exit_code = load_each(host, values, inputs, count, scenes);
  if (exit_code == EXIT_CODE_OK && count > 1) exit_code = join(host, scenes, count, scene);
  for (size_t n = 0; n < count; n++) {
    input_close(&inputs[n]);
    if (n == 0 && count == 1 && exit_code == EXIT_CODE_OK) *scene = scenes[0];
    else hl_scene_release(scenes[n]);
  }
  return exit_code;
}

int render_load_inputs(cli_host *host, const cli_value *values, char **operands, bool *bare,
                       hl_scene **scene) {
  char *meshes[MAXIMUM_OPERANDS + 1], *others[MAXIMUM_OPERANDS + 1];
  int exit_code = EXIT_CODE_OK;
  *bare = true;
  render_part_meshes(host->context, operands, meshes, others);
  if (others[0] != NULL) exit_code = render_load_volumes(host, values, others, bare, scene);
  return exit_code == EXIT_CODE_OK ? render_add_meshes(host, meshes, 0, *bare, scene) : exit_code;
}
