/* image/image.c - creates pictures, and gives access to their pixels.
 *
 * In: a size. Out: a picture of zeroed pixels, which the renderer or a reader (format.h) fills. Sizes are
 * checked before memory is allocated. */
#include "image/image.h"

#include <inttypes.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"

enum { ROWS_BETWEEN_QUESTIONS = 64 };

/* Clears the pixels row by row. Returns false if the user has cancelled. The function polls the cancel
 * callback, because clearing a large picture takes long: the system provides memory when the memory is first
 * written, at one or two gigabytes a second. */
static bool clear_rows(hl_context *context, float *rows, size_t row_floats, size_t count) {
  for (size_t y = 0; y < count; y++) {
    if (y % ROWS_BETWEEN_QUESTIONS == ROWS_BETWEEN_QUESTIONS - 1 && hl_cancelled(context)) return false;
    memset(rows + y * row_floats, 0, row_floats * sizeof *rows);
  }
  return true;
}

hl_status hl_image_create(hl_context *context, int width, int height, hl_image **image, hl_error *error) {
  HL_DOOR;
  if (image != NULL) *image = NULL;
  if (context == NULL || image == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_create: context and image must not be null");
  if (width < 1 || height < 1 || width > HL_IMAGE_SIDE_MAX || height > HL_IMAGE_SIDE_MAX)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_create: %d x %d pixels, expected 1 to %d a side",
                   width, height, (int)HL_IMAGE_SIDE_MAX);
  size_t floats = 0;
  bool fits = hl_multiply((size_t)width * 4, (size_t)height, &floats);
  hl_image *made = hl_allocate(context, 1, sizeof *made);
  float *pixels = fits ? hl_allocate(context, floats, sizeof *pixels) : NULL;
  bool cleared = pixels != NULL && clear_rows(context, pixels, (size_t)width * 4, (size_t)height);
  if (made == NULL || !cleared) {
    bool cancelled = made != NULL && pixels != NULL;
    hl_release(context, pixels);
    hl_release(context, made);
    return cancelled ? hl_fail(error, HL_ERROR_CANCELLED, "cancelled while making a picture")
                     : hl_fail_memory(error, floats * sizeof *pixels, "a picture");
  }
  *made = (hl_image){.context = context, .width = width, .height = height, .pixels = pixels};
  *image = made;
  return HL_OK;
}

hl_status hl_image_check_size(const char *name, uint64_t width, uint64_t height, hl_error *error) {
  if (width < 1 || height < 1 || width > HL_IMAGE_SIDE_MAX || height > HL_IMAGE_SIDE_MAX)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: claims %" PRIu64 " x %" PRIu64 " pixels, expected 1 to %d a side", name, width,
                   height, (int)HL_IMAGE_SIDE_MAX);
  if (width * height > HL_IMAGE_READ_PIXELS_MAX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: %" PRIu64 " x %" PRIu64
                   " pixels, more than the %d that a picture read from a file may have",
                   name, width, height, (int)HL_IMAGE_READ_PIXELS_MAX);
  return HL_OK;
}

hl_status hl_image_create_for_file(hl_context *context, const char *name, uint64_t width, uint64_t height,
                                   hl_image **image, hl_error *error) {
  hl_status status = hl_image_check_size(name, width, height, error);
  return status != HL_OK ? status : hl_image_create(context, (int)width, (int)height, image, error);
}

/* Returns whether a text can name a layer: OpenEXR names a channel "layer.C", and NPY names a file
 * "picture-layer.npy". */
static bool is_layer_name(const char *name) {
  static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_";
  size_t length = strlen(name);
  return length >= 1 && length <= HL_IMAGE_LAYER_NAME && strspn(name, letters) == length;
}

static bool are_channels(const char *channels) {
  size_t length = strlen(channels);
  for (size_t i = 0; i < length; i++)
    if (channels[i] < 'A' || channels[i] > 'Z' || strchr(channels + i + 1, channels[i]) != NULL) return false;
  return length >= 1 && length <= HL_IMAGE_LAYER_CHANNELS;
}

static hl_status check_layer(const hl_image *image, const char *name, const char *channels, hl_error *error) {
  if (!is_layer_name(name))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_image_add_layer: '%.40s' is no name: give 1 to %d letters, digits and '_'", name,
                   (int)HL_IMAGE_LAYER_NAME);
  if (!are_channels(channels))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_image_add_layer: channels '%.40s': give 1 to %d different capital letters", channels,
                   (int)HL_IMAGE_LAYER_CHANNELS);
  for (size_t i = 0; i < image->layer_count; i++)
    if (strcmp(image->layers[i].name, name) == 0)
      return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_add_layer: the picture has a layer '%s' already",
                     name);
  return HL_OK;
}

hl_status hl_image_add_layer(hl_image *image, const char *name, const char *channels, float **values,
                             hl_error *error) {
  if (image == NULL || name == NULL || channels == NULL || values == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_add_layer: no argument may be null");
  *values = NULL;
  hl_status status = check_layer(image, name, channels, error);
  if (status != HL_OK) return status;
  size_t pixels = (size_t)image->width * (size_t)image->height, floats = pixels * strlen(channels);
  hl_image_layer *layers = hl_allocate(image->context, image->layer_count + 1, sizeof *layers);
  float *made = hl_allocate_zeroed(image->context, floats, sizeof *made);
  if (layers == NULL || made == NULL) {
    hl_release(image->context, layers);
    hl_release(image->context, made);
    return hl_fail_memory(error, floats * sizeof *made, "a layer");
  }
  if (image->layer_count > 0) memcpy(layers, image->layers, image->layer_count * sizeof *layers);
  hl_release(image->context, image->layers);
  image->layers = layers;
  hl_image_layer *layer = &layers[image->layer_count++];
  *layer = (hl_image_layer){.values = made};
  memcpy(layer->name, name, strlen(name));
  memcpy(layer->channels, channels, strlen(channels));
  *values = made;
  return HL_OK;
}

void hl_image_destroy(hl_image *image) {
  if (image == NULL) return;
  for (size_t i = 0; i < image->layer_count; i++) hl_release(image->context, image->layers[i].values);
  hl_release(image->context, image->layers);
  hl_release(image->context, image->pixels);
  hl_release(image->context, image);
}

int hl_image_width(const hl_image *image) { return image == NULL ? 0 : image->width; }
int hl_image_height(const hl_image *image) { return image == NULL ? 0 : image->height; }
float *hl_image_pixels(hl_image *image) { return image == NULL ? NULL : image->pixels; }
const float *hl_image_pixels_const(const hl_image *image) { return image == NULL ? NULL : image->pixels; }
