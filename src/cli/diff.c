/* cli/diff.c - implements `halflight diff A B`, which prints the differences of two pictures, and fails if a
 * difference exceeds a limit. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "commands.h"
#include "host.h"
#include "json_writer.h"
#include "output.h"

enum diff_option {
  DIFF_MAX_RMSE,
  DIFF_MAX_ERROR,
  DIFF_MAX_P999,
  DIFF_MAX_MEAN,
  DIFF_OUTPUT,
  DIFF_AMPLIFY,
  DIFF_MAX_MEMORY,
  DIFF_JSON,
  DIFF_OPTION_COUNT
};

static const cli_option diff_options[DIFF_OPTION_COUNT] = {
    [DIFF_MAX_RMSE] = {.name = "max-rmse",
                       .kind = OPTION_NUMBERS,
                       .argument = "X",
                       .group = "Limits (exit code 1 when exceeded)",
                       .help = "root mean square over all pixels and channels",
                       .count = 1,
                       .high = INFINITY},
    [DIFF_MAX_ERROR] = {.name = "max-error",
                        .kind = OPTION_NUMBERS,
                        .argument = "X",
                        .help = "greatest difference",
                        .count = 1,
                        .high = INFINITY},
    [DIFF_MAX_P999] = {.name = "max-p999",
                       .kind = OPTION_NUMBERS,
                       .argument = "X",
                       .help = "99.9th percentile of the pixels' greatest\ndifference",
                       .count = 1,
                       .high = INFINITY},
    [DIFF_MAX_MEAN] = {.name = "max-mean",
                       .kind = OPTION_NUMBERS,
                       .argument = "X",
                       .help = "mean signed difference of any channel",
                       .count = 1,
                       .high = INFINITY},
    [DIFF_OUTPUT] = {.name = "output",
                     .letter = 'o',
                     .kind = OPTION_TEXT,
                     .argument = "OUT",
                     .group = "Output",
                     .help = "picture of the absolute differences\n(.png, .exr or .npy)"},
    [DIFF_AMPLIFY] = {.name = "amplify",
                      .kind = OPTION_NUMBERS,
                      .argument = "FACTOR",
                      .help = "of that picture (default: the greatest\ndifference becomes 1)",
                      .count = 1,
                      .above = true,
                      .high = INFINITY},
    [DIFF_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY(NULL),
    [DIFF_JSON] = {.name = "json", .kind = OPTION_SWITCH, .help = "metrics as JSON"},
};

typedef struct image_pair {
  const cli_value *values;
  char **paths;    /* A and B */
  hl_image *a, *b; /* owned */
  hl_image_difference difference;
  double mean; /* the greatest magnitude of the mean differences of the four channels */
} image_pair;

/* The measured value to which a limit applies. */
static double measured(const image_pair *comparison, int limit) {
  switch (limit) {
    case DIFF_MAX_RMSE: return comparison->difference.rmse;
    case DIFF_MAX_ERROR: return comparison->difference.maximum;
    case DIFF_MAX_P999: return comparison->difference.percentile_99_9;
    default: return comparison->mean;
  }
}

/* Returns true if the limit is not given, or not exceeded. A measured value of NaN, which comes from a NaN in
 * a picture, exceeds every limit. */
static bool within(const image_pair *comparison, int limit) {
  const cli_value *value = &comparison->values[limit];
  return !value->given || measured(comparison, limit) <= value->number[0];
}

static int check_limits(const image_pair *comparison) {
  int exit_code = EXIT_CODE_OK;
  for (int limit = DIFF_MAX_RMSE; limit <= DIFF_MAX_MEAN; limit++)
    if (!within(comparison, limit))
      exit_code = fail(EXIT_CODE_FAILURE, "%s and %s differ: --%s %s, but %.6g was measured",
                       comparison->paths[0], comparison->paths[1], diff_options[limit].name,
                       comparison->values[limit].text, measured(comparison, limit));
  return exit_code;
}

static int print_json(const image_pair *comparison) {
  const hl_image_difference *difference = &comparison->difference;
  uint64_t place[2] = {(uint64_t)difference->maximum_x, (uint64_t)difference->maximum_y};
  bool within_limits = true;
  for (int limit = DIFF_MAX_RMSE; limit <= DIFF_MAX_MEAN; limit++) within_limits &= within(comparison, limit);
  json_writer json = {0};
  json_open_object(&json, NULL);
  json_text(&json, "a", comparison->paths[0]);
  json_text(&json, "b", comparison->paths[1]);
  json_whole_number(&json, "width", (uint64_t)hl_image_width(comparison->a));
  json_whole_number(&json, "height", (uint64_t)hl_image_height(comparison->a));
  json_number(&json, "rmse", difference->rmse);
  json_numbers(&json, "rmse_channel", difference->rmse_channel, 4);
  json_numbers(&json, "mean_signed", difference->mean_signed, 4);
  json_number(&json, "percentile_99_9", difference->percentile_99_9);
  json_number(&json, "maximum", difference->maximum);
  json_whole_numbers(&json, "maximum_at", place, 2);
  json_whole_number(&json, "differing_pixels", difference->differing_pixels);
  json_bool(&json, "within_limits", within_limits);
  json_close(&json);
  return finish_stdout();
}

static int print_text(const image_pair *comparison) {
  const hl_image_difference *difference = &comparison->difference;
  uint64_t pixels = (uint64_t)hl_image_width(comparison->a) * (uint64_t)hl_image_height(comparison->a);
  printf("rmse           %.6g\n", difference->rmse);
  printf("rmse R G B A   %.6g %.6g %.6g %.6g\n", difference->rmse_channel[0], difference->rmse_channel[1],
         difference->rmse_channel[2], difference->rmse_channel[3]);
  printf("mean R G B A   %+.6g %+.6g %+.6g %+.6g\n", difference->mean_signed[0], difference->mean_signed[1],
         difference->mean_signed[2], difference->mean_signed[3]);
  printf("99.9 %%         %.6g\n", difference->percentile_99_9);
  printf("maximum        %.6g at pixel %d,%d\n", difference->maximum, difference->maximum_x,
         difference->maximum_y);
  printf("pixels         %" PRIu64 " of %" PRIu64 " differ\n", difference->differing_pixels, pixels);
  return finish_stdout();
}

/* Writes |b - a| times a factor, as an opaque picture. If the difference of alpha is greater than the
 * difference of a colour channel, the channel shows the difference of alpha. */
static int write_picture(cli_host *host, const image_pair *comparison) {
  const char *path = comparison->values[DIFF_OUTPUT].text;
  const cli_value *amplify = &comparison->values[DIFF_AMPLIFY];
  double maximum = comparison->difference.maximum;
  double factor = amplify->given ? amplify->number[0] : maximum > 0 ? 1 / maximum : 1;
  int width = hl_image_width(comparison->a), height = hl_image_height(comparison->a);
  const float *a = hl_image_pixels_const(comparison->a), *b = hl_image_pixels_const(comparison->b);
  hl_image *picture = NULL;
  hl_error error = {0};
  hl_status status = hl_image_create(host->context, width, height, &picture, &error);
  if (status == HL_OK) {
    float *pixels = hl_image_pixels(picture);
    for (size_t i = 0; i < 4 * (size_t)width * (size_t)height; i += 4) {
      double alpha = fabs((double)b[i + 3] - a[i + 3]);
      for (size_t c = i; c < i + 3; c++)
        pixels[c] = (float)fmin(1, factor * fmax(alpha, fabs((double)b[c] - a[c])));
      pixels[i + 3] = 1;
    }
    status = hl_image_write(host->context, picture, path, NULL, &error);
  }
  hl_image_destroy(picture);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_RUN, status, &error);
}

static int compare(cli_host *host, image_pair *comparison) {
  hl_error error = {0};
  hl_status status = hl_image_read(host->context, comparison->paths[0], &comparison->a, &error);
  if (status == HL_OK) status = hl_image_read(host->context, comparison->paths[1], &comparison->b, &error);
  if (status != HL_OK) return host_fail(host, PHASE_READ, status, &error);
  const hl_image *a = comparison->a, *b = comparison->b;
  if (hl_image_width(a) != hl_image_width(b) || hl_image_height(a) != hl_image_height(b))
    return fail(EXIT_CODE_INPUT, "%s is %dx%d and %s is %dx%d: only pictures of the same size compare",
                comparison->paths[0], hl_image_width(a), hl_image_height(a), comparison->paths[1],
                hl_image_width(b), hl_image_height(b));
  hl_image_difference *difference = &comparison->difference;
  difference->struct_size = sizeof *difference;
  status = hl_image_compare(a, b, difference, &error);
  if (status != HL_OK) return host_fail(host, PHASE_READ, status, &error);
  for (int channel = 0; channel < 4; channel++) {
    double mean = fabs(difference->mean_signed[channel]);
    if (!(mean <= comparison->mean)) comparison->mean = mean;
  }
  return EXIT_CODE_OK;
}

static int run_diff(const cli_value *values, char **operands) {
  if (values[DIFF_AMPLIFY].given && !values[DIFF_OUTPUT].given)
    return fail(EXIT_CODE_USAGE, "--amplify is for --output: give both or none");
  int exit_code = values[DIFF_OUTPUT].given
                      ? output_check(values[DIFF_OUTPUT].text, picture_extensions, operands, 2)
                      : EXIT_CODE_OK;
  if (exit_code != EXIT_CODE_OK) return exit_code;
  cli_host host;
  cli_host_options options = {.subject = operands[0], .memory_limit = values[DIFF_MAX_MEMORY].bytes};
  exit_code = host_open(&options, &host);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  image_pair comparison = {.values = values, .paths = operands};
  exit_code = compare(&host, &comparison);
  if (exit_code == EXIT_CODE_OK && values[DIFF_OUTPUT].given) exit_code = write_picture(&host, &comparison);
  if (exit_code == EXIT_CODE_OK)
    exit_code = values[DIFF_JSON].given ? print_json(&comparison) : print_text(&comparison);
  if (exit_code == EXIT_CODE_OK) exit_code = check_limits(&comparison);
  hl_image_destroy(comparison.a);
  hl_image_destroy(comparison.b);
  host_close(&host);
  return exit_code;
}

const cli_command diff_command = {
    .name = "diff",
    .operands = "A B",
    .operand_count = 2,
    .summary = "compare two pictures; with limits, a test",
    .description =
        "Compares two pictures of the same size (.png, .tif, .exr, .npy) as linear premultiplied RGBA\n"
        "and prints the differences of B against A.",
    .options = diff_options,
    .option_count = DIFF_OPTION_COUNT,
    .run = run_diff,
};
