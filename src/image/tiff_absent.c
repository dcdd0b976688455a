/* image/tiff_absent.c - refuses to write TIFF files. Builds without libtiff have this file in place of
 * tiff.c. */
#include "image/format.h"

static hl_status encode(const hl_image *image, const hl_image_write_options *options, hl_output *output,
                        hl_error *error) {
  (void)image, (void)options;
  return hl_fail(error, HL_ERROR_UNSUPPORTED,
                 "%s: this build has no libtiff: write a .png, or build with -Dtiff=enabled", output->path);
}

const hl_image_format hl_tif_format = {
    .extension = ".tif", .title = "TIFF", .missing = "libtiff", .encode = encode};
const hl_image_format hl_tiff_format = {
    .extension = ".tiff", .title = "TIFF", .missing = "libtiff", .encode = encode};
