/* cli/info.c - `halflight info VOLUME`: what a volume file holds. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "commands.h"
#include "host.h"
#include "json_writer.h"

enum info_option { INFO_JSON, INFO_MAX_MEMORY, INFO_OPTION_COUNT };

static const cli_option info_options[INFO_OPTION_COUNT] = {
    [INFO_JSON] = {.name = "json",
                   .kind = OPTION_SWITCH,
                   .group = "Options",
                   .help = "as JSON, with 256 histogram bins"},
    [INFO_MAX_MEMORY] = {.name = "max-memory",
                         .kind = OPTION_BYTES,
                         .argument = "BYTES",
                         .help = "fail rather than hold more; suffix K, M, G or T"},
};

static int print_json(const char *path, const hl_volume_info *info) {
  uint64_t dimensions[3] = {info->dimensions[0], info->dimensions[1], info->dimensions[2]};
  json_writer json = {0};
  json_open_object(&json, NULL);
  json_text(&json, "file", path);
  json_integers(&json, "dimensions", dimensions, 3);
  json_text(&json, "type", hl_voxel_type_name(info->type));
  json_numbers(&json, "spacing", info->spacing, 3);
  json_numbers(&json, "origin", info->origin, 3);
  json_open_array(&json, "direction");
  for (int row = 0; row < 3; row++) json_numbers(&json, NULL, info->direction[row], 3);
  json_close(&json);
  json_numbers(&json, "range", info->range, 2);
  json_number(&json, "mean", info->mean);
  json_integer(&json, "nonfinite_count", info->nonfinite_count);
  json_integers(&json, "histogram", info->histogram, HL_HISTOGRAM_BINS);
  json_close(&json);
  return finish_stdout();
}

/* Sixteen bars, their length logarithmic: air outnumbers what it surrounds a thousand times. */
static void print_histogram(const hl_volume_info *info) {
  enum { BARS = 16, LONGEST = 40, BINS = HL_HISTOGRAM_BINS / BARS };
  uint64_t count[BARS] = {0}, most = 0, total = 0;
  for (int i = 0; i < HL_HISTOGRAM_BINS; i++) count[i / BINS] += info->histogram[i];
  for (int i = 0; i < BARS; i++) {
    most = count[i] > most ? count[i] : most;
    total += count[i];
  }
  if (total == 0) return;
  double step = (info->range[1] - info->range[0]) / BARS;
  printf("  histogram   (bars are logarithmic)\n");
  for (int i = 0; i < BARS; i++) {
    static const char bar[] = "########################################";
    int length = (int)lround(LONGEST * log1p((double)count[i]) / log1p((double)most));
    printf("  %11.5g  %-*.*s %12" PRIu64 " %7.3f %%\n", info->range[0] + i * step, LONGEST, length, bar,
           count[i], 100 * (double)count[i] / (double)total);
  }
  printf("  %11.5g\n", info->range[1]);
}

static int print_text(const char *path, const hl_volume_info *info) {
  const double(*d)[3] = info->direction;
  uint64_t voxels = (uint64_t)info->dimensions[0] * info->dimensions[1] * info->dimensions[2];
  printf("%s\n", path);
  printf("  dimensions  %zu x %zu x %zu (%" PRIu64 " voxels)\n", info->dimensions[0], info->dimensions[1],
         info->dimensions[2], voxels);
  printf("  type        %s\n", hl_voxel_type_name(info->type));
  printf("  spacing     %.9g, %.9g, %.9g\n", info->spacing[0], info->spacing[1], info->spacing[2]);
  printf("  origin      %.9g, %.9g, %.9g\n", info->origin[0], info->origin[1], info->origin[2]);
  for (int axis = 0; axis < 3; axis++)
    printf("  %s      %c: %.9g, %.9g, %.9g\n", axis == 0 ? "axes  " : "      ", "ijk"[axis], d[0][axis],
           d[1][axis], d[2][axis]);
  printf("  range       %.9g to %.9g, mean %.9g\n", info->range[0], info->range[1], info->mean);
  if (info->nonfinite_count > 0)
    printf("  not finite  %" PRIu64 " voxels, rendered as transparent\n", info->nonfinite_count);
  print_histogram(info);
  return finish_stdout();
}

static int run_info(const cli_value *values, char **operands) {
  cli_host host;
  cli_host_options options = {.memory_limit = values[INFO_MAX_MEMORY].bytes, .subject = operands[0]};
  int exit_code = host_open(&options, &host);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  hl_volume *volume = NULL;
  hl_volume_info info = {.struct_size = sizeof info};
  hl_error error = {0};
  hl_status status = hl_volume_load(host.context, operands[0], &volume, &error);
  if (status != HL_OK)
    exit_code = host_fail(&host, PHASE_READ, status, &error);
  else if (hl_volume_get_info(volume, &info) != HL_OK)
    exit_code = fail(EXIT_CODE_FAILURE, "%s: the library does not tell what it read", operands[0]);
  else
    exit_code = values[INFO_JSON].given ? print_json(operands[0], &info) : print_text(operands[0], &info);
  hl_volume_release(volume);
  host_close(&host);
  return exit_code;
}

const cli_command info_command = {
    .name = "info",
    .operands = "VOLUME",
    .operand_count = 1,
    .summary = "show size, type, placement, range and histogram of a volume file",
    .description = "Shows what a volume file holds: size, type, spacing, orientation, range and histogram.",
    .options = info_options,
    .option_count = INFO_OPTION_COUNT,
    .run = run_info,
};
