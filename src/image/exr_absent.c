/* image/exr_absent.c - refuses OpenEXR files, in builds without OpenEXR. */
#include "image/format.h"

static hl_status encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error) {
  (void)image, (void)options;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: an OpenEXR file, and this build has no OpenEXR: write .png or .npy", output->path);
}

static hl_status decode(hl_context *context, const char *name, const unsigned char *bytes, size_t length,
                        hl_image **image, hl_error *error) {
  (void)context, (void)bytes, (void)length, (void)image;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: an OpenEXR file, and this build has no OpenEXR: convert it to .hdr or .npy", name);
}

static hl_image_claim claim(const unsigned char *bytes, size_t length) {
  (void)bytes;
  /* the size has no effect, because decode() refuses the file */
  return (hl_image_claim){.known = true, .width = 1, .height = 1, .bytes = length};
}

const hl_image_format hl_exr_format = {.extension = ".exr",
                                       .title = "OpenEXR",
                                       .missing = "OpenEXR",
                                       .mark = {0x76, 0x2f, 0x31, 0x01},
                                       .mark_length = 4,
                                       .encode = encode,
                                       .decode = decode,
                                       .claim = claim,
                                       .holds_layers = true};
