/* image.c - creation of pictures and access to their pixels.
 *
 * In: a size. Out: zeroed pixels, which the renderer or a reader (format.h) fills. Sizes are checked
 * before anything is allocated.
 */
#include "image/image.h"

#include <inttypes.h>

#include "core/memory.h"

hl_status hl_image_create(hl_context *context, int width, int height, hl_image **image, hl_error *error) {
  if (image != NULL) *image = NULL;
  if (context == NULL || image == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_create: context and image must not be null");
  if (width < 1 || height < 1 || width > HL_IMAGE_SIDE_MAX || height > HL_IMAGE_SIDE_MAX)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_create: %d x %d pixels, expected 1 to %d a side",
                   width, height, (int)HL_IMAGE_SIDE_MAX);
  size_t floats = 0;
  bool fits = hl_multiply((size_t)width * 4, (size_t)height, &floats);
  hl_image *made = hl_allocate(context, 1, sizeof *made);
  float *pixels = fits ? hl_allocate_zeroed(context, floats, sizeof *pixels) : NULL;
  if (made == NULL || pixels == NULL) {
    hl_release(context, pixels);
    hl_release(context, made);
    return hl_fail_memory(error, floats * sizeof *pixels, "a picture");
  }
  *made = (hl_image){.context = context, .width = width, .height = height, .pixels = pixels};
  *image = made;
  return HL_OK;
}

hl_status hl_image_create_for_file(hl_context *context, const char *name, uint64_t width, uint64_t height,
                                   hl_image **image, hl_error *error) {
  if (width < 1 || height < 1 || width > HL_IMAGE_SIDE_MAX || height > HL_IMAGE_SIDE_MAX)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: claims %" PRIu64 " x %" PRIu64 " pixels, expected 1 to %d a side", name, width,
                   height, (int)HL_IMAGE_SIDE_MAX);
  if (width * height > HL_IMAGE_READ_PIXELS_MAX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "%s: %" PRIu64 " x %" PRIu64
                   " pixels, more than the %d that a picture read from a file may have",
                   name, width, height, (int)HL_IMAGE_READ_PIXELS_MAX);
  return hl_image_create(context, (int)width, (int)height, image, error);
}

void hl_image_destroy(hl_image *image) {
  if (image == NULL) return;
  hl_release(image->context, image->pixels);
  hl_release(image->context, image);
}

int hl_image_width(const hl_image *image) { return image == NULL ? 0 : image->width; }
int hl_image_height(const hl_image *image) { return image == NULL ? 0 : image->height; }
float *hl_image_pixels(hl_image *image) { return image == NULL ? NULL : image->pixels; }
const float *hl_image_pixels_const(const hl_image *image) { return image == NULL ? NULL : image->pixels; }
