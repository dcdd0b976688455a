/* server/films.c - films that a page asks for: every frame rendered as `halflight animate` does, and joined
 * by ffmpeg's program. */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "film/film.h"
#include "film/movie.h"
#include "parts.h"

enum { MOST_FILM_BYTES = 1 << 30 };

/* One frame as a PNG, into the film. */
static hl_status add_frame(server *s, server_page *page, const hl_scene *scene, movie *m, hl_error *error) {
  hl_context *context = s->options.context;
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_image *image = NULL;
  unsigned char *bytes = NULL;
  size_t length = 0;
  hl_status status = page->renderer == NULL ? hl_renderer_create(context, &page->renderer, error) : HL_OK;
  if (status == HL_OK) status = hl_image_create(context, d->width, d->height, &image, error);
  if (status == HL_OK)
    status = hl_renderer_render(page->renderer, scene, hl_image_pixels(image), 4 * (size_t)d->width, NULL,
                                error);
  if (status == HL_OK) {
    hl_image_write_options options;
    hl_scene_write_options(scene, &options);
    options.background_transparent = 0;
    status = hl_image_encode(context, image, "png", &options, &bytes, &length, error);
  }
  hl_image_destroy(image);
  if (status == HL_OK) status = movie_add(m, bytes, length, error);
  else movie_abandon(m);
  hl_bytes_release(context, bytes);
  return status;
}

/* On failure the film is abandoned. */
static hl_status add_frames(server *s, server_page *page, const film *f, movie *m, hl_error *error) {
  hl_status status = HL_OK;
  atomic_store(&page->film_frames, film_frames(f));
  for (int frame = 0; status == HL_OK && frame < film_frames(f); frame++) {
    hl_scene *scene = NULL;
    atomic_store(&page->film_done, frame);
    status = film_scene(f, frame, &scene, error);
    if (status == HL_OK) status = add_frame(s, page, scene, m, error);
    else movie_abandon(m);
    hl_scene_release(scene);
  }
  return status;
}

/* The film's bytes, from a file that is removed. */
static hl_status take_file(const char *path, server_answer *answer, hl_error *error) {
  struct stat about;
  FILE *file = fopen(path, "rbe");
  bool good = file != NULL && fstat(fileno(file), &about) == 0 && about.st_size <= MOST_FILM_BYTES;
  if (good) answer->from_malloc = malloc((size_t)about.st_size + 1);
  good = good && answer->from_malloc != NULL &&
         fread(answer->from_malloc, 1, (size_t)about.st_size, file) == (size_t)about.st_size;
  if (good) answer->length = (size_t)about.st_size;
  if (file != NULL) fclose(file);
  if (good) return HL_OK;
  free(answer->from_malloc);
  answer->from_malloc = NULL;
  snprintf(error->message, sizeof error->message, "the film is too large for the page, or memory is short");
  return HL_ERROR_MEMORY;
}

static hl_status make(server *s, server_page *page, const hl_scene *scene, const film_request *request,
                      server_answer *answer, hl_error *error) {
  film_options options = {.context = s->options.context,
                          .scene = scene,
                          .keys = request->keys,
                          .key_count = request->key_count,
                          .turntable = request->turntable,
                          .frames = request->frames};
  server_upload place;
  char name[40];
  film *f = NULL;
  movie *m = NULL;
  hl_status status = film_create(&options, &f, error);
  if (status != HL_OK) return status;
  snprintf(name, sizeof name, "film.%s", request->format);
  if (!upload_folder(name, &place)) {
    snprintf(error->message, sizeof error->message, "no temporary folder for the film");
    status = HL_ERROR_IO;
  }
  if (status == HL_OK) status = movie_begin(place.path, request->frames_per_second, &m, error);
  if (status == HL_OK) status = add_frames(s, page, f, m, error);
  if (status == HL_OK) status = movie_end(m, error);
  if (status == HL_OK) status = take_file(place.path, answer, error);
  upload_end(&place);
  film_destroy(f);
  return status;
}

hl_status render_film(server *s, server_page *page, const hl_scene *scene, const film_request *request,
                      server_answer *answer, hl_error *error) {
  answer->type = "video/mp4";
  if (strcmp(request->format, "webm") == 0) answer->type = "video/webm";
  if (strcmp(request->format, "gif") == 0) answer->type = "image/gif";
  if (!movie_available()) {
    snprintf(
        error->message, sizeof error->message,
        "ffmpeg is not installed where the viewer runs: copy the command, which leaves numbered pictures");
    return HL_ERROR_UNSUPPORTED;
  }
  hl_status status = make(s, page, scene, request, answer, error);
  atomic_store(&page->film_frames, 0);
  return status;
}
