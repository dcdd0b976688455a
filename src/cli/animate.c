/* cli/animate.c - `halflight animate SCENE`: a film of a scene in which numbers change from frame to frame.
 */
#define _GNU_SOURCE
#include "animate.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "commands.h"
#include "film/movie.h"
#include "frames.h"
#include "input.h"
#include "render.h"

enum {
  ANIMATE_OUTPUT,
  ANIMATE_TURNTABLE,
  ANIMATE_KEY,
  ANIMATE_FRAMES,
  ANIMATE_FPS,
  ANIMATE_SIZE,
  ANIMATE_PART,
  ANIMATE_RANKS,
  ANIMATE_KEEP_FRAMES,
  ANIMATE_NO_METADATA,
  ANIMATE_DATA,
  ANIMATE_MAX_MEMORY,
  ANIMATE_DEVICE,
  ANIMATE_QUIET,
  ANIMATE_OPTION_COUNT
};

#define COUNT_OPTION(word, letters, text)                                                      \
  {                                                                                            \
    .name = (word), .kind = OPTION_NUMBERS, .argument = (letters), .help = (text), .count = 1, \
    .whole = true, .low = 1, .high = 1e6                                                       \
  }

static const cli_option animate_options[ANIMATE_OPTION_COUNT] = {
    [ANIMATE_OUTPUT] = {.name = "output",
                        .letter = 'o',
                        .kind = OPTION_TEXT,
                        .argument = "OUT",
                        .group = "Options",
                        .help = ".mp4, .mov, .mkv, .webm or .gif, or a folder for numbered\n"
                                "pictures (default: SCENE's name with .mp4)"},
    [ANIMATE_TURNTABLE] = COUNT_OPTION("turntable", "N",
                                       "turn once about the picture's vertical axis, in N frames"),
    [ANIMATE_KEY] = {.name = "key",
                     .kind = OPTION_TEXT,
                     .argument = "PATH=FRAME:VALUE,...",
                     .help = "let a number of the scene go from value to value, as\n"
                             "lights.0.intensity=0:1,48:3; camera.azimuth, .elevation,\n"
                             ".roll (degrees) and .zoom (factor) turn the camera; may\n"
                             "be given again",
                     .repeatable = true},
    [ANIMATE_FRAMES] = COUNT_OPTION("frames", "N", "length (default: the turn's, or up to the last FRAME)"),
    [ANIMATE_FPS] = {.name = "fps",
                     .kind = OPTION_NUMBERS,
                     .argument = "N",
                     .help = "frames a second of the film (default: 30)",
                     .count = 1,
                     .low = 0.1,
                     .high = 240},
    [ANIMATE_SIZE] = {.name = "size",
                      .kind = OPTION_NUMBERS,
                      .argument = "WIDTHxHEIGHT",
                      .help = "in pixels (default: the scene's)",
                      .count = 2,
                      .separator = 'x',
                      .whole = true,
                      .low = 1,
                      .high = 16384},
    [ANIMATE_PART] = FRAMES_OPTION_PART("Running",
                                        "render only every N-th frame, from the K-th on: N runs share\n"
                                        "the work; the last one to end joins the film"),
    [ANIMATE_RANKS] = FRAMES_OPTION_RANKS,
    [ANIMATE_KEEP_FRAMES] = {.name = "keep-frames",
                             .kind = OPTION_SWITCH,
                             .help = "leave the pictures beside the film, in its name with\n\"-frames\""},
    [ANIMATE_NO_METADATA] = FRAMES_OPTION_NO_METADATA,
    [ANIMATE_DATA] = HOST_OPTION_DATA(NULL),
    [ANIMATE_MAX_MEMORY] = HOST_OPTION_MAX_MEMORY(NULL),
    [ANIMATE_DEVICE] = HOST_OPTION_DEVICE,
    [ANIMATE_QUIET] = HOST_OPTION_QUIET,
};

/* One run. */
typedef struct animate_job {
  cli_host host;
  const cli_value *values;
  char *input;
  char *output; /* owned; a film, or the folder itself */
  char *folder; /* owned; of the pictures */
  bool film_wanted;
  int part, parts; /* part: from 0 */
  hl_scene *scene; /* owned */
  film *film;      /* owned */
} animate_job;

/* ---- where the film goes ---- */

static bool is_film(const char *path) {
  for (int m = 0; movie_extensions[m] != NULL; m++)
    if (has_extension(path, movie_extensions[m])) return true;
  return false;
}

/* "turn-frames" for "turn.mp4"; of a folder, its own name without a slash at the end. */
static char *name_folder(const char *output, bool film) {
  char *folder = NULL;
  const char *dot = strrchr(output, '.');
  int length = film && dot != NULL ? (int)(dot - output) : (int)strlen(output);
  while (length > 1 && output[length - 1] == '/') length--;
  return asprintf(&folder, "%.*s%s", length, output, film ? "-frames" : "") < 0 ? NULL : folder;
}

static int choose_output(animate_job *job) {
  const cli_value *output = &job->values[ANIMATE_OUTPUT];
  job->output = output->given ? strdup(output->text) : output_default_name(job->input, ".mp4");
  if (job->output == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  job->film_wanted = is_film(job->output);
  const char *dot = strrchr(base_name(job->output), '.');
  if (!job->film_wanted && dot != NULL && dot > base_name(job->output) && dot[1] != '\0')
    return fail(EXIT_CODE_USAGE,
                "--output: '%s' must end in .mp4, .mov, .mkv, .webm or .gif, or be a folder for pictures",
                job->output);
  job->folder = name_folder(job->output, job->film_wanted);
  if (job->folder == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  return job->film_wanted ? output_check(job->output, movie_extensions, &job->input, 1) : EXIT_CODE_OK;
}

static int make_folder(const animate_job *job) {
  struct stat about;
  if (mkdir(job->folder, 0777) == 0 ||
      (errno == EEXIST && stat(job->folder, &about) == 0 && S_ISDIR(about.st_mode)))
    return EXIT_CODE_OK;
  return fail(EXIT_CODE_FAILURE, "%s: no folder for the pictures can be made: %s", job->folder,
              strerror(errno));
}

/* ---- the film's scene ---- */

static int load(animate_job *job) {
  cli_value values[RENDER_OPTION_COUNT] = {{0}};
  char *inputs[] = {job->input, NULL};
  bool bare;
  values[RENDER_MAX_MEMORY] = job->values[ANIMATE_MAX_MEMORY];
  values[RENDER_SIZE] = job->values[ANIMATE_SIZE];
  int exit_code = render_load_inputs(&job->host, values, inputs, &bare, &job->scene);
  return exit_code == EXIT_CODE_OK ? render_change_scene(&job->host, values, bare, &job->scene) : exit_code;
}

static int plan(animate_job *job) {
  const cli_value *values = job->values;
  const bool turns = values[ANIMATE_TURNTABLE].given, frames = values[ANIMATE_FRAMES].given;
  film_options options = {.context = job->host.context,
                          .scene = job->scene,
                          .keys = values[ANIMATE_KEY].texts,
                          .key_count = (size_t)values[ANIMATE_KEY].count,
                          .turntable = turns ? (int)values[ANIMATE_TURNTABLE].number[0] : 0,
                          .frames = frames ? (int)values[ANIMATE_FRAMES].number[0] : 0};
  hl_error error = {0};
  if (!turns && !values[ANIMATE_KEY].given)
    return fail(EXIT_CODE_USAGE, "nothing moves: give --turntable N, or --key PATH=FRAME:VALUE,...");
  hl_status status = film_create(&options, &job->film, &error);
  render_name_scene(job->input, false, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(&job->host, PHASE_CHANGE, status, &error);
}

/* ---- the run ---- */

static int count_digits(int frames) {
  int digits = 4;
  for (int most = 10000; most < frames; most *= 10) digits++;
  return digits;
}

/* Joins the pictures to a film, if all of them are there. */
static int finish(const animate_job *job, const animate_frames *frames) {
  double rate = job->values[ANIMATE_FPS].given ? job->values[ANIMATE_FPS].number[0] : 30;
  const int count = film_frames(job->film);
  if (!job->film_wanted || !movie_available()) {
    if (!job->host.quiet)
      say("%s: %d pictures, %d of them rendered now%s", job->folder, frames->done, frames->rendered,
          job->film_wanted ? "; once ffmpeg is installed, the same command joins them to a film" : "");
    return EXIT_CODE_OK;
  }
  if (job->parts > 1 && !animate_is_complete(frames)) {
    if (!job->host.quiet)
      say("%s: part %d of %d is there; the run that ends last joins the film", job->folder, job->part + 1,
          job->parts);
    return EXIT_CODE_OK;
  }
  int exit_code = animate_join(frames, job->output, rate);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  if (job->parts == 1 && !job->values[ANIMATE_KEEP_FRAMES].given) animate_remove_frames(frames);
  if (!job->host.quiet)
    say("%s: %d frames, %.3g s at %.4g a second; %d of them rendered now", job->output, count, count / rate,
        rate, frames->rendered);
  return EXIT_CODE_OK;
}

static int run_job(animate_job *job) {
  int exit_code = load(job);
  if (exit_code == EXIT_CODE_OK) exit_code = plan(job);
  if (exit_code == EXIT_CODE_OK) exit_code = read_files_protect(&job->host.read, job->output, job->input);
  if (exit_code == EXIT_CODE_OK) exit_code = make_folder(job);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  if (job->film_wanted && !movie_available() && !job->host.quiet)
    warn("ffmpeg is not installed: numbered pictures go to %s instead of a film", job->folder);
  animate_frames frames = {.host = &job->host,
                           .film = job->film,
                           .folder = job->folder,
                           .style = {.opaque = job->film_wanted, /* a film has no transparent pixels */
                                     .no_metadata = job->values[ANIMATE_NO_METADATA].given},
                           .digits = count_digits(film_frames(job->film))};
  job->host.own_bar = true;
  exit_code = animate_render(&frames, job->part, job->parts);
  return exit_code == EXIT_CODE_OK ? finish(job, &frames) : exit_code;
}

static int run_animate(const cli_value *values, char **operands) {
  animate_job job = {.values = values, .input = operands[0]};
  cli_host_options options = {.quiet = values[ANIMATE_QUIET].given,
                              .progress = true,
                              .subject = base_name(job.input),
                              .memory_limit = values[ANIMATE_MAX_MEMORY].bytes,
                              .device = values[ANIMATE_DEVICE].text,
                              .data_folder = values[ANIMATE_DATA].text};
  int exit_code = frames_read_part(&values[ANIMATE_PART], &values[ANIMATE_RANKS], &job.part, &job.parts);
  if (exit_code == EXIT_CODE_OK) exit_code = choose_output(&job);
  if (exit_code == EXIT_CODE_OK) {
    exit_code = host_open(&options, &job.host);
    if (exit_code == EXIT_CODE_OK) exit_code = run_job(&job);
    film_destroy(job.film);
    hl_scene_release(job.scene);
    host_close(&job.host);
  }
  free(job.folder);
  free(job.output);
  return exit_code;
}

const cli_command animate_command = {
    .name = "animate",
    .operands = "SCENE",
    .operand_count = 1,
    .summary = "a film: a turn, or numbers of a scene that change",
    .description =
        "Renders SCENE, a scene (.json), a .png with a scene in it, or a volume file, in frames in which "
        "the\n"
        "camera turns and numbers of the scene change, and joins them to a film by ffmpeg's program; "
        "without\n"
        "it, numbered pictures stay. A run that was stopped goes on where it was: pictures that are there\n"
        "already, made of their frame's scene, are kept.",
    .options = animate_options,
    .option_count = ANIMATE_OPTION_COUNT,
    .run = run_animate,
};
