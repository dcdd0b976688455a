/* cli/bench/bench.c - implements `halflight bench [INPUT ...]`, which measures the times of frames of a
 * moving scene with each kind of shadows. */
#define _GNU_SOURCE
#include "bench.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/input.h"
#include "cli/json_writer.h"
#include "cli/render/render.h"

static const cli_choice moves[] = {
    {"camera", MOVE_CAMERA}, {"light", MOVE_LIGHT}, {"tf", MOVE_TF}, {NULL, 0}};

const cli_choice bench_settings[SETTING_COUNT + 1] = {{"off", SETTING_OFF},
                                                      {"hard", SETTING_HARD},
                                                      {"soft_paper", SETTING_PAPER},
                                                      {"soft_cascade", SETTING_CASCADE},
                                                      {"soft_sublights", SETTING_SUBLIGHTS},
                                                      {NULL, 0}};

static const cli_option bench_options[BENCH_OPTION_COUNT] = {
    [BENCH_FRAMES] = {.name = "frames",
                      .kind = OPTION_NUMBERS,
                      .argument = "N",
                      .group = "Options",
                      .help = "number of frames to measure of each kind (default 9)",
                      .count = 1,
                      .whole = true,
                      .low = 1,
                      .high = 10000},
    [BENCH_ONLY] = {.name = "only",
                    .kind = OPTION_CHOICE,
                    .choices = bench_settings,
                    .help = "measure one kind of shadows (default: each in turn)"},
    [BENCH_MOVE] = {.name = "move",
                    .kind = OPTION_CHOICE,
                    .choices = moves,
                    .help = "what changes from frame to frame: the camera turns\n(default), the light turns, "
                            "or opacities change"},
    [BENCH_SIZE] = {.name = "size",
                    .kind = OPTION_NUMBERS,
                    .argument = "WxH|N",
                    .help = "pixels; N: a square (default: the scene's)",
                    .count = 2,
                    .separator = 'x',
                    .even = true,
                    .whole = true,
                    .setting_kind = HL_SETTINGS_IMAGE,
                    .setting = "width"},
    [BENCH_TF] = {.name = "tf",
                  .kind = OPTION_TEXT,
                  .argument = "FILE|PRESET",
                  .help = "transfer function of every volume, as in render"},
    [BENCH_SHEET_SPACING] = {.name = "sheet-spacing",
                             .kind = OPTION_NUMBERS,
                             .argument = "VOXELS",
                             .help = "distance of sheets in smallest voxel edges (default:\nthe scene's)",
                             .count = 1,
                             .setting_kind = HL_SETTINGS_RENDER,
                             .setting = "sheet_spacing"},
    [BENCH_KERNEL] = {.name = "kernel",
                      .kind = OPTION_CHOICE,
                      .help = "how values between voxels are found (default: the\nscene's)",
                      .setting_kind = HL_SETTINGS_RENDER,
                      .setting = "kernel"},
    [BENCH_RECONSTRUCTION] = {.name = "reconstruction",
                              .kind = OPTION_CHOICE,
                              .help = "push footprints, or pull samples (default: the\nscene's)",
                              .setting_kind = HL_SETTINGS_RENDER,
                              .setting = "reconstruction"},
    [BENCH_THREADS] = HOST_OPTION_THREADS(NULL),
    [BENCH_INSTRUCTION_SET] =
        {.name = "instruction-set",
         .kind = OPTION_CHOICE,
         .choices = instruction_set_choices,
         .help = "any gives the same picture (default: the fastest that\nthe processor has)"},
    [BENCH_DEVICE] = HOST_OPTION_DEVICE,
    [BENCH_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY(NULL),
    [BENCH_JSON] = {.name = "json", .kind = OPTION_SWITCH, .help = "print the medians as JSON"},
};

/* One input being measured. */
typedef struct bench_job {
  cli_host *host;
  const cli_value *values;
  hl_scene *scene; /* owned */
  bool bare;
  hl_renderer *renderer[SETTING_COUNT]; /* owned */
  hl_image *image;                      /* owned; the frame */
  bench_result *result;
} bench_job;

/* Applies the options that `bench` shares with `render`, by the function that `render` uses. */
static int change_scene(bench_job *job) {
  static const struct {
    enum bench_option from;
    enum render_option to;
  } shared[] = {{BENCH_SIZE, RENDER_SIZE},
                {BENCH_TF, RENDER_TF},
                {BENCH_SHEET_SPACING, RENDER_SHEET_SPACING},
                {BENCH_KERNEL, RENDER_KERNEL},
                {BENCH_THREADS, RENDER_THREADS},
                {BENCH_RECONSTRUCTION, RENDER_RECONSTRUCTION}};
  cli_value values[RENDER_OPTION_COUNT] = {0};
  for (size_t i = 0; i < sizeof shared / sizeof shared[0]; i++)
    values[shared[i].to] = job->values[shared[i].from];
  return render_change_scene(job->host, values, job->bare, 0, &job->scene);
}

static int load(bench_job *job, const char *path) {
  hl_error error = {0};
  hl_status status = HL_OK;
  int exit_code = EXIT_CODE_OK;
  job->bare = path == NULL;
  if (path == NULL) {
    status = bench_scene_built_in(job->host->context, &job->scene, &error);
  } else {
    cli_input input = {0};
    exit_code = input_open(path, job->values[BENCH_MAX_MEMORY].bytes, &input);
    job->bare = input.kind == INPUT_VOLUME;
    if (exit_code == EXIT_CODE_OK) status = input_load(job->host->context, &input, NULL, &job->scene, &error);
    input_close(&input);
  }
  if (status != HL_OK) return host_fail(job->host, PHASE_READ, status, &error);
  return exit_code == EXIT_CODE_OK ? change_scene(job) : exit_code;
}

static int open_renderers(bench_job *job) {
  const hl_scene_description *description = hl_scene_describe(job->scene);
  bench_result *result = job->result;
  result->width = description->width;
  result->height = description->height;
  result->frames = job->values[BENCH_FRAMES].given ? (int)job->values[BENCH_FRAMES].number[0] : 9;
  result->move = job->values[BENCH_MOVE].given ? job->values[BENCH_MOVE].choice : MOVE_CAMERA;
  hl_error error = {0};
  hl_status made = hl_image_create(job->host->context, result->width, result->height, &job->image, &error);
  if (made != HL_OK) return host_fail(job->host, PHASE_RUN, made, &error);
  for (int setting = 0; setting < SETTING_COUNT; setting++) {
    result->run[setting].supported = !job->values[BENCH_ONLY].given ||
                                     job->values[BENCH_ONLY].choice == setting;
    result->run[setting].samples = calloc((size_t)result->frames, sizeof(bench_sample));
    if (result->run[setting].samples == NULL)
      return fail(EXIT_CODE_FAILURE, "out of memory for %d frames", result->frames);
    hl_status status = hl_renderer_create(job->host->context, &job->renderer[setting], &error);
    if (status != HL_OK) return host_fail(job->host, PHASE_RUN, status, &error);
  }
  return EXIT_CODE_OK;
}

static bench_sample sample_of(double frame, const hl_render_statistics *statistics) {
  bench_sample sample = {.frame = frame};
  sample.stage[STAGE_PREPARE] = statistics->seconds_prepare;
  sample.stage[STAGE_SORT] = statistics->seconds_sort;
  sample.stage[STAGE_SPLAT_EYE] = statistics->seconds_fill_image;
  sample.stage[STAGE_SPLAT_LIGHT] = statistics->seconds_fill_light - statistics->seconds_composite_light;
  sample.stage[STAGE_SHADE] = statistics->seconds_shade;
  sample.stage[STAGE_COMPOSITE_LIGHT] = statistics->seconds_composite_light;
  sample.stage[STAGE_SOFTEN] = statistics->seconds_soften;
  sample.stage[STAGE_DEVICE] = statistics->seconds_device;
  sample.stage[STAGE_OTHER] = frame;
  for (int stage = 0; stage < STAGE_OTHER; stage++) sample.stage[STAGE_OTHER] -= sample.stage[stage];
  return sample;
}

/* Renders one frame of one setting; frame -1 is a warm-up, which is not measured. If sub-lights turn out not
 * to be supported, their setting is left out from then on. */
static int run_frame(bench_job *job, enum bench_setting setting, int frame) {
  bench_result *result = job->result;
  bench_run *run = &result->run[setting];
  int exit_code = EXIT_CODE_OK;
  hl_scene *scene = bench_scene_at(job->host, job->scene, setting, (enum bench_move)result->move,
                                   (double)(frame + 1) / (result->frames + 1), &exit_code);
  if (scene == NULL) return exit_code;
  hl_error error = {0};
  run->statistics = (hl_render_statistics){.struct_size = sizeof run->statistics};
  double start = hl_clock_seconds(), spent = hl_processor_seconds();
  hl_status status = hl_renderer_render(job->renderer[setting], scene, hl_image_pixels(job->image),
                                        4 * (size_t)result->width, &run->statistics, &error);
  bench_sample sample = sample_of(hl_clock_seconds() - start, &run->statistics);
  sample.processor = hl_processor_seconds() - spent;
  hl_scene_release(scene);
  if (status == HL_ERROR_UNSUPPORTED && setting == SETTING_SUBLIGHTS) {
    run->supported = false;
    return EXIT_CODE_OK;
  }
  if (status != HL_OK) return host_fail(job->host, PHASE_RUN, status, &error);
  if (frame < 0) run->first = sample;
  else run->samples[frame] = sample;
  return EXIT_CODE_OK;
}

/* Runs all frames. In each frame the settings take turns, so that a machine that becomes slower affects all
 * settings alike. */
static int run_frames(bench_job *job) {
  for (int frame = -1; frame < job->result->frames; frame++)
    for (int setting = 0; setting < SETTING_COUNT; setting++) {
      if (!job->result->run[setting].supported) continue;
      int exit_code = run_frame(job, (enum bench_setting)setting, frame);
      if (exit_code != EXIT_CODE_OK) return exit_code;
    }
  return EXIT_CODE_OK;
}

static int measure(cli_host *host, const cli_value *values, const char *path, bench_result *result) {
  bench_job job = {.host = host, .values = values, .result = result};
  result->input = path == NULL ? "built-in" : path;
  int exit_code = load(&job, path);
  if (exit_code == EXIT_CODE_OK) exit_code = open_renderers(&job);
  if (exit_code == EXIT_CODE_OK) exit_code = run_frames(&job);
  for (int setting = 0; setting < SETTING_COUNT; setting++) hl_renderer_destroy(job.renderer[setting]);
  hl_scene_release(job.scene);
  hl_image_destroy(job.image);
  return exit_code;
}

/* ---- the report: medians of the measured frames, as JSON and as a table ---- */

static const char *const move_names[] = {"camera", "light", "tf"};
static const char *const stage_names[STAGE_COUNT] = {
    "prepare", "sort", "splat_eye", "splat_light", "shade", "composite_light", "soften", "device", "other"};

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

enum { WHOLE_FRAME = -1, PROCESSOR = -2 };

static double seconds_of(const bench_sample *sample, int stage) {
  return stage == WHOLE_FRAME ? sample->frame : stage == PROCESSOR ? sample->processor : sample->stage[stage];
}

/* The first kind of shadows that was measured. The counts of voxels and threads are reported from it, because
 * they are the same for every kind. */
static const bench_run *first_measured(const bench_result *result) {
  int setting = 0;
  while (setting < SETTING_COUNT - 1 && !result->run[setting].supported) setting++;
  return &result->run[setting];
}

/* The milliseconds of one stage. stage: a stage, WHOLE_FRAME or PROCESSOR. The result is NAN if the setting
 * is not supported. */
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
  json_whole_number(json, "filled", filled);
  json_whole_number(json, "skipped", skipped);
  json_close(json);
}

/* Prints the numbers of the last frame's work. */
static void print_work(json_writer *json, const char *key, const hl_render_statistics *s) {
  json_open_object(json, key);
  json_text(json, "device", s->device);
  if (s->device_reason[0] != '\0') json_text(json, "device_reason", s->device_reason);
  json_whole_number(json, "launches", (uint64_t)s->device_launches);
  json_whole_number(json, "sheets", (uint64_t)s->sheets);
  json_whole_number(json, "voxels_kept", s->voxels_kept);
  json_whole_number(json, "samples_shaded", s->samples_shaded);
  json_whole_number(json, "waits", s->waits);
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
  json_whole_number(json, "width", (uint64_t)result->width);
  json_whole_number(json, "height", (uint64_t)result->height);
  json_whole_number(json, "frames", (uint64_t)result->frames);
  json_text(json, "move", move_names[result->move]);
  json_whole_number(json, "threads", (uint64_t)statistics->threads);
  json_text(json, "instruction_set", hl_instruction_set_name(statistics->instruction_set));
  json_whole_number(json, "voxels_total", statistics->voxels_total);
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

static void print_json(const bench_result *results, size_t count) {
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
static uint64_t waits(const hl_render_statistics *s) { return s->waits; }

static void print_text(const bench_result *result) {
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
  print_count("waits", result, waits);
}

/* ---- the command ---- */

static int run_bench(const cli_value *values, char **operands) {
  cli_host host;
  cli_host_options options = {.quiet = true,
                              .subject = operands[0] != NULL ? operands[0] : "built-in",
                              .memory_limit = values[BENCH_MAX_MEMORY].bytes,
                              .device = values[BENCH_DEVICE].text,
                              .instruction_set = (hl_instruction_set)values[BENCH_INSTRUCTION_SET].choice,
                              .operands = operands};
  int exit_code = host_open(&options, &host);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  bench_result results[MAXIMUM_OPERANDS + 1] = {0};
  size_t count = 0;
  do {
    exit_code = measure(&host, values, operands[count], &results[count]);
    host_clear_bar(&host);
    if (exit_code == EXIT_CODE_OK && !values[BENCH_JSON].given) print_text(&results[count]);
    count++;
  } while (exit_code == EXIT_CODE_OK && operands[count] != NULL);
  if (exit_code == EXIT_CODE_OK && values[BENCH_JSON].given) print_json(results, count);
  if (exit_code == EXIT_CODE_OK) exit_code = finish_stdout();
  for (size_t i = 0; i < count; i++)
    for (int setting = 0; setting < SETTING_COUNT; setting++) free(results[i].run[setting].samples);
  host_close(&host);
  return exit_code;
}

const cli_command bench_command = {
    .name = "bench",
    .operands = "[INPUT ...]",
    .operand_count = 0,
    .operand_most = MAXIMUM_OPERANDS,
    .summary = "time frames without, with hard and with soft shadows",
    .description =
        "Times the frames of scenes or volumes; without INPUT, of a volume that it makes. After a warm-up,\n"
        "frames without shadows, with hard shadows and with each kind of soft shadows take turns. Prints "
        "the\n"
        "median of each kind in milliseconds, for whole frames and for each of their stages.",
    .options = bench_options,
    .option_count = BENCH_OPTION_COUNT,
    .run = run_bench,
};
