/* cli/render/render.c - implements `halflight render INPUT`: loads a scene, changes it by the options,
 * renders it, writes the picture and reports. */
#define _GNU_SOURCE
#include "render.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands.h"
#include "cli/input.h"
#include "cli/output.h"
#include "cli/ranks.h"

/* The state of one run, from INPUT to OUT. */
typedef struct render_job {
  cli_host host;
  cli_value values[RENDER_OPTION_COUNT]; /* --size is set by --width */
  char size_text[RENDER_SIZE_TEXT];      /* text for the option --size */
  struct {
    char **all; /* [count], null after the last */
    int count;
    char *first;
    bool bare; /* whether the input is a volume file */
  } input;
  char *output;         /* owned */
  bool to_stdout;       /* OUT is "-" */
  hl_scene *scene;      /* owned */
  hl_image *image;      /* owned */
  render_layers layers; /* owned */
  cli_overlay overlay;  /* owned */
  hl_ranks *ranks;      /* owned; the ranks of --strips-over-ranks and --volume-over-ranks; null if this
                         * process is alone */
  double started;       /* seconds of hl_clock_seconds() */
  render_result result;
} render_job;

static const char *const format_names[] = {"png", "exr", "npy", "tif", "pdf", "svg"};

/* The extension that --format asks for; .png if --format is not given. */
static const char *wanted_extension(const cli_value *values) {
  static const char *const extensions[] = {".png", ".exr", ".npy", ".tif", ".pdf", ".svg"};
  return extensions[values[RENDER_FORMAT].given ? values[RENDER_FORMAT].choice : 0];
}

/* The name from which the picture's default name is made: INPUT, or "stdin" or "pipe" if INPUT is a pipe. */
static const char *nameable(const char *input) {
  if (strcmp(input, "-") == 0) return "stdin";
  return strncmp(input, "/dev/fd/", 8) == 0 ? "pipe" : input;
}

/* Returns whether the command only prints a text, and makes no picture. */
static bool prints_text(const cli_value *values) {
  return values[RENDER_PRINT_SCENE].given || values[RENDER_PRINT_PLAN].given;
}

/* The default name of the picture: INPUT's name with the format's extension; if INPUT itself is NAME.png,
 * "NAME-again.png". */
static char *default_output(const render_job *job) {
  const char *extension = wanted_extension(job->values);
  bool again = has_extension(job->input.first, ".png") && strcmp(extension, ".png") == 0;
  return output_default_name(nameable(job->input.first), again ? "-again.png" : extension);
}

/* The picture's name by --output, in which %s is INPUT's name. Null if memory is short. */
static char *named_output(const render_job *job) {
  const char *output = job->values[RENDER_OUTPUT].text;
  return output_has_name(output) ? output_name_picture(output, nameable(job->input.first)) : strdup(output);
}

/* Chooses the picture's path: the path of --output, or a name that is made from INPUT. */
static int choose_output(render_job *job) {
  const cli_value *values = job->values, *output = &values[RENDER_OUTPUT];
  job->to_stdout = output->given && strcmp(output->text, "-") == 0;
  job->output = output->given ? named_output(job) : default_output(job);
  if (job->output == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  if (prints_text(values)) return EXIT_CODE_OK;
  if (job->to_stdout && isatty(STDOUT_FILENO))
    return fail(EXIT_CODE_USAGE,
                "--output: standard output is a terminal, which shows no picture: redirect it");
  if (job->to_stdout && values[RENDER_JSON].given)
    return fail(EXIT_CODE_USAGE,
                "--json: standard output is the picture's: give --output a name, or leave --json out");
  if (job->to_stdout) return EXIT_CODE_OK;
  if (values[RENDER_FORMAT].given && !has_extension(job->output, wanted_extension(values)))
    return fail(EXIT_CODE_USAGE, "--format %s: '%s' does not end in %s: rename OUT, or leave --format out",
                values[RENDER_FORMAT].text, job->output, wanted_extension(values));
  if (output->given && output_has_name(output->text)) {
    int exit_code = output_make_folder_of(job->output);
    if (exit_code != EXIT_CODE_OK) return exit_code;
  }
  return output_check(job->output, figure_extensions, job->input.all, job->input.count);
}

static int job_open(render_job *job) {
  const cli_value *values = job->values;
  int exit_code = render_check_options(values);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  cli_host_options options = {.quiet = values[RENDER_QUIET].given,
                              .progress = true,
                              .subject = base_name(job->input.first),
                              .memory_limit = values[RENDER_MAX_MEMORY].bytes,
                              .data_folder = values[RENDER_DATA].text,
                              .device = values[RENDER_DEVICE].text,
                              .instruction_set = (hl_instruction_set)values[RENDER_INSTRUCTION_SET].choice,
                              .mpi = launcher_mpi(),
                              .operands = job->input.all};
  exit_code = host_open(&options, &job->host);
  int over_ranks = values[RENDER_VOLUME].given ? RENDER_VOLUME : RENDER_STRIPS;
  if (exit_code == EXIT_CODE_OK && values[over_ranks].given)
    exit_code = ranks_begin(&job->host, render_options[over_ranks].name, &job->ranks);
  if (exit_code == EXIT_CODE_OK && values[RENDER_VOLUME].given) hl_ranks_hold_volumes(job->ranks);
  /* These steps may fail on one machine alone. They come after the ranks have joined, because the other ranks
   * would wait for a rank that never joins. */
  if (exit_code == EXIT_CODE_OK) exit_code = choose_output(job);
  if (exit_code == EXIT_CODE_OK) exit_code = render_overlay_read(values, &job->overlay);
  return exit_code;
}

/* Refuses to write over a file that the scene needs. */
static int protect_what_was_read(const render_job *job) {
  if (job->to_stdout || prints_text(job->values)) return EXIT_CODE_OK;
  int exit_code = read_files_protect(&job->host.read, job->output, job->input.first);
  if (exit_code != EXIT_CODE_OK || !job->values[RENDER_LAYERS].given) return exit_code;
  return render_layers_protect(&job->host, job->output, hl_scene_describe(job->scene)->light_count,
                               job->input.first);
}

static int job_load(render_job *job) {
  render_overlay_set_size(job->values, NULL, job->size_text);
  job->host.preview_pixels = render_first_pixels(job->values);
  int exit_code = render_load_inputs(&job->host, job->values, job->input.all, &job->input.bare, &job->scene);
  if (exit_code == EXIT_CODE_OK) render_overlay_set_size(job->values, job->scene, job->size_text);
  if (exit_code == EXIT_CODE_OK)
    exit_code = render_change_scene(&job->host, job->values, job->input.bare, 0, &job->scene);
  if (exit_code == EXIT_CODE_OK)
    exit_code = render_go_nearer(&job->host, &hl_scene_describe(job->scene)->camera, 1, &job->scene);
  if (exit_code == EXIT_CODE_OK) exit_code = protect_what_was_read(job);
  hl_error error = {0};
  hl_status status = exit_code == EXIT_CODE_OK && !prints_text(job->values)
                         ? overlay_check_scene(job->host.context, &job->overlay, job->scene, &error)
                         : HL_OK;
  if (status != HL_OK) exit_code = host_fail(&job->host, PHASE_CHANGE, status, &error);
  job->result.seconds.load = hl_clock_seconds() - job->started;
  return exit_code;
}

static uint64_t count_voxels(const hl_scene_description *description) {
  uint64_t voxels = 0;
  for (size_t i = 0; i < description->volume_count; i++) {
    hl_volume_info info = {.struct_size = sizeof info};
    if (hl_volume_get_info(description->volumes[i].volume, &info) == HL_OK)
      voxels += (uint64_t)info.dimensions[0] * info.dimensions[1] * info.dimensions[2];
  }
  return voxels;
}

/* The layers to render; null if there are none. */
static const hl_layers *wanted_layers(const render_job *job) {
  return job->values[RENDER_LAYERS].given ? &job->layers.all : NULL;
}

hl_reference_options render_reference_options(const cli_value *values,
                                              const hl_scene_description *description) {
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  if (values[RENDER_PATHS].given) options.paths = (int)values[RENDER_PATHS].number[0];
  if (values[RENDER_LIGHT_POINTS].given) options.light_points = (int)values[RENDER_LIGHT_POINTS].number[0];
  if (values[RENDER_STEP].given) options.step = values[RENDER_STEP].number[0];
  options.threads = description->render.threads;
  options.rays = values[RENDER_RAYS].given ? (int)values[RENDER_RAYS].number[0] : 0;
  return options;
}

static hl_status render_reference(render_job *job, const hl_scene_description *description, hl_error *error) {
  const cli_value *values = job->values;
  hl_render_statistics *statistics = &job->result.statistics;
  const hl_reference_options options = render_reference_options(values, description);
  job->host.stage.hint =
      "--reference marches every ray: a smaller --size, fewer --light-points or a greater --step "
      "is faster";
  double started = hl_clock_seconds();
  hl_status status = hl_reference_render_layers(job->host.context, job->scene, &options,
                                                hl_image_pixels(job->image), 4 * (size_t)description->width,
                                                wanted_layers(job), error);
  statistics->seconds_render = hl_clock_seconds() - started;
  statistics->threads = options.threads > 0 ? options.threads : (int)sysconf(_SC_NPROCESSORS_ONLN);
  statistics->instruction_set = HL_INSTRUCTION_SET_SCALAR;
  snprintf(statistics->device, sizeof statistics->device, "cpu");
  statistics->voxels_total = statistics->voxels_kept = count_voxels(description);
  return status;
}

static hl_status render_sheets(render_job *job, const hl_scene_description *description, hl_error *error) {
  hl_renderer *renderer = NULL;
  hl_status status = hl_renderer_create(job->host.context, &renderer, error);
  if (status == HL_OK) status = hl_renderer_share_over_ranks(renderer, job->ranks, error);
  if (status == HL_OK)
    status = hl_renderer_render_layers(renderer, job->scene, hl_image_pixels(job->image),
                                       4 * (size_t)description->width, wanted_layers(job),
                                       &job->result.statistics, error);
  hl_renderer_destroy(renderer);
  return status;
}

static int job_render(render_job *job) {
  const hl_scene_description *description = hl_scene_describe(job->scene);
  hl_error error = {0};
  job->result.statistics.struct_size = sizeof job->result.statistics;
  int exit_code = ranks_compare(&job->host, job->ranks, job->scene);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  hl_status status = hl_image_create(job->host.context, description->width, description->height, &job->image,
                                     &error);
  if (status == HL_OK && job->values[RENDER_LAYERS].given)
    status = render_layers_create(job->image, description, &job->layers, &error);
  if (status == HL_OK)
    status = job->result.reference ? render_reference(job, description, &error)
                                   : render_sheets(job, description, &error);
  job->result.description = description;
  job->result.ranks = job->ranks;
  job->result.seconds.prepare = job->result.statistics.seconds_prepare;
  job->result.seconds.render = job->result.statistics.seconds_render;
  render_name_scene(job->input.first, job->input.bare, &error);
  if (status != HL_OK) return host_fail(&job->host, PHASE_RUN, status, &error);
  hl_ranks_sum(job->ranks, hl_image_pixels(job->image),
               4 * (size_t)description->width * (size_t)description->height);
  if (job->ranks != NULL)
    status = hl_scene_show_sky(job->scene, hl_image_pixels(job->image), 4 * (size_t)description->width,
                               &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(&job->host, PHASE_RUN, status, &error);
}

static hl_status write_to_stdout(render_job *job, hl_image_write_options *options, int *exit_code,
                                 hl_error *error) {
  unsigned char *bytes = NULL;
  size_t length = 0;
  const char *format = format_names[job->values[RENDER_FORMAT].given ? job->values[RENDER_FORMAT].choice : 0];
  hl_status status = overlay_encode(job->host.context, &job->overlay, job->image, job->scene, format, options,
                                    &bytes, &length, error);
  host_clear_bar(&job->host);
  if (status == HL_OK) *exit_code = output_to_stdout(bytes, length);
  hl_bytes_release(job->host.context, bytes);
  return status;
}

static hl_status describe_frame(const render_job *job, char **text, hl_error *error) {
  hl_renderer *renderer = NULL;
  hl_status status = hl_renderer_create(job->host.context, &renderer, error);
  if (status == HL_OK) status = hl_renderer_plan(renderer, job->scene, text, error);
  hl_renderer_destroy(renderer);
  return status;
}

/* Does the work of --print-scene and --print-plan: prints the scene that would be rendered, or the plan of
 * its frame. */
static int job_print(render_job *job) {
  char *text = NULL;
  hl_error error = {0};
  hl_status status = job->values[RENDER_PRINT_PLAN].given
                         ? describe_frame(job, &text, &error)
                         : hl_scene_to_json(job->host.context, job->scene, &text, &error);
  if (status != HL_OK) return host_fail(&job->host, PHASE_RUN, status, &error);
  host_clear_bar(&job->host);
  int exit_code = output_to_stdout((const unsigned char *)text, strlen(text));
  hl_text_release(job->host.context, text);
  return exit_code;
}

static int job_write(render_job *job) {
  double started = hl_clock_seconds();
  hl_error error = {0};
  char *scene_json = NULL;
  int exit_code = EXIT_CODE_OK;
  hl_status status = host_interrupted() ? HL_ERROR_CANCELLED : HL_OK;
  if (status == HL_OK && !job->values[RENDER_NO_METADATA].given)
    status = job->to_stdout
                 ? hl_scene_to_json(job->host.context, job->scene, &scene_json, &error)
                 : output_scene_text(job->host.context, job->scene, job->output, &scene_json, &error);
  if (status == HL_OK) {
    hl_image_write_options options;
    hl_scene_write_options(job->scene, &options);
    job->result.field_errors = options.field_errors;
    if (job->values[RENDER_DEPTH].given) options.png_depth = job->values[RENDER_DEPTH].choice;
    options.scene_json = scene_json;
    status = job->to_stdout ? write_to_stdout(job, &options, &exit_code, &error)
                            : overlay_write(job->host.context, &job->overlay, job->image, job->scene,
                                            job->output, &options, &error);
  }
  hl_text_release(job->host.context, scene_json);
  job->result.seconds.write = hl_clock_seconds() - started;
  return status == HL_OK ? exit_code : host_fail(&job->host, PHASE_RUN, status, &error);
}

/* Finds, for the report, the kind of data for which a bare volume was taken, and the look that a user may try
 * next. Only volumes whose transfer function was chosen by their kind have such a report. */
static void find_choice(render_job *job) {
  const hl_scene_description *description = job->result.description;
  bool wanted = job->values[RENDER_JSON].given || (!job->host.quiet && isatty(STDERR_FILENO));
  if (!job->input.bare || description->volume_count == 0 || job->values[RENDER_TF].given ||
      render_is_label_map(job->values) || render_is_projection(job->values) || !wanted)
    return;
  const hl_volume *volume = description->volumes[0].volume;
  if (hl_volume_guess(volume, job->input.first, &job->result.taken_for, NULL) != HL_OK)
    job->result.taken_for = NULL;
  if (hl_volume_next_look(volume, job->input.first, &job->result.next_look, NULL) != HL_OK ||
      job->values[RENDER_LOOK].given)
    job->result.next_look = NULL;
}

static int job_report(render_job *job) {
  host_clear_bar(&job->host);
  job->result.output = job->to_stdout ? "standard output" : job->output;
  job->result.seconds.total = hl_clock_seconds() - job->started;
  find_choice(job);
  if (job->values[RENDER_JSON].given) return render_print_json(&job->result);
  if (!job->host.quiet) render_print_summary(&job->result);
  return EXIT_CODE_OK;
}

static void job_close(render_job *job, int exit_code) {
  ranks_check(job->ranks, exit_code);
  overlay_release(&job->overlay);
  render_layers_release(&job->layers);
  hl_image_destroy(job->image);
  hl_scene_release(job->scene);
  hl_ranks_leave(job->ranks);
  host_close(&job->host);
  free(job->output);
}

static int render_one(const cli_value *values, char **operands) {
  if (values[RENDER_VIEWS].given && !render_is_series(values, operands))
    return render_views(values, operands);
  if (render_is_series(values, operands)) {
    if (!values[RENDER_STRIPS].given && !values[RENDER_VOLUME].given)
      return render_series(values, operands, NULL, NULL);
    return fail(EXIT_CODE_USAGE,
                "--%s shares one picture between processes: --frames-over-ranks shares out several pictures",
                render_options[values[RENDER_STRIPS].given ? RENDER_STRIPS : RENDER_VOLUME].name);
  }
  render_job job = {.input = {.all = operands, .first = operands[0]}, .started = hl_clock_seconds()};
  memcpy(job.values, values, sizeof job.values);
  while (operands[job.input.count] != NULL) job.input.count++;
  job.result.input = job.input.first;
  job.result.reference = values[RENDER_REFERENCE].given;
  int exit_code = job_open(&job);
  if (exit_code == EXIT_CODE_OK) exit_code = job_load(&job);
  bool picture = !prints_text(values);
  if (exit_code == EXIT_CODE_OK && !picture) exit_code = job_print(&job);
  if (exit_code == EXIT_CODE_OK && picture) exit_code = job_render(&job);
  picture = picture && hl_ranks_rank(job.ranks) == 0;
  if (exit_code == EXIT_CODE_OK && picture) exit_code = job_write(&job);
  if (exit_code == EXIT_CODE_OK && picture) exit_code = job_report(&job);
  job_close(&job, exit_code);
  return exit_code;
}

static int run_with_pattern(const cli_value *values, char **operands) {
  if (render_are_scenes(operands)) return render_scenes(values, operands, render_one);
  return render_one(values, operands);
}

/* An OUT that names a folder becomes "OUT/%s.png". */
static int run_render(const cli_value *values, char **operands) {
  const cli_value *output = &values[RENDER_OUTPUT];
  if (!output->given || !output_is_folder(output->text)) return run_with_pattern(values, operands);
  cli_value *own = malloc(RENDER_OPTION_COUNT * sizeof *own);
  char *pattern = output_pattern(output->text, wanted_extension(values));
  int exit_code = EXIT_CODE_FAILURE;
  if (own != NULL && pattern != NULL) {
    memcpy(own, values, RENDER_OPTION_COUNT * sizeof *own);
    own[RENDER_OUTPUT].text = pattern;
    exit_code = run_with_pattern(own, operands);
  } else {
    fail(exit_code, "out of memory");
  }
  free(pattern);
  free(own);
  return exit_code;
}

const cli_command render_command = {
    .name = "render",
    .operands = "INPUT ...",
    .operand_count = 1,
    .operand_most = MAXIMUM_OPERANDS,
    .summary = "render a scene (.json) or volume files to a picture",
    .description =
        "Renders INPUT, a scene (.json), a .png with a scene in it, or volume files (NRRD, MetaImage,\n"
        "NIfTI, VTK, NumPy, MRC, TIFF, raw), together where there are several; '-' is standard input.\n"
        "Meshes (PLY, STL, OBJ, glTF, VTK PolyData) are added to them, or are the picture alone.\n"
        "A volume needs no options: the camera frames it, the transfer function comes from its\n"
        "histogram, and a key light from the upper left casts soft shadows. Options override\n"
        "what the scene says; a default holds where neither says anything.",
    .options = render_options,
    .option_count = RENDER_OPTION_COUNT,
    .run = run_render,
};
