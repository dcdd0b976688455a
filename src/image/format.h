/* image/format.h - declares the interface by which hl_image_write() and hl_image_read() call the formats of
 * pictures, and the functions that encoders share.
 *
 * The list of all formats is in files.c. */
#ifndef HL_IMAGE_FORMAT_H
#define HL_IMAGE_FORMAT_H

#include <stdbool.h>

#include "core/file.h"
#include "image/image.h"

/* The size that a picture's file claims in its first bytes. */
typedef struct hl_image_claim {
  bool known; /* whether the size was found; if false, more bytes of the file are needed */
  uint64_t width, height;
  uint64_t bytes;                    /* number of bytes of the pixels, uncompressed */
  int channels, bits;                /* see hl_image_about */
  char layers[HL_IMAGE_LAYERS_TEXT]; /* see hl_image_about */
} hl_image_claim;

typedef struct hl_image_format {
  const char *extension, *title;
  /* the name of the library that the format needs and this build lacks; null if no library is missing */
  const char *missing;
  unsigned char mark[8]; /* the first bytes of every file of the format */
  size_t mark_length;

  /* Writes the whole picture to output->file. Null if the format can only be read. The caller commits or
   * aborts the output. If writing fails, the error is HL_ERROR_IO with a line that names output->path. */
  hl_status (*encode)(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                      hl_error *error);

  /* Decodes a file from its bytes, which may be anything; name: the file's name in errors. Null if the
   * format can only be written. */
  hl_status (*decode)(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                      hl_image **image, hl_error *error);

  /* Reads the size of a picture from the header of its file. If the header is broken, `known` of the result
   * is false, and decode() reports the error later. */
  hl_image_claim (*claim)(const unsigned char *bytes, size_t length);

  bool holds_layers; /* whether `encode` also writes the layers of a picture */

  /* Writes one layer of a picture as a file of its own. Null if the format cannot hold a single layer. */
  hl_status (*encode_layer)(const hl_image *image, const hl_image_layer *layer, hl_output *output,
                            hl_error *error);
} hl_image_format;

extern const hl_image_format hl_png_format, hl_exr_format, hl_npy_format, hl_hdr_format, hl_tif_format,
    hl_tiff_format;

/* Returns whether a picture's file, which may be anything, has the text chunk of a scene. */
bool hl_png_has_scene(const unsigned char *bytes, size_t length);

/* Refuses impossible options for writing a picture. caller: the public function's name, for errors. */
hl_status hl_image_check_options(const hl_image_write_options *options, const char *caller, hl_error *error);

/* Reports progress before an encoder writes row `row`. Fails with HL_ERROR_CANCELLED if the user has
 * cancelled. */
hl_status hl_encode_step(hl_context *context, int row, int height, hl_error *error);

/* Reports, from errno, that writing to output->file has failed. */
hl_status hl_fail_write(hl_error *error, const hl_output *output, int system_error);

#endif
