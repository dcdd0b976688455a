/* cli/bench_report.c - medians of the measured frames, as JSON and as a table. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bench.h"
#include "json_writer.h"

static const char *const move_names[] = {"camera", "light", "tf"};
static const char *const stage_names[STAGE_COUNT] = {
    "prepare", "sort", "splat_eye", "splat_light", "shade", "composite_light", "soften", "other"};

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

enum { WHOLE_FRAME = -1, PROCESSOR = -2 };

static double seconds_of(const bench_sample *sample, int stage) {
  return stage == WHOLE_FRAME ? sample->frame : stage == PROCESSOR ? sample->processor : sample->stage[stage];
}

/* The first kind of shadows that was measured: what it says of the volume and the machine holds for all. */
static const bench_run *first_measured(const bench_result *result) {
  int setting = 0;
  while (setting < SETTING_COUNT - 1 && !result->run[setting].supported) setting++;
  return &result->run[setting];
}

/* Milliseconds; stage: also WHOLE_FRAME or PROCESSOR. NAN where the setting is not supported. */
static double median_ms(const bench_run *run, int frames, int stage) {
  double *values = run->supported ? malloc((size_t)frames * sizeof *values) : NULL;
  if (values == NULL) return NAN;
  for (int i = 0; i < frames; i++) values[i] = 1e3 * seconds_of(&run->samples[i], stage);
  qsort(values, (size_t)frames, sizeof *values, compare);
  double median = (values[(frames - 1) / 2] + values[frames / 2]) / 2;
  free(values);
  return median;
}

static void print_pair(json_writer *json, const char *key, uint64_t filled, uint64_t skipped) {
  json_open_object(json, key);
  json_integer(json, "filled", filled);
  json_integer(json, "skipped", skipped);
  json_close(json);
}

/* Of the last frame. */
static void print_work(json_writer *json, const char *key, const hl_render_statistics *s) {
  json_open_object(json, key);
  json_integer(json, "sheets", (uint64_t)s->sheets);
  json_integer(json, "voxels_kept", s->voxels_kept);
  json_integer(json, "samples_shaded", s->samples_shaded);
  json_open_object(json, "pixels");
  print_pair(json, "image", s->pixels_filled_image, s->pixels_skipped_image);
  print_pair(json, "light", s->pixels_filled_light, s->pixels_skipped_light);
  json_close(json);
  json_open_object(json, "tiles");
  print_pair(json, "image", s->tiles_filled_image, s->tiles_skipped_image);
  print_pair(json, "light", s->tiles_filled_light, s->tiles_skipped_light);
  json_close(json);
  json_close(json);
}

static void print_result(json_writer *json, const bench_result *result) {
  const hl_render_statistics *statistics = &first_measured(result)->statistics;
  json_open_object(json, NULL);
  json_text(json, "version", hl_version());
  json_text(json, "input", result->input);
  json_integer(json, "width", (uint64_t)result->width);
  json_integer(json, "height", (uint64_t)result->height);
  json_integer(json, "frames", (uint64_t)result->frames);
  json_text(json, "move", move_names[result->move]);
  json_integer(json, "threads", (uint64_t)statistics->threads);
  json_text(json, "instruction_set", hl_instruction_set_name(statistics->instruction_set));
  json_integer(json, "voxels_total", statistics->voxels_total);
  json_open_object(json, "frame_ms");
  for (int i = 0; i < SETTING_COUNT; i++)
    json_number(json, bench_settings[i].name, median_ms(&result->run[i], result->frames, WHOLE_FRAME));
  json_close(json);
  json_open_object(json, "processor_ms");
  for (int i = 0; i < SETTING_COUNT; i++)
    json_number(json, bench_settings[i].name, median_ms(&result->run[i], result->frames, PROCESSOR));
  json_close(json);
  json_number(json, "first_prepare_ms", 1e3 * first_measured(result)->first.stage[STAGE_PREPARE]);
  json_open_object(json, "stage_ms");
  for (int i = 0; i < SETTING_COUNT; i++) {
    json_open_object(json, bench_settings[i].name);
    for (int stage = 0; stage < STAGE_COUNT; stage++)
      json_number(json, stage_names[stage], median_ms(&result->run[i], result->frames, stage));
    json_close(json);
  }
  json_close(json);
  json_open_object(json, "work");
  for (int i = 0; i < SETTING_COUNT; i++)
    if (result->run[i].supported) print_work(json, bench_settings[i].name, &result->run[i].statistics);
  json_close(json);
  json_close(json);
}

void bench_print_json(const bench_result *results, size_t count) {
  json_writer json = {0};
  if (count > 1) json_open_array(&json, NULL);
  for (size_t i = 0; i < count; i++) print_result(&json, &results[i]);
  if (count > 1) json_close(&json);
}

static void print_row(const char *name, const bench_result *result, int stage) {
  printf("  %-16s", name);
  for (int i = 0; i < SETTING_COUNT; i++)
    if (result->run[i].supported) printf(" %15.2f", median_ms(&result->run[i], result->frames, stage));
  putchar('\n');
}

static void print_count(const char *name, const bench_result *result,
                        uint64_t (*count)(const hl_render_statistics *)) {
  printf("  %-16s", name);
  for (int i = 0; i < SETTING_COUNT; i++)
    if (result->run[i].supported) printf(" %15" PRIu64, count(&result->run[i].statistics));
  putchar('\n');
}

static uint64_t pixels_image(const hl_render_statistics *s) { return s->pixels_filled_image; }
static uint64_t skipped_image(const hl_render_statistics *s) { return s->pixels_skipped_image; }
static uint64_t pixels_light(const hl_render_statistics *s) { return s->pixels_filled_light; }
static uint64_t skipped_light(const hl_render_statistics *s) { return s->pixels_skipped_light; }
static uint64_t samples(const hl_render_statistics *s) { return s->samples_shaded; }

void bench_print_text(const bench_result *result) {
  const hl_render_statistics *statistics = &first_measured(result)->statistics;
  printf("%s: %dx%d, %d threads, %s, %d frames, moving %s; milliseconds (medians)\n  %-16s", result->input,
         result->width, result->height, statistics->threads,
         hl_instruction_set_name(statistics->instruction_set), result->frames, move_names[result->move], "");
  for (int i = 0; i < SETTING_COUNT; i++)
    if (result->run[i].supported) printf(" %15s", bench_settings[i].name);
  putchar('\n');
  print_row("frame", result, WHOLE_FRAME);
  print_row("processor", result, PROCESSOR);
  for (int stage = 0; stage < STAGE_COUNT; stage++) print_row(stage_names[stage], result, stage);
  print_count("image pixels", result, pixels_image);
  print_count("  skipped", result, skipped_image);
  print_count("light pixels", result, pixels_light);
  print_count("  skipped", result, skipped_light);
  print_count("samples shaded", result, samples);
}
