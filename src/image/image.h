/* image/image.h - defines the members of hl_image, and the functions by which readers make pictures. */
#ifndef HL_IMAGE_IMAGE_H
#define HL_IMAGE_IMAGE_H

#include <halflight/image.h>

enum {
  HL_IMAGE_SIDE_MAX = 65535,
  HL_IMAGE_EXPOSURE_MAX = 32, /* greatest exposure in either direction, in stops */
  /* greatest number of pixels that a reader accepts from a file's header: 2^28, which take 4 GiB */
  HL_IMAGE_READ_PIXELS_MAX = 1 << 28
};

enum { HL_IMAGE_LAYER_NAME = 28, HL_IMAGE_LAYER_CHANNELS = 4 };

typedef struct hl_image_layer {
  char name[HL_IMAGE_LAYER_NAME + 1];
  char channels[HL_IMAGE_LAYER_CHANNELS + 1]; /* the names of the layer's channels, one letter for each */
  float *values;                              /* owned; [height][width][channels]; the layer's values */
} hl_image_layer;

struct hl_image {
  hl_context *context;
  int width, height;
  float *pixels;          /* owned; [height][width][4]; linear premultiplied R, G, B, A; top row first */
  hl_image_layer *layers; /* owned; [layer_count]; the picture's layers */
  size_t layer_count;
};

/* Refuses a size that no picture read from a file may have; an error names the file. */
hl_status hl_image_check_size(const char *name, uint64_t width, uint64_t height, hl_error *error);

/* Creates a picture, like hl_image_create(), of a size that a file claims. An error names the file. */
hl_status hl_image_create_for_file(hl_context *context, const char *name, uint64_t width, uint64_t height,
                                   hl_image **image, hl_error *error);

#endif
