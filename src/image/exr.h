/* image/exr.h - writes OpenEXR files of any number of named float channels. */
#ifndef HL_IMAGE_EXR_H
#define HL_IMAGE_EXR_H

#include "core/file.h"

/* A channel of a picture that is written. Its value at pixel (x, y), linear, is values[(y * width + x) *
 * pixel_stride]. Channels of layers are named "layer.R" and so on. */
typedef struct hl_exr_channel {
  const char *name;
  const float *values; /* the values of the channel; borrowed */
  size_t pixel_stride; /* number of floats from one pixel to the next */
} hl_exr_channel;

/* Writes width x height pixels of all channels to output->file as an OpenEXR file: scanlines of 32-bit
 * floats, compressed by ZIP. */
hl_status hl_exr_encode_channels(int width, int height, const hl_exr_channel *channels, size_t channel_count,
                                 hl_output *output, hl_error *error);

#endif
