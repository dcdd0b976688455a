/* cli/bench.c - `halflight bench [INPUT ...]`: times frames of moving scenes, kinds of shadows in turn. */
#define _GNU_SOURCE
#include "bench.h"

#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "commands.h"
#include "input.h"
#include "render.h"

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
                      .help = "measured frames of each kind (default 9)",
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
                    .argument = "WxH",
                    .help = "pixels (default: the scene's)",
                    .count = 2,
                    .separator = 'x',
                    .whole = true,
                    .low = 1,
                    .high = 32768},
    [BENCH_TF] = {.name = "tf",
                  .kind = OPTION_TEXT,
                  .argument = "FILE|PRESET",
                  .help = "transfer function of every volume, as for render"},
    [BENCH_SHEET_SPACING] = {.name = "sheet-spacing",
                             .kind = OPTION_NUMBERS,
                             .argument = "VOXELS",
                             .help = "distance of sheets in smallest voxel edges",
                             .count = 1,
                             .low = 0.01,
                             .high = 100},
    [BENCH_KERNEL] = {.name = "kernel",
                      .kind = OPTION_CHOICE,
                      .choices = kernel_choices,
                      .help = "of each voxel"},
    [BENCH_RECONSTRUCTION] = {.name = "reconstruction",
                              .kind = OPTION_CHOICE,
                              .choices = reconstruction_choices,
                              .help = "push footprints, or pull samples (default: the\nscene's)"},
    [BENCH_THREADS] = {.name = "threads",
                       .kind = OPTION_NUMBERS,
                       .argument = "N",
                       .help = "0: one per processor (default)",
                       .count = 1,
                       .whole = true,
                       .low = 0,
                       .high = 1024},
    [BENCH_INSTRUCTION_SET] = {.name = "instruction-set",
                               .kind = OPTION_CHOICE,
                               .choices = instruction_set_choices,
                               .help = "the best there is, unless given"},
    [BENCH_MAX_MEMORY] =
        {.name = "max-memory",
         .kind = OPTION_BYTES,
         .argument = "BYTES",
         .help = "fail rather than hold more; suffix K, M, G or T\n(default: the machine's memory)"},
    [BENCH_JSON] = {.name = "json", .kind = OPTION_SWITCH, .help = "medians as JSON"},
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

/* Options that bench shares with render, as render's own. */
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
  return render_change_scene(job->host, values, job->bare, &job->scene);
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

/* What all threads have spent: on a busy machine it says more than the clock. */
static double processor_seconds(void) {
  struct timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
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
  sample.stage[STAGE_OTHER] = frame;
  for (int stage = 0; stage < STAGE_OTHER; stage++) sample.stage[STAGE_OTHER] -= sample.stage[stage];
  return sample;
}

/* One frame of one setting; frame -1 is the warm-up. A setting that the renderer does not know is left out
 * from then on. */
static int run_frame(bench_job *job, enum bench_setting setting, int frame) {
  bench_result *result = job->result;
  bench_run *run = &result->run[setting];
  int exit_code = EXIT_CODE_OK;
  hl_scene *scene = bench_scene_at(job->host, job->scene, setting, (enum bench_move)result->move,
                                   (double)(frame + 1) / (result->frames + 1), &exit_code);
  if (scene == NULL) return exit_code;
  hl_error error = {0};
  run->statistics = (hl_render_statistics){.struct_size = sizeof run->statistics};
  double start = clock_seconds(), spent = processor_seconds();
  hl_status status = hl_renderer_render(job->renderer[setting], scene, hl_image_pixels(job->image),
                                        4 * (size_t)result->width, &run->statistics, &error);
  bench_sample sample = sample_of(clock_seconds() - start, &run->statistics);
  sample.processor = processor_seconds() - spent;
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

/* Settings take turns within each frame, so that a machine that slows down slows all of them. */
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

static int run_bench(const cli_value *values, char **operands) {
  cli_host host;
  cli_host_options options = {.quiet = true,
                              .subject = operands[0] != NULL ? operands[0] : "built-in",
                              .memory_limit = values[BENCH_MAX_MEMORY].bytes,
                              .instruction_set = (hl_instruction_set)values[BENCH_INSTRUCTION_SET].choice};
  int exit_code = host_open(&options, &host);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  bench_result results[MAXIMUM_OPERANDS + 1] = {0};
  size_t count = 0;
  do {
    exit_code = measure(&host, values, operands[count], &results[count]);
    host_clear_bar(&host);
    if (exit_code == EXIT_CODE_OK && !values[BENCH_JSON].given) bench_print_text(&results[count]);
    count++;
  } while (exit_code == EXIT_CODE_OK && operands[count] != NULL);
  if (exit_code == EXIT_CODE_OK && values[BENCH_JSON].given) bench_print_json(results, count);
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
        "Times frames of scenes or volumes (without INPUT: of a volume of its own) without shadows,\n"
        "with hard ones and with each kind of soft ones, in turn, after a warm-up. Prints medians in\n"
        "milliseconds, whole and by stage.",
    .options = bench_options,
    .option_count = BENCH_OPTION_COUNT,
    .run = run_bench,
};
