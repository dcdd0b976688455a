/* cli/render/series.c - implements `halflight render 'dump_*.vti' -o 'frames/%04d.png'`: makes a picture of
 * each file of a series.
 *
 * Look, the camera's direction and lights come from the first file that can be read. The camera is placed so
 * that the visible parts of the first, the middle and the last file are in its picture. All other files that
 * the options name (label maps, masks, meshes, skies) are read before the first picture. Files are in the
 * order of the numbers in their names. Pictures are numbered from 0 in this order, or have the files'
 * names. */
#define _GNU_SOURCE
#include "series.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/frames.h"

enum { PATH_BYTES = 4096 };

static int picture_path(const series_job *job, int number, char *path, size_t size) {
  char *name = output_has_name(job->pattern) ? output_name_picture(job->pattern, job->files.names[number])
                                             : output_fill(job->pattern, (output_words){NULL, number, true});
  if (name == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  const int length = snprintf(path, size, "%s", name);
  free(name);
  return length >= 0 && (size_t)length < size
             ? EXIT_CODE_OK
             : fail(EXIT_CODE_USAGE, "%s: the picture's name is too long", job->files.names[number]);
}

/* ---- before the first picture ---- */

static int check_options(series_job *job) {
  static const int alone[] = {RENDER_VIEWS,      RENDER_LAYERS, RENDER_REFERENCE, RENDER_PRINT_SCENE,
                              RENDER_PRINT_PLAN, RENDER_JSON,   RENDER_FORMAT,    RENDER_DEPTH};
  const cli_value *output = &job->values[RENDER_OUTPUT];
  for (size_t n = 0; n < sizeof alone / sizeof *alone; n++)
    if (job->values[alone[n]].given)
      return fail(EXIT_CODE_USAGE, "--%s is for one picture, not for a series",
                  render_options[alone[n]].name);
  job->pattern = output->text;
  if (!output->given || !(series_has_number(job->pattern) || output_has_name(job->pattern)) ||
      !has_extension(job->pattern, ".png"))
    return fail(
        EXIT_CODE_USAGE,
        "a series of files needs a name for each picture: -o 'pictures/%%s.png' (or -o pictures/) for "
        "the files' own names, -o 'frames/%%04d.png' for numbers");
  int exit_code = frames_read_part(&job->values[RENDER_PART], &job->values[RENDER_RANKS], &job->part,
                                   &job->parts);
  if (exit_code == EXIT_CODE_OK) exit_code = render_check_options(job->values);
  if (exit_code == EXIT_CODE_OK) exit_code = render_overlay_read(job->values, &job->overlay);
  overlay_hold(&job->overlay);
  return exit_code;
}

/* Does the work of --range-of-all: sets --range to the range of all files that can be read. */
static int find_range(series_job *job) {
  cli_value *range = &job->values[RENDER_RANGE];
  const bool quiet = job->host.quiet;
  if (!job->values[RENDER_RANGE_OF_ALL].given || range->given || job->files.of_meshes) return EXIT_CODE_OK;
  job->host.quiet = true; /* the first file's warnings are printed when its scene is made */
  for (int n = 0; n < job->files.count; n++) {
    hl_volume *volume = NULL;
    hl_volume_info info = {.struct_size = sizeof info};
    host_draw_bar(&job->host, (double)n / job->files.count, "ranges of all files");
    int exit_code = series_load_volume(job, n, HL_INDEX_DEFAULT, &volume);
    if (exit_code == EXIT_CODE_INTERRUPTED) return exit_code; /* the run ends */
    if (volume != NULL && hl_volume_get_info(volume, &info) == HL_OK && info.range[0] < info.range[1]) {
      if (!range->given || info.range[0] < range->number[0]) range->number[0] = info.range[0];
      if (!range->given || info.range[1] > range->number[1]) range->number[1] = info.range[1];
      range->given = true;
    }
    hl_volume_release(volume);
  }
  job->host.quiet = quiet;
  return EXIT_CODE_OK;
}

/* Loads the first file that can be read, and makes a scene of this file alone. */
static int load_first(series_job *job, bool *bare) {
  int exit_code = EXIT_CODE_INPUT;
  *bare = true;
  for (int n = 0; n < job->files.count && job->scene == NULL; n++) {
    char *operands[] = {job->files.names[n], NULL};
    if (job->files.bad[n]) continue;
    exit_code = job->files.of_meshes
                    ? render_add_meshes(&job->host, operands, 0, true, &job->scene)
                    : render_load_volumes(&job->host, job->values, operands, bare, &job->scene);
    if (exit_code == EXIT_CODE_OK && !*bare)
      return fail(EXIT_CODE_USAGE, "'%s' is neither a volume's file nor a mesh's: a series is made of these",
                  job->files.names[n]);
    if (exit_code != EXIT_CODE_OK && exit_code != EXIT_CODE_INPUT && exit_code != EXIT_CODE_UNSUPPORTED)
      return exit_code;
    job->files.bad[n] = exit_code != EXIT_CODE_OK;
    job->files.first = n;
  }
  return exit_code;
}

/* Moves a scene to the time of a picture: *scene, which is the scene of a file, is replaced by a scene in
 * which the film's keys have set their numbers for this time. */
static hl_status move(const series_job *job, int number, hl_scene **scene, hl_error *error) {
  if (job->motion == NULL) return HL_OK;
  film_options options = *job->motion;
  film *moving = NULL;
  hl_scene *moved = NULL;
  options.context = job->host.context;
  options.scene = *scene;
  options.frames = job->files.count;
  hl_status status = film_create(&options, &moving, error);
  if (status == HL_OK) status = film_scene(moving, number, &moved, error);
  film_destroy(moving);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = moved;
  return HL_OK;
}

/* Applies the keys to the first file's scene, so that a mistake in them is found before the first picture. */
static int try_motion(series_job *job) {
  hl_scene *scene = job->scene;
  hl_error error = {0};
  hl_scene_retain(scene);
  hl_status status = move(job, 0, &scene, &error);
  hl_scene_release(scene);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(&job->host, PHASE_CHANGE, status, &error);
}

/* Places the camera so that it frames the visible part of a file from the same direction. Returns the exit
 * code; a file that cannot be read is no failure, but has no camera (*found). */
static int frame_file(series_job *job, int number, hl_camera *camera, bool *found) {
  hl_scene *scene = NULL;
  hl_error error = {0};
  *found = false;
  int exit_code = series_scene(job, number, &scene);
  if (exit_code != EXIT_CODE_OK) return job->files.bad[number] ? EXIT_CODE_OK : exit_code;
  const hl_scene_description *description = hl_scene_describe(scene);
  *camera = description->camera;
  hl_status status = hl_camera_reframe(description, camera, &error);
  *found = status == HL_OK;
  hl_scene_release(scene);
  return status == HL_ERROR_MEMORY ? host_fail(&job->host, PHASE_CHANGE, status, &error) : EXIT_CODE_OK;
}

static bool show_the_same(const hl_camera *a, const hl_camera *b) {
  return memcmp(a->position, b->position, sizeof a->position) == 0 && a->height == b->height;
}

/* Places the camera so that the first, the middle and the last file fit into the picture. If the first file's
 * camera shows the other files as a whole, the camera is not changed. */
static int frame_all(series_job *job) {
  const int numbers[] = {job->files.first, (job->files.first + job->files.count - 1) / 2,
                         job->files.count - 1};
  hl_camera cameras[3], joined;
  hl_scene_description changed = *hl_scene_describe(job->scene);
  hl_error error = {0};
  size_t count = 0;
  int exit_code = EXIT_CODE_OK;
  const bool quiet = job->host.quiet;
  job->host.quiet = true; /* the first file's warnings were printed when it was loaded */
  for (size_t n = 0; n < 3 && exit_code == EXIT_CODE_OK; n++) {
    bool found = false;
    if (n == 0 || numbers[n] != numbers[n - 1])
      exit_code = frame_file(job, numbers[n], &cameras[count], &found);
    if (n == 0 && !found) break;
    count += found;
  }
  job->host.quiet = quiet;
  if (exit_code != EXIT_CODE_OK || count == 0 ||
      hl_camera_join(cameras, count, (double)changed.width / changed.height, &joined) != HL_OK ||
      show_the_same(&joined, &cameras[0]))
    return exit_code;
  if (job->values[RENDER_ZOOM].given) film_zoom(&joined, job->values[RENDER_ZOOM].number[0]);
  changed.camera = joined;
  hl_scene *framed = NULL;
  hl_status status = hl_scene_create(job->host.context, &changed, &framed, &error);
  if (status != HL_OK) return host_fail(&job->host, PHASE_CHANGE, status, &error);
  hl_scene_release(job->scene);
  job->scene = framed;
  return EXIT_CODE_OK;
}

/* Makes the first scene from the first file that can be read, and from the files that are in every
 * picture. */
static int make_scene(series_job *job) {
  bool bare;
  render_overlay_set_size(job->values, NULL, job->size_text);
  int exit_code = load_first(job, &bare);
  size_t first = job->files.of_meshes ? 1 : 0;
  if (exit_code == EXIT_CODE_OK)
    exit_code = render_add_meshes(&job->host, job->meshes, first, bare, &job->scene);
  if (exit_code == EXIT_CODE_OK)
    exit_code = render_change_scene(&job->host, job->values, bare, 0, &job->scene);
  if (exit_code == EXIT_CODE_OK) exit_code = frame_all(job);
  if (exit_code == EXIT_CODE_OK) exit_code = try_motion(job);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  return render_go_nearer(&job->host, &hl_scene_describe(job->scene)->camera, 1, &job->scene);
}

/* ---- pictures ---- */

/* Returns whether a picture exists, was made from this scene, and is not older than the file. */
static bool is_there(const series_job *job, int number, const hl_scene *scene, const char *path) {
  struct stat picture, file;
  /* The scene in a picture does not contain the picture's overlays. */
  if (overlay_is_any(&job->overlay)) return false;
  if (stat(path, &picture) != 0 || stat(job->files.names[number], &file) != 0 ||
      picture.st_mtim.tv_sec < file.st_mtim.tv_sec)
    return false;
  return frames_have_scene(&job->host, path, scene);
}

/* Returns whether the picture exists and was made from the right scene. The texts of the scenes are compared.
 * For the right scene's text no volume or mesh is read: the first file's volume or mesh takes its place. */
static bool is_made(series_job *job, int number, const char *path) {
  hl_scene *scene = NULL;
  hl_error error = {0};
  if (access(path, F_OK) != 0 || series_scene_unread(job, number, &scene) != HL_OK) return false;
  bool there = move(job, number, &scene, &error) == HL_OK && is_there(job, number, scene, path);
  hl_scene_release(scene);
  return there;
}

static int make_picture(series_job *job, hl_renderer *renderer, int number) {
  char path[PATH_BYTES];
  hl_scene *scene = NULL;
  hl_error error = {0};
  double began = hl_clock_seconds();
  int exit_code = picture_path(job, number, path, sizeof path);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  if (is_made(job, number, path)) {
    job->progress.done++;
    return EXIT_CODE_OK;
  }
  exit_code = read_files_protect(&job->host.read, path, job->files.names[number]);
  if (exit_code == EXIT_CODE_OK) exit_code = series_scene(job, number, &scene);
  if (exit_code != EXIT_CODE_OK) {
    bool bad = job->files.bad[number];
    job->progress.failed += bad;
    return bad ? EXIT_CODE_OK : exit_code;
  }
  hl_status status = move(job, number, &scene, &error);
  if (status == HL_OK) exit_code = series_go_nearer(job, number, &scene);
  if (exit_code != EXIT_CODE_OK) {
    hl_scene_release(scene);
    job->progress.failed += job->files.bad[number];
    return job->files.bad[number] ? EXIT_CODE_OK : exit_code;
  }
  bool there = status == HL_OK && is_there(job, number, scene, path); /* for a label map */
  const frames_style style = {.no_metadata = job->values[RENDER_NO_METADATA].given,
                              .overlay = &job->overlay,
                              .number = number,
                              .file = job->files.names[number]};
  if (status == HL_OK && !there) status = frames_render(&job->host, renderer, scene, style, path, &error);
  hl_scene_release(scene);
  if (status == HL_ERROR_CANCELLED) return EXIT_CODE_INTERRUPTED;
  if (status != HL_OK) return host_fail(&job->host, PHASE_RUN, status, &error);
  job->progress.done++;
  job->progress.rendered += !there;
  if (!there) job->progress.seconds += hl_clock_seconds() - began;
  return EXIT_CODE_OK;
}

static int make_pictures(series_job *job) {
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  bool quiet = job->host.quiet;
  if (hl_renderer_create(job->host.context, &renderer, &error) != HL_OK)
    return host_fail(&job->host, PHASE_SETUP, HL_ERROR_MEMORY, &error);
  job->progress.wanted = (job->files.count - job->part + job->parts - 1) / job->parts;
  job->host.quiet = true; /* the warnings were printed for the first file; later files would give the same
                           * warnings */
  int exit_code = EXIT_CODE_OK;
  for (int n = job->part; n < job->files.count && exit_code == EXIT_CODE_OK; n += job->parts) {
    frames_draw_bar(&job->host, job->progress.done + job->progress.failed, job->progress.wanted,
                    job->progress.rendered, job->progress.seconds);
    exit_code = host_interrupted() ? EXIT_CODE_INTERRUPTED : make_picture(job, renderer, n);
  }
  hl_renderer_destroy(renderer);
  host_clear_bar(&job->host);
  job->host.quiet = quiet;
  if (exit_code == EXIT_CODE_INTERRUPTED)
    return fail(exit_code, "interrupted with %d of %d pictures: the same command goes on from there",
                job->progress.done, job->progress.wanted);
  if (exit_code == EXIT_CODE_OK && !quiet)
    say("%d pictures, %d of them rendered now, in %.3g s", job->progress.done, job->progress.rendered,
        job->progress.seconds);
  if (exit_code == EXIT_CODE_OK && job->progress.failed > 0)
    return fail(EXIT_CODE_FAILURE, "%d of %d files could not be read, and have no picture",
                job->progress.failed, job->progress.wanted);
  return exit_code;
}

static int run(series_job *job) {
  char path[PATH_BYTES];
  int exit_code = picture_path(job, 0, path, sizeof path);
  if (exit_code == EXIT_CODE_OK) exit_code = output_make_folder_of(path);
  job->host.own_bar = true;
  job->host.preview_pixels = render_first_pixels(job->values);
  if (exit_code == EXIT_CODE_OK) exit_code = series_find_times(job);
  if (exit_code == EXIT_CODE_OK) exit_code = find_range(job);
  if (exit_code == EXIT_CODE_OK) exit_code = make_scene(job);
  return exit_code == EXIT_CODE_OK ? make_pictures(job) : exit_code;
}

int render_series(const cli_value *values, char **operands, const film_options *motion, int *count) {
  series_job *job = calloc(1, sizeof *job);
  if (job == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  job->motion = motion;
  memcpy(job->values, values, sizeof job->values);
  int exit_code = check_options(job);
  cli_host_options options = {.quiet = values[RENDER_QUIET].given,
                              .progress = true,
                              .subject = "",
                              .memory_limit = values[RENDER_MAX_MEMORY].bytes,
                              .data_folder = values[RENDER_DATA].text,
                              .device = values[RENDER_DEVICE].text,
                              .instruction_set = (hl_instruction_set)values[RENDER_INSTRUCTION_SET].choice,
                              .operands = operands};
  if (exit_code == EXIT_CODE_OK) {
    exit_code = host_open(&options, &job->host);
    if (exit_code == EXIT_CODE_OK) exit_code = series_find_files(job, operands);
    if (exit_code == EXIT_CODE_OK) exit_code = run(job);
    if (count != NULL) *count = job->files.count;
    hl_scene_release(job->scene);
    host_close(&job->host);
  }
  series_release_files(job);
  overlay_release(&job->overlay);
  free(job);
  return exit_code;
}
