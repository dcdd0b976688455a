/* cli/render_series.c - `halflight render 'dump_*.vti' -o 'frames/%04d.png'`: a series of files, a picture of
 * each.
 *
 * Look, camera and lights are those of the first file that can be read. Files are in the order of the numbers
 * in their names, and pictures are numbered from 0 in this order. */
#define _GNU_SOURCE
#include <errno.h>
#include <glob.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "frames.h"
#include "input.h"
#include "render.h"

enum { PATH_BYTES = 4096 };

typedef struct series_job {
  cli_host host;
  cli_value values[RENDER_OPTION_COUNT]; /* --range is set by --range-of-all */
  const char *pattern;                   /* of OUT, with one %d */
  char **files;                          /* owned; [count] */
  bool *bad;                             /* owned; [count]: cannot be read, and was told */
  int count, part, parts;
  int wanted, done, rendered, failed; /* pictures of this part; files of this part that cannot be read */
  double seconds;                     /* of the rendered ones */
  hl_scene *scene;                    /* owned; of the first file */
} series_job;

/* ---- names ---- */

static bool is_pattern(const char *path) { return strpbrk(path, "*?[") != NULL && access(path, F_OK) != 0; }

/* True if the text has one "%d" or "%04d", and no other '%' but "%%". */
static bool has_number(const char *text) {
  int numbers = 0;
  for (const char *c = strchr(text, '%'); c != NULL; c = strchr(c + 1, '%')) {
    if (c[1] == '%') {
      c++;
      continue;
    }
    const char *end = c + 1 + strspn(c + 1, "0123456789");
    if (*end != 'd' || end - c > 3) return false;
    numbers++;
  }
  return numbers == 1;
}

bool render_is_series(const cli_value *values, char **operands) {
  bool pattern = false;
  for (char **operand = operands; *operand != NULL; operand++) pattern = pattern || is_pattern(*operand);
  const cli_value *output = &values[RENDER_OUTPUT];
  return pattern || values[RENDER_PART].given || values[RENDER_RANKS].given ||
         values[RENDER_RANGE_OF_ALL].given || (output->given && has_number(output->text));
}

static void picture_path(const series_job *job, int number, char *path, size_t size) {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
  snprintf(path, size, job->pattern, number); /* has_number() */
#pragma GCC diagnostic pop
}

static int by_number(const void *a, const void *b) {
  return strverscmp(*(char *const *)a, *(char *const *)b);
}

static int add_file(series_job *job, const char *path) {
  char **larger = realloc(job->files, ((size_t)job->count + 1) * sizeof *larger);
  if (larger != NULL) job->files = larger;
  if (larger == NULL || (larger[job->count] = strdup(path)) == NULL)
    return fail(EXIT_CODE_FAILURE, "out of memory for the names of %d files", job->count);
  job->count++;
  return EXIT_CODE_OK;
}

static int add_pattern(series_job *job, const char *pattern) {
  glob_t found = {0};
  int answer = glob(pattern, 0, NULL, &found), exit_code = EXIT_CODE_OK;
  if (answer != 0)
    exit_code = answer == GLOB_NOMATCH ? fail(EXIT_CODE_INPUT, "%s: there is no such file", pattern)
                                       : fail(EXIT_CODE_INPUT, "%s: its folder cannot be read", pattern);
  for (size_t n = 0; n < found.gl_pathc && exit_code == EXIT_CODE_OK; n++)
    exit_code = add_file(job, found.gl_pathv[n]);
  globfree(&found);
  return exit_code;
}

static int find_files(series_job *job, char **operands) {
  int exit_code = EXIT_CODE_OK;
  for (; *operands != NULL && exit_code == EXIT_CODE_OK; operands++)
    exit_code = is_pattern(*operands) ? add_pattern(job, *operands) : add_file(job, *operands);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  qsort(job->files, (size_t)job->count, sizeof *job->files, by_number);
  job->bad = calloc((size_t)job->count, sizeof *job->bad);
  return job->bad != NULL ? EXIT_CODE_OK : fail(EXIT_CODE_FAILURE, "out of memory");
}

/* ---- before the first picture ---- */

static int check_options(series_job *job) {
  static const int alone[] = {RENDER_LAYERS, RENDER_REFERENCE, RENDER_PRINT_SCENE,
                              RENDER_JSON,   RENDER_FORMAT,    RENDER_DEPTH};
  const cli_value *output = &job->values[RENDER_OUTPUT];
  for (size_t n = 0; n < sizeof alone / sizeof *alone; n++)
    if (job->values[alone[n]].given)
      return fail(EXIT_CODE_USAGE, "--%s is for one picture, not for a series",
                  render_options[alone[n]].name);
  if (!output->given || !has_number(output->text) || !has_extension(output->text, ".png"))
    return fail(EXIT_CODE_USAGE,
                "a series of files needs a number in its pictures' names: -o 'frames/%%04d.png'");
  job->pattern = output->text;
  int exit_code = frames_read_part(&job->values[RENDER_PART], &job->values[RENDER_RANKS], &job->part,
                                   &job->parts);
  return exit_code == EXIT_CODE_OK ? render_check_options(job->values) : exit_code;
}

/* The folder of the pictures is made where it is missing. */
static int make_folder(const series_job *job) {
  char path[PATH_BYTES];
  picture_path(job, 0, path, sizeof path);
  char *slash = strrchr(path, '/');
  if (slash == NULL || slash == path) return EXIT_CODE_OK;
  *slash = '\0';
  if (mkdir(path, 0777) == 0 || errno == EEXIST) return EXIT_CODE_OK;
  return fail(EXIT_CODE_FAILURE, "%s: no folder for the pictures can be made: %s", path, strerror(errno));
}

/* Reads a file of the series. A failure is told once. */
static int load_volume(series_job *job, int number, hl_volume **volume) {
  cli_input input = {0};
  hl_volume_load_options options;
  hl_error error = {0};
  if (job->bad[number]) return EXIT_CODE_INPUT;
  input_load_options(&job->values[RENDER_ARRAY], &job->values[RENDER_SPACING], &options);
  int exit_code = input_open(job->files[number], job->values[RENDER_MAX_MEMORY].bytes, &input);
  if (exit_code == EXIT_CODE_OK) {
    hl_status status = input_load_volume(job->host.context, &input, &options, volume, &error);
    if (status != HL_OK) exit_code = host_fail(&job->host, PHASE_READ, status, &error);
  }
  input_close(&input);
  job->bad[number] = exit_code != EXIT_CODE_OK && exit_code != EXIT_CODE_INTERRUPTED;
  return exit_code;
}

/* --range-of-all: sets --range to the range of all files that can be read. */
static int find_range(series_job *job) {
  cli_value *range = &job->values[RENDER_RANGE];
  if (!job->values[RENDER_RANGE_OF_ALL].given || range->given) return EXIT_CODE_OK;
  for (int n = 0; n < job->count; n++) {
    hl_volume *volume = NULL;
    hl_volume_info info = {.struct_size = sizeof info};
    host_draw_bar(&job->host, (double)n / job->count, "ranges of all files");
    int exit_code = load_volume(job, n, &volume);
    if (exit_code == EXIT_CODE_INTERRUPTED) return exit_code;
    if (volume != NULL && hl_volume_get_info(volume, &info) == HL_OK && info.range[0] < info.range[1]) {
      if (!range->given || info.range[0] < range->number[0]) range->number[0] = info.range[0];
      if (!range->given || info.range[1] > range->number[1]) range->number[1] = info.range[1];
      range->given = true;
    }
    hl_volume_release(volume);
  }
  return EXIT_CODE_OK;
}

/* The scene of the first file that can be read. */
static int make_scene(series_job *job) {
  int exit_code = EXIT_CODE_INPUT;
  bool bare = false;
  for (int n = 0; n < job->count && job->scene == NULL; n++) {
    char *operands[] = {job->files[n], NULL};
    if (job->bad[n]) continue;
    exit_code = render_load_inputs(&job->host, job->values, operands, &bare, &job->scene);
    if (exit_code == EXIT_CODE_OK && !bare)
      return fail(EXIT_CODE_USAGE, "'%s' is no volume file: a series is of volume files", job->files[n]);
    if (exit_code != EXIT_CODE_OK && exit_code != EXIT_CODE_INPUT && exit_code != EXIT_CODE_UNSUPPORTED)
      return exit_code;
    job->bad[n] = exit_code != EXIT_CODE_OK;
  }
  if (job->scene == NULL) return exit_code;
  return render_change_scene(&job->host, job->values, bare, &job->scene);
}

/* ---- pictures ---- */

/* The scene of a file. volume: null: the first file's stands in, as the text of the scene is the same. */
static hl_status scene_of(const series_job *job, int number, hl_volume *volume, hl_scene **scene,
                          hl_error *error) {
  hl_scene_description description = *hl_scene_describe(job->scene);
  hl_scene_volume one = description.volumes[0];
  one.file = job->files[number];
  if (volume != NULL) one.volume = volume;
  description.volumes = &one;
  return hl_scene_create(job->host.context, &description, scene, error);
}

/* Whether the picture is there, of the same scene, and not older than the file. */
static bool is_there(const series_job *job, int number, const char *path) {
  struct stat picture, file;
  hl_scene *scene = NULL;
  char *text = NULL;
  if (stat(path, &picture) != 0 || stat(job->files[number], &file) != 0 ||
      picture.st_mtim.tv_sec < file.st_mtim.tv_sec)
    return false;
  hl_status status = scene_of(job, number, NULL, &scene, NULL);
  if (status == HL_OK) status = hl_scene_to_json(job->host.context, scene, &text, NULL);
  bool there = status == HL_OK && frames_have_scene(&job->host, path, text);
  hl_text_release(job->host.context, text);
  hl_scene_release(scene);
  return there;
}

static int make_picture(series_job *job, hl_renderer *renderer, int number) {
  char path[PATH_BYTES];
  hl_volume *volume = NULL;
  hl_scene *scene = NULL;
  hl_error error = {0};
  double began = clock_seconds();
  picture_path(job, number, path, sizeof path);
  if (is_there(job, number, path)) {
    job->done++;
    return EXIT_CODE_OK;
  }
  int exit_code = read_files_protect(&job->host.read, path, job->files[number]);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  exit_code = load_volume(job, number, &volume);
  if (exit_code != EXIT_CODE_OK) {
    job->failed++;
    return exit_code == EXIT_CODE_INTERRUPTED ? exit_code : EXIT_CODE_OK;
  }
  hl_status status = scene_of(job, number, volume, &scene, &error);
  if (status == HL_OK) status = frames_render(&job->host, renderer, scene, false, path, &error);
  hl_scene_release(scene);
  hl_volume_release(volume);
  if (status == HL_ERROR_CANCELLED) return EXIT_CODE_INTERRUPTED;
  if (status != HL_OK) return host_fail(&job->host, PHASE_RUN, status, &error);
  job->done++;
  job->rendered++;
  job->seconds += clock_seconds() - began;
  return EXIT_CODE_OK;
}

static int make_pictures(series_job *job) {
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  bool quiet = job->host.quiet;
  if (hl_renderer_create(job->host.context, &renderer, &error) != HL_OK)
    return host_fail(&job->host, PHASE_SETUP, HL_ERROR_MEMORY, &error);
  job->wanted = (job->count - job->part + job->parts - 1) / job->parts;
  job->host.quiet = true; /* warnings were told with the first file */
  int exit_code = EXIT_CODE_OK;
  for (int n = job->part; n < job->count && exit_code == EXIT_CODE_OK; n += job->parts) {
    frames_draw_bar(&job->host, job->done + job->failed, job->wanted, job->rendered, job->seconds);
    exit_code = host_interrupted() ? EXIT_CODE_INTERRUPTED : make_picture(job, renderer, n);
  }
  hl_renderer_destroy(renderer);
  host_clear_bar(&job->host);
  job->host.quiet = quiet;
  if (exit_code == EXIT_CODE_INTERRUPTED)
    return fail(exit_code, "interrupted with %d of %d pictures: the same command goes on from there",
                job->done, job->wanted);
  if (exit_code == EXIT_CODE_OK && !quiet)
    say("%d pictures, %d of them rendered now, in %.3g s", job->done, job->rendered, job->seconds);
  if (exit_code == EXIT_CODE_OK && job->failed > 0)
    return fail(EXIT_CODE_FAILURE, "%d of %d files could not be read, and have no picture", job->failed,
                job->wanted);
  return exit_code;
}

static int run(series_job *job) {
  int exit_code = make_folder(job);
  job->host.own_bar = true;
  if (exit_code == EXIT_CODE_OK) exit_code = find_range(job);
  if (exit_code == EXIT_CODE_OK) exit_code = make_scene(job);
  return exit_code == EXIT_CODE_OK ? make_pictures(job) : exit_code;
}

int render_series(const cli_value *values, char **operands) {
  series_job *job = calloc(1, sizeof *job);
  if (job == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  memcpy(job->values, values, sizeof job->values);
  int exit_code = check_options(job);
  if (exit_code == EXIT_CODE_OK) exit_code = find_files(job, operands);
  cli_host_options options = {.quiet = values[RENDER_QUIET].given,
                              .progress = true,
                              .subject = "",
                              .memory_limit = values[RENDER_MAX_MEMORY].bytes,
                              .data_folder = values[RENDER_DATA].text,
                              .instruction_set = (hl_instruction_set)values[RENDER_INSTRUCTION_SET].choice};
  if (exit_code == EXIT_CODE_OK) {
    exit_code = host_open(&options, &job->host);
    if (exit_code == EXIT_CODE_OK) exit_code = run(job);
    hl_scene_release(job->scene);
    host_close(&job->host);
  }
  for (int n = 0; n < job->count; n++) free(job->files[n]);
  free(job->files);
  free(job->bad);
  free(job);
  return exit_code;
}
