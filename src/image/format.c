/* image/format.c - checks the options for writing pictures, reports progress, and reports failed writes, for
 * the encoders of all formats. */
#include "image/format.h"

#include <math.h>
#include <string.h>

#include "core/context.h"

void hl_image_write_options_defaults(hl_image_write_options *options) {
  if (options == NULL) return;
  memset(options, 0, sizeof *options);
  options->struct_size = sizeof *options;
  options->png_depth = 8;
}

hl_status hl_image_check_options(const hl_image_write_options *options, const char *caller, hl_error *error) {
  if (options->struct_size != sizeof *options)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "%s: struct_size is %zu, expected %zu: call hl_image_write_options_defaults first", caller,
                   options->struct_size, sizeof *options);
  if (options->png_depth != 8 && options->png_depth != 16)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: png_depth is %d, expected 8 or 16", caller,
                   options->png_depth);
  if (!(fabs(options->exposure) <= HL_IMAGE_EXPOSURE_MAX))
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: exposure is %g, expected stops from -%d to %d", caller,
                   options->exposure, (int)HL_IMAGE_EXPOSURE_MAX, (int)HL_IMAGE_EXPOSURE_MAX);
  if (options->tone != HL_TONE_CLIP && options->tone != HL_TONE_FILMIC)
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: tone is %d, expected an hl_tone", caller,
                   (int)options->tone);
  if (options->pixels_per_inch != 0 && !(options->pixels_per_inch >= 1 && options->pixels_per_inch <= 1e5))
    return hl_fail(error, HL_ERROR_ARGUMENT, "%s: pixels_per_inch is %g, expected 0 or 1 to 100000", caller,
                   options->pixels_per_inch);
  for (int c = 0; c < 3; c++)
    if (!isfinite(options->background[c]))
      return hl_fail(error, HL_ERROR_ARGUMENT, "%s: background[%d] is not a finite number", caller, c);
  return HL_OK;
}

hl_status hl_encode_step(hl_context *context, int row, int height, hl_error *error) {
  if (row % 16 == 0) hl_progress(context, "write", (double)row / height);
  if (hl_cancelled(context)) return hl_fail(error, HL_ERROR_CANCELLED, "cancelled while writing a picture");
  return HL_OK;
}

hl_status hl_fail_write(hl_error *error, const hl_output *output, int system_error) {
  return hl_fail(error, HL_ERROR_IO, "%s: cannot write: %s", output->path,
                 system_error != 0 ? strerror(system_error) : "the file took less than was given");
}
