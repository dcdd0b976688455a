/* cli/animate/animate.c - implements `halflight animate INPUT`, which makes a film of a scene in which
 * numbers change from frame to frame. */
#define _GNU_SOURCE
#include "animate.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/commands.h"
#include "cli/frames.h"
#include "cli/input.h"
#include "cli/render/render.h"
#include "film/movie.h"

enum {
  ANIMATE_OUTPUT,
  ANIMATE_PRESET,
  ANIMATE_TURNTABLE,
  ANIMATE_KEY,
  ANIMATE_EASE,
  ANIMATE_FRAMES,
  ANIMATE_FPS,
  ANIMATE_KEEP_FRAMES,
  ANIMATE_OPTION_COUNT
};

#define COUNT_OPTION(word, letters, text)                                                      \
  {                                                                                            \
    .name = (word), .kind = OPTION_NUMBERS, .argument = (letters), .help = (text), .count = 1, \
    .whole = true, .low = 1, .high = 1e6                                                       \
  }

enum { PRESET_TURNTABLE, PRESET_LIGHT_SWEEP };
static const cli_choice presets[] = {
    {"turntable", PRESET_TURNTABLE}, {"light-sweep", PRESET_LIGHT_SWEEP}, {NULL, 0}};
static const cli_choice easings[] = {{"linear", 0}, {"smooth", 1}, {NULL, 0}};

static const cli_option animate_options[ANIMATE_OPTION_COUNT] = {
    [ANIMATE_OUTPUT] = {.name = "output",
                        .letter = 'o',
                        .kind = OPTION_TEXT,
                        .argument = "OUT",
                        .group = "Options",
                        .help = ".mp4, .mov, .mkv, .webm or .gif, or a folder for numbered\n"
                                "pictures (default: INPUT's name with .mp4)"},
    [ANIMATE_PRESET] = {.name = "preset",
                        .kind = OPTION_CHOICE,
                        .choices = presets,
                        .help =
                            "turntable: the camera turns once, as by --turntable;\nlight-sweep: the first "
                            "light goes from left "
                            "to right\nand back, in two seconds"},
    [ANIMATE_TURNTABLE] = {.name = "turntable",
                           .kind = OPTION_NUMBERS,
                           .argument = "[N]",
                           .help =
                               "turn once about the picture's vertical axis, in N frames\n(default: in four "
                               "seconds, or over all files of a pattern)",
                           .count = 1,
                           .optional = true,
                           .whole = true,
                           .low = 1,
                           .high = 1e6},
    [ANIMATE_KEY] = {.name = "key",
                     .kind = OPTION_TEXT,
                     .argument = "PATH=FRAME:VALUE,...",
                     .help = "change a number of the scene from frame to frame:\n"
                             "lights.0.intensity=0:1,48:3 goes from 1 in frame 0 to\n"
                             "3 in frame 48, 0s:1,2s:3 in two seconds.\n"
                             "camera.azimuth, .elevation, .roll (degrees) and\n"
                             ".zoom (factor) turn the camera;\n"
                             "lights.0.azimuth and .elevation turn a light, as --light\n"
                             "does. Settings that are colours go from colour to colour:\n"
                             "lights.0.color=0:orange,48:#2060ff, points go straight\n"
                             "and directions turn the shortest way:\n"
                             "lights.0.direction=0:-1,0,0,48:0,0,-1. With several files\n"
                             "FRAME is the number of a file, from 0. May be given again",
                     .repeatable = true},
    [ANIMATE_EASE] =
        {.name = "ease",
         .kind = OPTION_CHOICE,
         .choices = easings,
         .help = "how --key goes from value to value (default linear);\nsmooth: it starts and ends slowly"},
    [ANIMATE_FRAMES] = COUNT_OPTION(
        "frames", "N", "number of frames (default: those of the turn, or up to\nthe last FRAME of --key)"),
    [ANIMATE_FPS] = {.name = "fps",
                     .kind = OPTION_NUMBERS,
                     .argument = "N",
                     .help = "frames a second of the film (default: 30)",
                     .count = 1,
                     .low = 0.1,
                     .high = 240},
    [ANIMATE_KEEP_FRAMES] =
        {.name = "keep-frames",
         .kind = OPTION_SWITCH,
         .help = "keep the pictures, in a folder beside the film, named\nlike it with \"-frames\""},
};

/* Returns whether this command has an option of `render`. It has all options of the content and the look of
 * pictures. */
static bool has_render_option(size_t row) { return !render_is_of_picture((enum render_option)row); }

/* One run. */
typedef struct animate_job {
  cli_host host;
  const cli_value *values, *render; /* the values of the command's own options, and of the options of
                                     * `render` */
  char **inputs;                    /* null after the last */
  cli_overlay overlay;              /* owned; drawn over each frame */
  char *input;
  char *output; /* owned; the path of the film, or of the folder itself */
  char *folder; /* owned; of the pictures */
  bool film_wanted;
  int part, parts; /* part: from 0 */
  hl_scene *scene; /* owned */
  film *film;      /* owned */
} animate_job;

/* ---- where the film goes ---- */

static bool is_film(const char *path) { return has_extension_among(path, movie_extensions); }

/* The folder of a film's pictures: "turn-frames" for the film "turn.mp4"; for an output that is a folder,
 * the folder's own name without a slash at the end. */
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

/* ---- the film's scene ---- */

static int load(animate_job *job) {
  bool bare;
  hl_error error = {0};
  job->host.preview_pixels = render_first_pixels(job->render);
  int exit_code = render_load_inputs(&job->host, job->render, job->inputs, &bare, &job->scene);
  if (exit_code == EXIT_CODE_OK)
    exit_code = render_change_scene(&job->host, job->render, bare, 0, &job->scene);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  hl_status status = overlay_check_scene(job->host.context, &job->overlay, job->scene, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(&job->host, PHASE_CHANGE, status, &error);
}

static double frames_per_second(const animate_job *job) {
  return job->values[ANIMATE_FPS].given ? job->values[ANIMATE_FPS].number[0] : 30;
}

/* Writes the key of a light sweep: in two seconds the first light's azimuth goes from -75 degrees, on the
 * left, to 75 degrees, and back. */
static void write_sweep(const animate_job *job, char text[80]) {
  int half = (int)fmax(1, frames_per_second(job));
  snprintf(text, 80, "lights.0.azimuth=0:-75,%d:75,%d:-75", half, 2 * half);
}

/* The film's options, and the texts to which they point: the keys of --key and of the light sweep. */
typedef struct motion {
  const char *keys[MAXIMUM_REPEATS + 1];
  char sweep[80];
  film_options film;
} motion;

static bool sweeps(const animate_job *job) {
  return job->values[ANIMATE_PRESET].given && job->values[ANIMATE_PRESET].choice == PRESET_LIGHT_SWEEP;
}

static void find_motion(const animate_job *job, bool series, motion *found) {
  const cli_value *values = job->values;
  size_t count = 0;
  for (int k = 0; k < values[ANIMATE_KEY].count; k++) found->keys[count++] = values[ANIMATE_KEY].texts[k];
  write_sweep(job, found->sweep);
  if (sweeps(job)) found->keys[count++] = found->sweep;
  const bool turns = values[ANIMATE_TURNTABLE].given || (values[ANIMATE_PRESET].given && !sweeps(job));
  int turn = (int)values[ANIMATE_TURNTABLE].number[0]; /* 0 if the number is not given */
  if (turns && turn == 0) turn = series ? FILM_WHOLE_TURN : (int)fmax(1, round(4 * frames_per_second(job)));
  found->film = (film_options){
      .context = job->host.context,
      .scene = job->scene,
      .keys = found->keys,
      .key_count = count,
      .frames_per_second = frames_per_second(job),
      .smooth = values[ANIMATE_EASE].given ? values[ANIMATE_EASE].choice == 1 : sweeps(job),
      .turntable = turn};
}

/* Returns whether the first volume's file has several time steps. */
static bool has_times(const animate_job *job) {
  const hl_scene_description *description = hl_scene_describe(job->scene);
  hl_volume_selection selection = {.struct_size = sizeof selection};
  return description->volume_count > 0 &&
         hl_volume_get_selection(description->volumes[0].volume, &selection) == HL_OK && selection.times > 1;
}

/* Finds the cameras of all frames. */
static hl_status find_cameras(const film *f, hl_camera *cameras, hl_error *error) {
  hl_status status = HL_OK;
  for (int n = 0; n < film_frames(f) && status == HL_OK; n++) {
    hl_scene *scene = NULL;
    status = film_scene(f, n, &scene, error);
    if (status == HL_OK) cameras[n] = hl_scene_describe(scene)->camera;
    hl_scene_release(scene);
  }
  return status;
}

/* Reads the volumes where the camera of any frame sees them, and makes the film of them. */
static int go_nearer(animate_job *job, film_options *options) {
  hl_error error = {0};
  const size_t count = (size_t)film_frames(job->film);
  hl_camera *cameras = calloc(count, sizeof *cameras);
  if (cameras == NULL) return fail(EXIT_CODE_FAILURE, "out of memory for %zu cameras", count);
  hl_status status = find_cameras(job->film, cameras, &error);
  int exit_code = status == HL_OK ? render_go_nearer(&job->host, cameras, count, &job->scene)
                                  : host_fail(&job->host, PHASE_CHANGE, status, &error);
  free(cameras);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  film_destroy(job->film);
  job->film = NULL;
  options->scene = job->scene;
  status = film_create(options, &job->film, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(&job->host, PHASE_CHANGE, status, &error);
}

static int plan(animate_job *job) {
  const cli_value *frames = &job->values[ANIMATE_FRAMES];
  motion moving;
  hl_error error = {0};
  find_motion(job, false, &moving);
  film_options *options = &moving.film;
  if (options->turntable == 0 && options->key_count == 0)
    return fail(EXIT_CODE_USAGE,
                "nothing moves: give --turntable, --preset NAME, or --key PATH=FRAME:VALUE,...%s",
                has_times(job) ? ", or --time all, as this file has time steps" : "");
  if (frames->given) options->frames = (int)frames->number[0];
  else if (sweeps(job) && options->turntable == 0 && options->key_count == 1)
    options->frames = 2 * (int)fmax(1, frames_per_second(job));
  hl_status status = film_create(options, &job->film, &error);
  render_name_scene(job->input, false, &error);
  if (status != HL_OK) return host_fail(&job->host, PHASE_CHANGE, status, &error);
  return hl_scene_is_coarse(hl_scene_describe(job->scene)) ? go_nearer(job, options) : EXIT_CODE_OK;
}

/* ---- the run ---- */

static int count_digits(int frames) {
  int digits = 4;
  for (int most = 10000; most < frames; most *= 10) digits++;
  return digits;
}

/* Says how a film that nobody can follow gets slower, if no speed was asked for. */
static void tell_of_short_film(const animate_job *job, int count, double rate) {
  enum { SLOW_RATE = 2 };
  if (job->values[ANIMATE_FPS].given || count < 2 || count >= rate) return;
  say("%s lasts %.2g s: --fps %d shows each of the %d pictures for half a second", job->output, count / rate,
      SLOW_RATE, count);
}

/* Joins the pictures to a film, if all of them exist. */
static int finish(const animate_job *job, const animate_frames *frames) {
  double rate = frames_per_second(job);
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
  if (!job->host.quiet) tell_of_short_film(job, count, rate);
  return EXIT_CODE_OK;
}

static int run_job(animate_job *job) {
  int exit_code = load(job);
  if (exit_code == EXIT_CODE_OK) exit_code = plan(job);
  if (exit_code == EXIT_CODE_OK) exit_code = read_files_protect(&job->host.read, job->output, job->input);
  if (exit_code == EXIT_CODE_OK) exit_code = output_make_folder(job->folder);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  if (job->film_wanted && !movie_available() && !job->host.quiet)
    warn("ffmpeg is not installed: numbered pictures go to %s instead of a film", job->folder);
  animate_frames frames = {.host = &job->host,
                           .film = job->film,
                           .folder = job->folder,
                           .style = {.opaque = job->film_wanted, /* a film has no transparent pixels */
                                     .no_metadata = job->render[RENDER_NO_METADATA].given,
                                     .overlay = &job->overlay},
                           .digits = count_digits(film_frames(job->film))};
  job->host.own_bar = true;
  exit_code = animate_render(&frames, job->part, job->parts);
  return exit_code == EXIT_CODE_OK ? finish(job, &frames) : exit_code;
}

/* Joins the `count` pictures of a series to a film. */
static int finish_series(const animate_job *job, const cli_value *values, int count) {
  bool quiet = values[RENDER_QUIET].given;
  if (job->parts > 1 || !movie_available()) {
    if (!quiet && job->parts > 1)
      say("%s: once all parts are there, the command without --part joins them", job->folder);
    else if (!quiet) warn("ffmpeg is not installed: the pictures stay in %s", job->folder);
    return EXIT_CODE_OK;
  }
  int exit_code = animate_join_series(job->folder, count, job->output, frames_per_second(job), quiet);
  if (exit_code == EXIT_CODE_OK && !job->values[ANIMATE_KEEP_FRAMES].given)
    animate_remove_series(job->folder, count);
  if (exit_code == EXIT_CODE_OK && !quiet) tell_of_short_film(job, count, frames_per_second(job));
  return exit_code;
}

/* Makes the pictures of a series of files, which are then joined to a film. Each file is a frame, and the
 * frames in the keys are numbers of files. */
static int run_series(animate_job *job) {
  cli_value *values = calloc(RENDER_OPTION_COUNT, sizeof *values);
  char *pattern = NULL;
  int exit_code = EXIT_CODE_OK, count = 0;
  motion moving;
  find_motion(job, true, &moving);
  const bool moves = moving.film.turntable != 0 || moving.film.key_count > 0;
  if (job->values[ANIMATE_FRAMES].given)
    exit_code = fail(EXIT_CODE_USAGE, "--frames: a film of several files has one frame for each of them");
  if (exit_code == EXIT_CODE_OK && (values == NULL || asprintf(&pattern, "%s/%%06d.png", job->folder) < 0))
    exit_code = fail(EXIT_CODE_FAILURE, "out of memory");
  if (exit_code == EXIT_CODE_OK && strchr(job->folder, '%') != NULL)
    exit_code = fail(EXIT_CODE_USAGE, "--output: '%s': a film of several files has no '%%' in its name",
                     job->output);
  if (exit_code == EXIT_CODE_OK) {
    memcpy(values, job->render, RENDER_OPTION_COUNT * sizeof *values);
    values[RENDER_OUTPUT] = (cli_value){.given = true, .text = pattern, .texts = {pattern}, .count = 1};
    if (!values[RENDER_BACKGROUND].given || !values[RENDER_BACKGROUND].chosen)
      exit_code = render_series(values, job->inputs, moves ? &moving.film : NULL, &count);
    else exit_code = fail(EXIT_CODE_USAGE, "--background transparent: a film has no transparent pixels");
  }
  if (exit_code == EXIT_CODE_OK && job->film_wanted) exit_code = finish_series(job, values, count);
  free(values);
  free(pattern);
  return exit_code;
}

static int run_animate(const cli_value *values, char **operands) {
  animate_job job = {
      .values = values, .render = values + ANIMATE_OPTION_COUNT, .inputs = operands, .input = operands[0]};
  const cli_value *render = job.render;
  cli_host_options options = {.quiet = render[RENDER_QUIET].given,
                              .progress = true,
                              .subject = base_name(job.input),
                              .memory_limit = render[RENDER_MAX_MEMORY].bytes,
                              .device = render[RENDER_DEVICE].text,
                              .instruction_set = (hl_instruction_set)render[RENDER_INSTRUCTION_SET].choice,
                              .data_folder = render[RENDER_DATA].text,
                              .operands = operands};
  int exit_code = frames_read_part(&render[RENDER_PART], &render[RENDER_RANKS], &job.part, &job.parts);
  if (exit_code == EXIT_CODE_OK) exit_code = render_check_options(render);
  if (exit_code == EXIT_CODE_OK) exit_code = render_overlay_read(render, &job.overlay);
  overlay_hold(&job.overlay);
  if (exit_code == EXIT_CODE_OK) exit_code = choose_output(&job);
  bool series = render_has_pattern(operands) || render[RENDER_TIME].chosen;
  if (exit_code == EXIT_CODE_OK && !series && render[RENDER_RANGE_OF_ALL].given)
    exit_code = fail(EXIT_CODE_USAGE,
                     "--range-of-all is for a film of several files: give a pattern, as 'flame_*.vti'");
  if (exit_code == EXIT_CODE_OK && series) exit_code = run_series(&job);
  if (exit_code == EXIT_CODE_OK && !series) {
    exit_code = host_open(&options, &job.host);
    if (exit_code == EXIT_CODE_OK) exit_code = run_job(&job);
    film_destroy(job.film);
    hl_scene_release(job.scene);
    host_close(&job.host);
  }
  overlay_release(&job.overlay);
  free(job.folder);
  free(job.output);
  return exit_code;
}

const cli_command animate_command = {
    .name = "animate",
    .operands = "INPUT ...",
    .operand_count = 1,
    .operand_most = MAXIMUM_OPERANDS,
    .summary = "a film: a turn, or numbers of a scene that change",
    .description =
        "Renders INPUT as `halflight render` does, with the same options, frame by frame, while the camera\n"
        "turns or numbers of the scene change. The program ffmpeg joins the pictures to a film; where it is\n"
        "missing, numbered pictures are left. With a pattern of files in quotes ('flame_*.vti'), time "
        "passes\n"
        "from file to file. A run that was stopped goes on: it keeps the pictures that are there, if their\n"
        "scene is the same.",
    .options = animate_options,
    .option_count = ANIMATE_OPTION_COUNT,
    .shared = render_options,
    .shared_count = RENDER_OPTION_COUNT,
    .has_shared = has_render_option,
    .run = run_animate,
};
