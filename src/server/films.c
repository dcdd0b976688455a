/* server/films.c - makes the films that a page asks for. Each frame is rendered as `halflight animate` does.
 * The program ffmpeg joins the frames, or the frames are stored in a zip archive. */
#define _GNU_SOURCE
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "film/film.h"
#include "film/movie.h"
#include "parts.h"
#include "picture_zip.h"

enum { MOST_FILM_BYTES = 1 << 30 };

/* The output of frames: a film, or an archive of pictures. */
typedef struct film_output {
  bool zipped;
  movie *movie; /* null if the film has ended */
  picture_zip zip;
  bool is_broken; /* whether the film cannot be stored */
} film_output;

static hl_status fail_to_store(film_output *out, const char *line, hl_error *error) {
  out->is_broken = true;
  snprintf(error->message, sizeof error->message, "%s", line);
  return HL_ERROR_IO;
}

static const char not_stored[] = "the pictures cannot be stored: is the disk full?";

static hl_status output_begin(film_output *out, const film_request *request, const char *path, int frames,
                              hl_error *error) {
  hl_status status = HL_OK;
  *out = (film_output){.zipped = strcmp(request->format, "zip") == 0};
  if (!out->zipped) {
    status = movie_begin(path, request->frames_per_second, &out->movie, error);
    out->is_broken = status != HL_OK;
  } else if (frames > PICTURE_ZIP_MOST) {
    snprintf(error->message, sizeof error->message, "no archive of %d pictures: at most %d fit", frames,
             (int)PICTURE_ZIP_MOST);
    status = HL_ERROR_INPUT;
  } else if (!picture_zip_begin(&out->zip, path, frames)) status = fail_to_store(out, not_stored, error);
  return status;
}

static hl_status output_add(film_output *out, const unsigned char *png, size_t length, hl_error *error) {
  if (out->zipped) {
    if (picture_zip_add(&out->zip, png, length)) return HL_OK;
    if (out->zip.failed) return fail_to_store(out, not_stored, error);
    snprintf(error->message, sizeof error->message,
             "the pictures take more than 1 GiB: make them smaller or fewer");
    return HL_ERROR_INPUT;
  }
  hl_status status = movie_add(out->movie, png, length, error);
  if (status != HL_OK) out->movie = NULL;
  out->is_broken = status != HL_OK;
  return status;
}

/* Completes the output, or abandons it after a failure. */
static hl_status output_end(film_output *out, hl_status status, hl_error *error) {
  bool good = !out->zipped || picture_zip_end(&out->zip);
  if (!good && status == HL_OK) return fail_to_store(out, not_stored, error);
  if (out->zipped) return status;
  if (status != HL_OK) {
    movie_abandon(out->movie);
    return status;
  }
  status = movie_end(out->movie, error);
  out->is_broken = status != HL_OK;
  return status;
}

/* Adds one frame to the film file, or, as a PNG, to the archive of pictures. */
static hl_status add_frame(server *s, server_page *page, const hl_scene *scene, film_output *out,
                           hl_error *error) {
  hl_context *context = s->options.context;
  const hl_scene_description *d = hl_scene_describe(scene);
  hl_image *image = NULL;
  unsigned char *bytes = NULL;
  char *text = NULL;
  size_t length = 0;
  hl_status status = page->renderer == NULL ? hl_renderer_create(context, &page->renderer, error) : HL_OK;
  if (status == HL_OK) status = hl_image_create(context, d->width, d->height, &image, error);
  if (status == HL_OK)
    status = hl_renderer_render(page->renderer, scene, hl_image_pixels(image), 4 * (size_t)d->width, NULL,
                                error);
  if (status == HL_OK) {
    hl_image_write_options options;
    hl_scene_write_options(scene, &options);
    if (!out->zipped) options.background_transparent = 0;
    else status = hl_scene_to_json(context, scene, &text, error);
    options.scene_json = text; /* the pictures of an archive carry their scene; the frames of a film do not */
    if (status == HL_OK) status = hl_image_encode(context, image, "png", &options, &bytes, &length, error);
  }
  hl_image_destroy(image);
  if (status == HL_OK) status = output_add(out, bytes, length, error);
  hl_bytes_release(context, bytes);
  hl_text_release(context, text);
  return status;
}

static hl_status add_frames(server *s, server_page *page, const film *f, film_output *out, hl_error *error) {
  hl_status status = HL_OK;
  atomic_store(&page->film_frames, film_frames(f));
  for (int frame = 0; status == HL_OK && frame < film_frames(f); frame++) {
    hl_scene *scene = NULL;
    atomic_store(&page->film_done, frame);
    status = film_scene(f, frame, &scene, error);
    if (status == HL_OK) status = add_frame(s, page, scene, out, error);
    hl_scene_release(scene);
  }
  return status;
}

/* Reads the film's bytes from its file, and removes the file. */
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

/* Begins a film. Destroy it with film_destroy(). */
static hl_status begin_film(const server *s, const hl_scene *scene, const film_request *request, film **f,
                            hl_error *error) {
  film_options options = {.context = s->sealed,
                          .scene = scene,
                          .keys = request->keys,
                          .key_count = request->key_count,
                          .frames_per_second = request->frames_per_second,
                          .turntable = request->turntable,
                          .frames = request->frames};
  return film_create(&options, f, error);
}

hl_status turn_to_frame(server *s, hl_scene **scene, const film_request *request, int frame,
                        hl_error *error) {
  film *f = NULL;
  hl_scene *turned = NULL;
  hl_status status = begin_film(s, *scene, request, &f, error);
  if (status == HL_OK) status = film_scene(f, frame, &turned, error);
  film_destroy(f);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = turned;
  return HL_OK;
}

static hl_status make(server *s, server_page *page, const hl_scene *scene, const film_request *request,
                      server_answer *answer, hl_error *error) {
  server_upload place;
  char name[40];
  film *f = NULL;
  film_output out = {.movie = NULL};
  hl_status status = begin_film(s, scene, request, &f, error);
  if (status != HL_OK) return status;
  snprintf(name, sizeof name, "film.%s", request->format);
  if (!upload_folder(name, &place))
    status = fail_to_store(&out, "no temporary folder for the film: is the disk full?", error);
  if (status == HL_OK) status = output_begin(&out, request, place.path, film_frames(f), error);
  if (status == HL_OK) status = add_frames(s, page, f, &out, error);
  status = output_end(&out, status, error);
  answer->is_own_fault = out.is_broken;
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
  if (strcmp(request->format, "zip") == 0) answer->type = "application/zip";
  else if (!movie_available()) {
    snprintf(error->message, sizeof error->message,
             "ffmpeg is not installed where the viewer runs: choose the format Pictures");
    return HL_ERROR_UNSUPPORTED;
  }
  hl_status status = make(s, page, scene, request, answer, error);
  atomic_store(&page->film_frames, 0);
  return status;
}
