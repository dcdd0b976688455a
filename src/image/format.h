/* image/format.h - what each picture format offers to hl_image_write and hl_image_read. */
#ifndef HL_IMAGE_FORMAT_H
#define HL_IMAGE_FORMAT_H

#include <stdbool.h>

#include "core/file.h"
#include "image/image.h"

/* Refuses options that cannot be; caller: the public function that errors name. */
hl_status hl_image_check_options(const hl_image_write_options *options, const char *caller, hl_error *error);

/* Encoders write the whole picture to output->file; the caller commits or aborts. Failures of the
 * file are HL_ERROR_IO lines that name output->path. */
hl_status hl_png_encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error);
hl_status hl_exr_encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error);
hl_status hl_npy_encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error);
/* One layer alone; the picture's own file leaves layers out. */
hl_status hl_npy_encode_layer(const hl_image *image, const hl_image_layer *layer, hl_output *output,
                              hl_error *error);

/* Decoders take the bytes of a whole file, which may be anything; name is what errors call it. */
hl_status hl_png_decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error);
hl_status hl_exr_decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error);
hl_status hl_npy_decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error);

/* What a file's first bytes say of the whole. */
typedef struct hl_image_claim {
  bool known; /* false: it takes more of them to tell */
  uint64_t width, height;
  uint64_t bytes; /* of pixels, without compression */
} hl_image_claim;

/* Reads no more than the header; one that is broken claims nothing: its decoder says what is wrong. */
hl_image_claim hl_png_claim(const unsigned char *bytes, size_t length);
hl_image_claim hl_exr_claim(const unsigned char *bytes, size_t length);
hl_image_claim hl_npy_claim(const unsigned char *bytes, size_t length);

/* Called by encoders before each row: tells of progress, and fails with HL_ERROR_CANCELLED. */
hl_status hl_encode_step(hl_context *context, int row, int height, hl_error *error);

/* The line for a failed write to output->file, from errno. */
hl_status hl_fail_write(hl_error *error, const hl_output *output, int system_error);

#endif
