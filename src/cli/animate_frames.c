/* cli/animate_frames.c - the numbered pictures of `halflight animate`: rendered where they are not there yet,
 * joined to a film, removed.
 *
 * A picture carries its scene. One that is there with the scene of its frame is kept, so that a run goes on
 * where the last one stopped, and so that several runs can share a folder.
 */
#define _GNU_SOURCE
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "animate.h"
#include "film/movie.h"

enum { PATH_BYTES = 4096, MOST_PICTURE_BYTES = 1 << 30 };

void animate_frame_path(const animate_frames *frames, int frame, char *path, size_t size) {
  snprintf(path, size, "%s/%0*d.png", frames->folder, frames->digits, frame);
}

/* The file's bytes, owned by the caller; null where it cannot be read. */
static unsigned char *read_file(const char *path, size_t *length) {
  struct stat about;
  FILE *file = fopen(path, "rbe");
  unsigned char *bytes = NULL;
  if (file == NULL) return NULL;
  if (fstat(fileno(file), &about) == 0 && S_ISREG(about.st_mode) && about.st_size > 0 &&
      about.st_size <= MOST_PICTURE_BYTES)
    bytes = malloc((size_t)about.st_size);
  *length = bytes != NULL ? fread(bytes, 1, (size_t)about.st_size, file) : 0;
  fclose(file);
  return bytes;
}

/* The scene that a picture on disk was made of; free with hl_text_release(); null: there is none. */
static char *scene_of_picture(const animate_frames *frames, const char *path) {
  size_t length;
  char *text = NULL;
  unsigned char *bytes = read_file(path, &length);
  if (bytes == NULL) return NULL;
  if (hl_image_find_scene(frames->host->context, path, bytes, length, &text, NULL) != HL_OK) text = NULL;
  free(bytes);
  return text;
}

static bool has_scene(const animate_frames *frames, const char *path, const char *scene) {
  char *text = scene_of_picture(frames, path);
  bool same = text != NULL && strcmp(text, scene) == 0;
  hl_text_release(frames->host->context, text);
  return same;
}

bool animate_frame_is_there(const animate_frames *frames, int frame) {
  char path[PATH_BYTES], *text = NULL;
  hl_scene *scene = NULL;
  hl_error error = {0};
  animate_frame_path(frames, frame, path, sizeof path);
  if (access(path, F_OK) != 0) return false;
  hl_status status = film_scene(frames->film, frame, &scene, &error);
  if (status == HL_OK) status = hl_scene_to_json(frames->host->context, scene, &text, &error);
  bool there = status == HL_OK && has_scene(frames, path, text);
  hl_text_release(frames->host->context, text);
  hl_scene_release(scene);
  return there;
}

/* "3 h 20 min", "4 min", "12 s". */
static void describe_time(double seconds, char *text, size_t size) {
  long whole = (long)(seconds + 0.5);
  if (whole >= 3600) snprintf(text, size, "%ld h %ld min", whole / 3600, whole % 3600 / 60);
  else if (whole >= 60) snprintf(text, size, "%ld min %ld s", whole / 60, whole % 60);
  else snprintf(text, size, "%ld s", whole);
}

/* wanted: number of pictures that this run renders in all; seconds: time that those rendered so far took. */
static void draw_bar(const animate_frames *frames, int wanted, double seconds) {
  char text[80], left[40];
  if (frames->rendered == 0) {
    snprintf(text, sizeof text, "frame %d of %d", frames->done + 1, wanted);
  } else {
    describe_time(seconds / frames->rendered * (wanted - frames->done), left, sizeof left);
    snprintf(text, sizeof text, "frame %d of %d, %s left", frames->done + 1, wanted, left);
  }
  host_draw_bar(frames->host, (double)frames->done / wanted, text);
}

/* The picture of one frame, written beside its name and renamed. */
static hl_status render_frame(const animate_frames *frames, hl_renderer *renderer, const hl_scene *scene,
                              const char *path, hl_error *error) {
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_context *context = frames->host->context;
  hl_image *image = NULL;
  char *text = NULL;
  hl_status status = hl_image_create(context, d->width, d->height, &image, error);
  if (status == HL_OK)
    status = hl_renderer_render(renderer, scene, hl_image_pixels(image), 4 * (size_t)d->width, NULL, error);
  if (status == HL_OK) status = hl_scene_to_json(context, scene, &text, error);
  if (status == HL_OK) {
    hl_image_write_options options;
    hl_scene_write_options(scene, &options);
    options.scene_json = text;
    if (frames->opaque) options.background_transparent = 0;
    status = host_interrupted() ? HL_ERROR_CANCELLED : hl_image_write(context, image, path, &options, error);
  }
  hl_text_release(context, text);
  hl_image_destroy(image);
  return status;
}

static hl_status do_frame(animate_frames *frames, hl_renderer *renderer, int frame, double *seconds,
                          hl_error *error) {
  char path[PATH_BYTES];
  hl_scene *scene = NULL;
  double began = clock_seconds();
  if (!animate_frame_is_there(frames, frame)) {
    animate_frame_path(frames, frame, path, sizeof path);
    hl_status status = film_scene(frames->film, frame, &scene, error);
    if (status == HL_OK) status = render_frame(frames, renderer, scene, path, error);
    hl_scene_release(scene);
    if (status != HL_OK) return status;
    frames->rendered++;
    *seconds += clock_seconds() - began;
  }
  frames->done++;
  return HL_OK;
}

int animate_render(animate_frames *frames, int part, int parts) {
  hl_error error = {0};
  hl_renderer *renderer = NULL;
  int count = film_frames(frames->film), wanted = (count - part + parts - 1) / parts;
  double seconds = 0;
  hl_status status = hl_renderer_create(frames->host->context, &renderer, &error);
  for (int frame = part; status == HL_OK && frame < count; frame += parts) {
    draw_bar(frames, wanted, seconds);
    status = host_interrupted() ? HL_ERROR_CANCELLED : do_frame(frames, renderer, frame, &seconds, &error);
  }
  hl_renderer_destroy(renderer);
  host_clear_bar(frames->host);
  if (status == HL_ERROR_CANCELLED)
    return fail(EXIT_CODE_INTERRUPTED,
                "interrupted with %d of %d pictures in %s: the same command goes on from there", frames->done,
                wanted, frames->folder);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(frames->host, PHASE_RUN, status, &error);
}

bool animate_is_complete(const animate_frames *frames) {
  for (int frame = 0; frame < film_frames(frames->film); frame++)
    if (!animate_frame_is_there(frames, frame)) return false;
  return true;
}

static hl_status add_frame(const animate_frames *frames, movie *m, int frame, hl_error *error) {
  char path[PATH_BYTES];
  size_t length = 0;
  animate_frame_path(frames, frame, path, sizeof path);
  unsigned char *bytes = read_file(path, &length);
  if (bytes == NULL) {
    snprintf(error->message, sizeof error->message, "%.900s: cannot be read again: %s", path,
             strerror(errno));
    movie_abandon(m);
    return HL_ERROR_IO;
  }
  hl_status status = movie_add(m, bytes, length, error);
  free(bytes);
  return status;
}

int animate_join(const animate_frames *frames, const char *path, double frames_per_second) {
  movie *m = NULL;
  hl_error error = {0};
  int count = film_frames(frames->film);
  hl_status status = movie_begin(path, frames_per_second, &m, &error);
  for (int frame = 0; status == HL_OK && frame < count; frame++) {
    host_draw_bar(frames->host, (double)frame / count, "joining the pictures");
    status = add_frame(frames, m, frame, &error);
    if (status == HL_OK && host_interrupted()) {
      movie_abandon(m);
      status = HL_ERROR_CANCELLED;
    }
  }
  if (status == HL_OK) status = movie_end(m, &error);
  host_clear_bar(frames->host);
  if (status == HL_ERROR_CANCELLED)
    return fail(EXIT_CODE_INTERRUPTED, "interrupted: all pictures are in %s; the same command joins them",
                frames->folder);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(frames->host, PHASE_RUN, status, &error);
}

void animate_remove_frames(const animate_frames *frames) {
  char path[PATH_BYTES];
  for (int frame = 0; frame < film_frames(frames->film); frame++) {
    animate_frame_path(frames, frame, path, sizeof path);
    unlink(path);
  }
  rmdir(frames->folder);
}
