/* cli/animate/frames.c - makes the numbered pictures of `halflight animate`. Missing pictures are rendered.
 * Then all pictures are joined to a film, and removed.
 *
 * A picture carries its scene. A picture that carries the scene of its frame is kept and not rendered again.
 * So a run continues where the last run stopped, and several runs can share a folder. */
#define _GNU_SOURCE
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "animate.h"
#include "cli/frames.h"
#include "cli/overlay.h"
#include "film/movie.h"

enum { PATH_BYTES = 4096 };

void animate_frame_path(const animate_frames *frames, int frame, char *path, size_t size) {
  snprintf(path, size, "%s/%0*d.png", frames->folder, frames->digits, frame);
}

bool animate_frame_is_there(const animate_frames *frames, int frame) {
  char path[PATH_BYTES];
  hl_scene *scene = NULL;
  hl_error error = {0};
  animate_frame_path(frames, frame, path, sizeof path);
  if (access(path, F_OK) != 0) return false;
  hl_status status = film_scene(frames->film, frame, &scene, &error);
  bool there = status == HL_OK && frames_have_scene(frames->host, path, scene);
  hl_scene_release(scene);
  return there;
}

static hl_status do_frame(animate_frames *frames, hl_renderer *renderer, int frame, double *seconds,
                          hl_error *error) {
  char path[PATH_BYTES];
  hl_scene *scene = NULL;
  double began = hl_clock_seconds();
  /* A picture with overlays is always rendered anew, because the scene that a picture carries does not tell
   * its overlays. */
  if (overlay_is_any(frames->style.overlay) || !animate_frame_is_there(frames, frame)) {
    animate_frame_path(frames, frame, path, sizeof path);
    hl_status status = film_scene(frames->film, frame, &scene, error);
    frames_style style = frames->style;
    style.number = frame;
    if (status == HL_OK) status = frames_render(frames->host, renderer, scene, style, path, error);
    hl_scene_release(scene);
    if (status != HL_OK) return status;
    frames->rendered++;
    *seconds += hl_clock_seconds() - began;
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
    frames_draw_bar(frames->host, frames->done, wanted, frames->rendered, seconds);
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

static hl_status add_picture(movie *m, const char *path, hl_error *error) {
  size_t length = 0;
  unsigned char *bytes = frames_read_picture(path, &length);
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

static hl_status add_frame(const animate_frames *frames, movie *m, int frame, hl_error *error) {
  char path[PATH_BYTES];
  animate_frame_path(frames, frame, path, sizeof path);
  return add_picture(m, path, error);
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

/* ---- pictures of a series of files ---- */

static void series_path(const char *folder, int number, char *path, size_t size) {
  snprintf(path, size, "%s/%06d.png", folder, number);
}

int animate_join_series(const char *folder, int count, const char *output, double frames_per_second,
                        bool quiet) {
  char path[PATH_BYTES];
  movie *m = NULL;
  hl_error error = {0};
  hl_status status = movie_begin(output, frames_per_second, &m, &error);
  for (int number = 0; status == HL_OK && number < count; number++) {
    series_path(folder, number, path, sizeof path);
    status = add_picture(m, path, &error);
  }
  if (status == HL_OK) status = movie_end(m, &error);
  if (status != HL_OK) return fail_with(PHASE_RUN, status, &error);
  if (!quiet)
    say("%s: %d frames, %.3g s at %.4g a second", output, count, count / frames_per_second,
        frames_per_second);
  return EXIT_CODE_OK;
}

void animate_remove_series(const char *folder, int count) {
  char path[PATH_BYTES];
  for (int number = 0; number < count; number++) {
    series_path(folder, number, path, sizeof path);
    unlink(path);
  }
  rmdir(folder);
}

void animate_remove_frames(const animate_frames *frames) {
  char path[PATH_BYTES];
  for (int frame = 0; frame < film_frames(frames->film); frame++) {
    animate_frame_path(frames, frame, path, sizeof path);
    unlink(path);
  }
  rmdir(frames->folder);
}
