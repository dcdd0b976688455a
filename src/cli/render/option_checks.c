/* cli/render/option_checks.c - refuses options of `halflight render` that exclude each other. */
#include <math.h>
#include <string.h>

#include "cli/frames.h"
#include "cli/input.h"
#include "cli/output.h"
#include "render.h"

/* The checks below judge OUT by the ending of its name. If --format is given, they judge one of these names
 * instead. There is one name for each choice of --format, in the order of the choices. */
static const char *const format_extensions[] = {"-.png", "-.exr", "-.npy", "-.tif", "-.pdf", "-.svg"};

bool render_is_of_picture(enum render_option which) {
  switch (which) {
    case RENDER_OUTPUT:
    case RENDER_FORMAT:
    case RENDER_DEPTH:
    case RENDER_LAYERS:
    case RENDER_VIEWS:
    case RENDER_WIDTH:
    case RENDER_DPI:
    case RENDER_REFERENCE:
    case RENDER_LIGHT_POINTS:
    case RENDER_STEP:
    case RENDER_PATHS:
    case RENDER_RAYS:
    case RENDER_STRIPS:
    case RENDER_VOLUME:
    case RENDER_PRINT_SCENE:
    case RENDER_PRINT_PLAN:
    case RENDER_JSON: return true;
    default: return false;
  }
}

/* Refuses --exposure, --tone and --depth for .exr and .npy files, which hold linear light. */
static int check_linear_output(const cli_value *values, bool named) {
  static const int of_png[] = {RENDER_EXPOSURE, RENDER_TONE, RENDER_DEPTH};
  const cli_value *output = &values[RENDER_OUTPUT], *format = &values[RENDER_FORMAT];
  for (size_t n = 0; n < sizeof of_png / sizeof *of_png; n++) {
    const char *name = render_options[of_png[n]].name;
    if (!values[of_png[n]].given) continue;
    if (named && output_is_linear(output->text))
      return fail(EXIT_CODE_USAGE,
                  "--%s is for .png pictures, not for '%s': .exr and .npy hold linear light as it is", name,
                  output->text);
    if (format->given && (format->choice == 1 || format->choice == 2))
      return fail(EXIT_CODE_USAGE, "--%s is for .png pictures: %s holds linear light as it is", name,
                  format->text);
  }
  return EXIT_CODE_OK;
}

int render_check_options(const cli_value *values) {
  const cli_value *output = &values[RENDER_OUTPUT], *format = &values[RENDER_FORMAT];
  bool named = output->given && strcmp(output->text, "-") != 0;
  static const int pictures[] = {RENDER_OUTPUT, RENDER_FORMAT,    RENDER_DEPTH, RENDER_NO_METADATA,
                                 RENDER_LAYERS, RENDER_REFERENCE, RENDER_JSON};
  const int printed = values[RENDER_PRINT_SCENE].given ? RENDER_PRINT_SCENE : RENDER_PRINT_PLAN;
  if (values[RENDER_PRINT_SCENE].given && values[RENDER_PRINT_PLAN].given)
    return fail(EXIT_CODE_USAGE, "--print-scene and --print-plan: standard output takes one of them");
  for (size_t n = 0; values[printed].given && n < sizeof pictures / sizeof *pictures; n++)
    if (values[pictures[n]].given)
      return fail(EXIT_CODE_USAGE, "--%s makes no picture: remove --%s", render_options[printed].name,
                  render_options[pictures[n]].name);
  static const int alone[] = {RENDER_LAYERS, RENDER_REFERENCE, RENDER_PRINT_SCENE, RENDER_PRINT_PLAN};
  int over_ranks = values[RENDER_VOLUME].given ? RENDER_VOLUME : RENDER_STRIPS;
  for (size_t n = 0; values[over_ranks].given && n < sizeof alone / sizeof *alone; n++)
    if (values[alone[n]].given)
      return fail(EXIT_CODE_USAGE, "--%s shares a picture by sheets: remove --%s",
                  render_options[over_ranks].name, render_options[alone[n]].name);
  int exit_code = input_check_channels(&values[RENDER_CHANNEL]);
  if (exit_code == EXIT_CODE_OK) exit_code = input_check_place(&values[RENDER_SPACING]);
  if (exit_code == EXIT_CODE_OK) exit_code = render_check_scene_options(values);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  exit_code = check_linear_output(values, named);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  exit_code = render_overlay_check_options(values, named           ? output->text
                                                   : format->given ? format_extensions[format->choice]
                                                                   : ".png");
  if (exit_code != EXIT_CODE_OK) return exit_code;
  for (int which = RENDER_LIGHT_POINTS; which <= RENDER_RAYS; which++)
    if (values[which].given && !values[RENDER_REFERENCE].given)
      return fail(EXIT_CODE_USAGE, "--%s is for --reference: give both or none", render_options[which].name);
  return render_layers_check(values);
}
