/* json/images.c - loads the images that a scene's lights, sky and transfer functions name. */
#include <string.h>

#include <halflight/image.h>

#include "core/file.h"
#include "core/memory.h"
#include "json/parts.h"

/* An image that the scene `like` has loaded already. pixels is null if `like` does not have the image. */
typedef struct known_image {
  const float *pixels; /* [height][width][channels]; null if `like` does not have the image */
  int width, height;
} known_image;

static bool is_from(const char *file, const float *pixels, const char *path) {
  return file != NULL && pixels != NULL && strcmp(file, path) == 0;
}

static known_image find_function_image(const hl_scene_description *like, const char *path) {
  for (size_t v = 0; v < like->volume_count; v++) {
    const hl_function_image *image = &like->volumes[v].transfer_function.plane.image;
    if (is_from(image->file, image->pixels, path))
      return (known_image){image->pixels, image->width, image->height};
  }
  return (known_image){NULL, 0, 0};
}

/* Finds an image that `like` has loaded from this file. If 4 channels are needed, only images of transfer
 * functions are considered, because other images were loaded without alpha. */
static known_image find_known(const hl_scene_description *like, const char *path, int channels) {
  if (channels == 4) return find_function_image(like, path);
  const hl_sky *sky = &like->sky;
  if (is_from(sky->file, sky->pixels, path)) return (known_image){sky->pixels, sky->width, sky->height};
  for (size_t l = 0; l < like->light_count; l++) {
    const hl_light_texture *texture = &like->lights[l].texture;
    const hl_light_emission *emission = &like->lights[l].emission;
    if (is_from(texture->file, texture->pixels, path))
      return (known_image){texture->pixels, texture->width, texture->height};
    if (is_from(emission->file, emission->pixels, path))
      return (known_image){emission->pixels, emission->width, emission->height};
  }
  return (known_image){NULL, 0, 0};
}

static float *room_for(hl_json_reader *reader, int width, int height, const hl_json_image *to) {
  float *pixels = hl_allocate(reader->context, (size_t)width * (size_t)height,
                              (size_t)to->channels * sizeof *pixels);
  *to->pixels = pixels;
  *to->width = width;
  *to->height = height;
  return pixels;
}

static hl_status fail_room(hl_json_reader *reader, const hl_json_image *to) {
  uint64_t pixels = (uint64_t)*to->width * (uint64_t)*to->height;
  return hl_fail_memory(reader->error, pixels * (uint64_t)to->channels * sizeof(float), "an image");
}

static hl_status copy_known(hl_json_reader *reader, const char *file, const hl_json_image *to) {
  known_image known = find_known(reader->like, *to->file, to->channels);
  if (known.pixels == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "file",
                        "\"%.200s\" is no image of the open scene: open it anew", file);
  float *pixels = room_for(reader, known.width, known.height, to);
  if (pixels == NULL) return fail_room(reader, to);
  size_t floats = (size_t)known.width * (size_t)known.height * (size_t)to->channels;
  memcpy(pixels, known.pixels, floats * sizeof *pixels);
  return HL_OK;
}

/* Copies an image's pixels, with the number of channels that `to` has. If alpha is left out, the result is
 * the image over black, because the colours are premultiplied. */
static hl_status take_pixels(hl_json_reader *reader, const hl_image *image, const hl_json_image *to) {
  size_t count = (size_t)hl_image_width(image) * (size_t)hl_image_height(image);
  size_t channels = (size_t)to->channels;
  const float *from = hl_image_pixels_const(image);
  float *pixels = room_for(reader, hl_image_width(image), hl_image_height(image), to);
  if (pixels == NULL) return fail_room(reader, to);
  for (size_t i = 0; i < count; i++)
    for (size_t c = 0; c < channels; c++) pixels[channels * i + c] = from[4 * i + c];
  return HL_OK;
}

hl_status hl_json_load_image(hl_json_reader *reader, const json_t *value, const hl_json_image *to) {
  const char *file = NULL;
  hl_status status = hl_json_text(reader, value, "file", &file);
  if (status != HL_OK) return status;
  if (file == NULL || file[0] == 0)
    return hl_json_fail(reader, HL_ERROR_INPUT, "file", "%s: name the image's file",
                        file == NULL ? "is missing" : "is empty");
  char *path = hl_path_join(reader->context, reader->folder, file);
  if (path == NULL) return hl_fail_memory(reader->error, strlen(file) + 1, "a path");
  *to->file = path;
  if (reader->like != NULL) return copy_known(reader, file, to);
  hl_image *image = NULL;
  status = hl_image_read(reader->context, path, &image, reader->error);
  if (status == HL_OK) status = take_pixels(reader, image, to);
  hl_image_destroy(image);
  if (status == HL_OK) return HL_OK;
  hl_json_enter(reader, "file");
  return hl_json_prefix(reader, reader->place), status;
}
