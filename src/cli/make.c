/* cli/make.c - implements `halflight make SHAPE`, which makes volumes of ready-made shapes, or of shapes in a
 * JSON file. */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "host.h"
#include "input.h"
#include "output.h"
#include "text/edit_distance.h"

enum make_option {
  MAKE_OUTPUT,
  MAKE_SIZE,
  MAKE_SEED,
  MAKE_LIST,
  MAKE_PRINT,
  MAKE_THREADS,
  MAKE_MAX_MEMORY,
  MAKE_QUIET,
  MAKE_OPTION_COUNT
};

enum { LARGEST_TEXT = 16 << 20 };

static const cli_option make_options[MAKE_OPTION_COUNT] = {
    [MAKE_OUTPUT] = {.name = "output",
                     .letter = 'o',
                     .kind = OPTION_TEXT,
                     .argument = "VOLUME",
                     .group = "Options",
                     .help = "file to write, of a format of convert (default: SHAPE's\nname with .nrrd in "
                             "the current folder)"},
    [MAKE_SIZE] = {.name = "size",
                   .kind = OPTION_NUMBERS,
                   .argument = "N",
                   .help = "voxels along the longest side (default: as SHAPE says,\nor 128)",
                   .count = 1,
                   .whole = true,
                   .low = 16,
                   .high = 4096},
    [MAKE_SEED] = {.name = "seed",
                   .kind = OPTION_NUMBERS,
                   .argument = "N",
                   .help = "another number gives another hypertexture (default 0)",
                   .count = 1,
                   .whole = true,
                   .low = 0,
                   .high = 1000000000},
    [MAKE_LIST] = {.name = "list", .kind = OPTION_SWITCH, .help = "the ready-made shapes"},
    [MAKE_PRINT] = {.name = "print",
                    .kind = OPTION_SWITCH,
                    .help = "a ready-made shape's JSON on stdout, to begin with; no\nvolume"},
    [MAKE_THREADS] = HOST_OPTION_THREADS(NULL),
    [MAKE_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY(NULL),
    [MAKE_QUIET] = HOST_OPTION_QUIET,
};

static int print_list(void) {
  for (size_t i = 0; hl_shape_preset_name(i) != NULL; i++)
    printf("%-16s %s\n", hl_shape_preset_name(i), hl_shape_preset_summary(i));
  return finish_stdout();
}

static int print_shape(const char *shape) {
  const char *text = hl_shape_preset_text(shape);
  if (text == NULL)
    return fail(EXIT_CODE_USAGE, "--print: '%s' is not ready-made: see 'halflight make --list'", shape);
  puts(text);
  return finish_stdout();
}

static const char *preset_name(const void *data, size_t index) {
  (void)data;
  return hl_shape_preset_name(index);
}

/* Reads a file's text. text: the content, owned by the caller (free). */
static int read_text(const char *path, char **text, size_t *length) {
  FILE *file = fopen(path, "rb");
  if (file == NULL && !has_extension(path, ".json")) {
    const char *meant = hl_nearest_candidate(path, preset_name, NULL);
    return fail(EXIT_CODE_USAGE, "'%s' is no ready-made shape and no file: %s%s%s", path,
                meant != NULL ? "did you mean '" : "see 'halflight make --list'", meant != NULL ? meant : "",
                meant != NULL ? "'?" : "");
  }
  if (file == NULL) return fail(EXIT_CODE_INPUT, "%s: cannot be opened", path);
  *text = malloc(LARGEST_TEXT + 1);
  *length = *text != NULL ? fread(*text, 1, LARGEST_TEXT + 1, file) : 0;
  int bad = *text == NULL || ferror(file);
  fclose(file);
  return bad ? fail(EXIT_CODE_INPUT, "%s: cannot be read", path) : EXIT_CODE_OK;
}

static hl_status make(cli_host *host, const cli_value *values, const char *shape, const char *text,
                      size_t length, hl_volume **volume, hl_error *error) {
  hl_shapes_options options;
  hl_shapes_options_defaults(&options);
  if (values[MAKE_SIZE].given) options.size = (int)values[MAKE_SIZE].number[0];
  if (values[MAKE_SEED].given) options.seed = (int)values[MAKE_SEED].number[0];
  if (values[MAKE_THREADS].given) options.threads = (int)values[MAKE_THREADS].number[0];
  return hl_volume_from_shapes(host->context, text, length, shape, &options, volume, error);
}

static void report(const hl_volume *volume, const char *output, double seconds) {
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume, &info) == HL_OK)
    say("%s: %zu x %zu x %zu voxels of edge %.6g, %.2f s", output, info.dimensions[0], info.dimensions[1],
        info.dimensions[2], info.spacing[0], seconds);
}

static int make_and_save(const cli_value *values, char *shape, const char *output) {
  double started = hl_clock_seconds();
  const char *preset = hl_shape_preset_text(shape);
  char *text = NULL;
  size_t length = preset != NULL ? strlen(preset) : 0;
  int exit_code = preset != NULL ? EXIT_CODE_OK : read_text(shape, &text, &length);
  cli_host host = {0};
  cli_host_options options = {.quiet = values[MAKE_QUIET].given,
                              .progress = true,
                              .subject = base_name(shape),
                              .memory_limit = values[MAKE_MAX_MEMORY].bytes};
  if (exit_code == EXIT_CODE_OK) exit_code = host_open(&options, &host);
  hl_volume *volume = NULL;
  hl_error error = {0};
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = make(&host, values, shape, preset != NULL ? preset : text, length, &volume, &error);
    if (status != HL_OK) exit_code = host_fail(&host, PHASE_READ, status, &error);
  }
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = hl_volume_save(host.context, volume, output, &error);
    host_clear_bar(&host);
    if (status != HL_OK) exit_code = host_fail(&host, PHASE_RUN, status, &error);
    else if (!host.quiet) report(volume, output, hl_clock_seconds() - started);
  }
  hl_volume_release(volume);
  host_close(&host);
  free(text);
  return exit_code;
}

static int run_make(const cli_value *values, char **operands) {
  char *shape = operands[0];
  if (values[MAKE_LIST].given && shape == NULL) return print_list();
  if (values[MAKE_LIST].given)
    return fail(EXIT_CODE_USAGE, "--list takes no SHAPE, but '%s' was given", shape);
  if (shape == NULL) return fail(EXIT_CODE_USAGE, "make needs SHAPE: see 'halflight make --list'");
  if (values[MAKE_PRINT].given) return print_shape(shape);
  char *output = values[MAKE_OUTPUT].given ? strdup(values[MAKE_OUTPUT].text)
                                           : output_default_name(shape, ".nrrd");
  if (output == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  int exit_code = output_check(output, volume_extensions, operands, 1);
  if (exit_code == EXIT_CODE_OK) exit_code = make_and_save(values, shape, output);
  free(output);
  return exit_code;
}

const cli_command make_command = {
    .name = "make",
    .operands = "SHAPE",
    .operand_count = 0,
    .operand_most = 1,
    .summary = "make a volume of shapes, hypertexture or an orbital",
    .description =
        "Makes a volume of SHAPE: the name of a ready-made one (--list), or a JSON file with the keys\n"
        "\"shapes\" and, if wanted, \"voxel_size\" and \"groups\", as in a scene.",
    .options = make_options,
    .option_count = MAKE_OPTION_COUNT,
    .run = run_make,
};
