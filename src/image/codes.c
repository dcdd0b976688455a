/* image/codes.c - converts pixels to sRGB codes of 8 or 16 bits, for files and for the caller's memory.
 *
 * In: linear premultiplied floats, and a linear background. Out: codes of RGB over the background or, with
 * background_transparent, codes of unassociated RGBA.
 *
 * Exposure, tone, compositing and alpha division are done in linear light; the sRGB curve is applied last
 * (srgb.h).
 *
 * Codes of 8 bits are too few for smooth dark gradients such as penumbras: rounding to codes makes visible
 * contours, 10 pixels wide or wider. Errors measured on a penumbra-like gradient of 0.004 to 0.034 linear
 * over 256 x 256 pixels, after averaging 8 x 8 pixels as the eye does at a distance: rounding had an error of
 * 0.070 codes (root mean square; 0.34 at worst). An 8 x 8 ordered dither had an error of 0.020 codes (0.08 at
 * worst), and showed no contours even at raised contrast. Dithers by white noise (error 0.050) and by two
 * low-discrepancy patterns (errors 0.019 and 0.029) looked no better, and the ordered dither gives the
 * smallest files. Therefore 8-bit codes are dithered by less than half a code. The dither depends on the
 * pixel's position alone and is the same in all channels, so that greys stay grey. Values that are exact
 * codes stay unchanged, so that a PNG keeps its pixels when it is read and written again. Pixels without any
 * volume are rounded, so that a flat background stays flat. 16-bit codes are rounded. */
#include "image/codes.h"

#include <float.h>
#include <string.h>

#include "core/door.h"
#include "image/format.h"

/* The offset, in codes, of the 8 x 8 ordered (Bayer) dither at a pixel, from -63/128 to 63/128. The bits of x
 * ^ y and of y, interleaved and in reversed order, give each number of 0..63 once. */
static float dither_offset(int x, int y) {
  int order = 0;
  for (int bit = 0; bit < 3; bit++)
    order |= (((x ^ y) >> bit & 1) << (5 - 2 * bit)) | ((y >> bit & 1) << (4 - 2 * bit));
  return (float)(2 * order - 63) / 128.0f;
}

/* The nearest code of an alpha, which is linear from 0 to 1. The code of a NaN is 0. */
static int quantise(float value, int maximum, float offset) {
  if (!(value > 0)) return 0;
  if (value >= 1) return maximum;
  return (int)((float)maximum * value + offset + 0.5f);
}

static unsigned char *put_code(unsigned char *to, int code, int depth) {
  if (depth == 16) *to++ = (unsigned char)(code >> 8);
  *to++ = (unsigned char)(code & 0xff);
  return to;
}

static bool is_empty(const float pixel[4]) {
  return pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0 && pixel[3] == 0;
}

/* ---- how bright light fits into the range of a PNG ---- */

#define SHOULDER 0.6f /* light up to SHOULDER is left unchanged; the sRGB code of SHOULDER is 203 of 255 */

/* Maps light x that is brighter than the value s (SHOULDER). Derived: the hyperbola that continues the line
 * f(x) = x at s with slope 1, and approaches 1 for ever brighter light, is f(x) = 1 - d^2 / (x - s + d), d =
 * 1 - s: f(s) = s, f'(x) = d^2 / (x - s + d)^2. With f, light twice as bright as white (1) is mapped to
 * 0.911, and four times as bright to 0.958. */
static float shoulder(float x) {
  const float rest = 1 - SHOULDER;
  return x > SHOULDER ? 1 - rest * rest / (x - SHOULDER + rest) : x;
}

/* The factor by which tone mapping multiplies a light's red, green and blue. Red, green and blue have the
 * same factor, so that the hue does not change. light: linear, after the exposure. */
static float tone_factor(hl_tone tone, const float light[3]) {
  if (tone != HL_TONE_FILMIC) return 1;
  float brightest = light[0] > light[1] ? light[0] : light[1];
  if (light[2] > brightest) brightest = light[2];
  if (!(brightest > SHOULDER)) return 1;
  if (brightest > FLT_MAX) brightest = FLT_MAX;
  return shoulder(brightest) / brightest;
}

/* The factor by which a pixel's light is multiplied: the exposure, times the tone factor at the pixel's
 * brightness. */
static float factor_of(const hl_codes *codes, const float pixel[4]) {
  const float light[3] = {pixel[0] * codes->exposure, pixel[1] * codes->exposure, pixel[2] * codes->exposure};
  return codes->exposure * tone_factor(codes->tone, light);
}

/* ---- codes ---- */

/* The linear value, before encoding, of channel c of a pixel. factor: the factor by which the pixel's light
 * is multiplied. */
static float stored_value(const hl_codes *codes, const float pixel[4], float factor, int c) {
  if (!codes->transparent) return pixel[c] * factor + (1 - pixel[3]) * codes->background[c];
  /* Unassociated colour is light divided by alpha, at most 1. A pixel that emits may have more light than
   * alpha, and its colour then saturates. */
  return pixel[3] > 0 ? pixel[c] / pixel[3] * factor : 0;
}

void hl_codes_of_row(const hl_codes *codes, const float *pixels, int width, int y, unsigned char *to) {
  for (const float *pixel = pixels; pixel < pixels + 4 * (size_t)width; pixel += 4) {
    int x = (int)((pixel - pixels) / 4);
    float offset = codes->depth == 16 || is_empty(pixel) ? 0.0f : dither_offset(x, y);
    float factor = factor_of(codes, pixel);
    for (int c = 0; c < 3; c++)
      to = put_code(to, hl_srgb_encode_offset(&codes->encoder, stored_value(codes, pixel, factor, c), offset),
                    codes->depth);
    if (codes->transparent)
      to = put_code(to, quantise(pixel[3], codes->encoder.maximum, offset), codes->depth);
    else if (codes->opaque_alpha) to = put_code(to, codes->encoder.maximum, codes->depth);
  }
}

hl_status hl_codes_begin(hl_context *context, const hl_image_write_options *options, int depth,
                         hl_codes *codes, hl_error *error) {
  *codes = (hl_codes){.depth = depth, .transparent = options->background_transparent != 0};
  for (int c = 0; c < 3; c++) codes->background[c] = (float)options->background[c];
  codes->exposure = (float)hl_exposure_factor(options->exposure);
  codes->tone = options->tone;
  return hl_srgb_encoder_create(context, depth == 16 ? 65535 : 255, &codes->encoder, error);
}

void hl_codes_end(hl_codes *codes) { hl_srgb_encoder_destroy(&codes->encoder); }

hl_status hl_image_to_srgb8(const hl_image *image, const hl_image_write_options *options, uint8_t *bytes,
                            size_t row_stride, hl_error *error) {
  HL_DOOR;
  if (image == NULL || bytes == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_to_srgb8: image and bytes must not be null");
  if (row_stride < 4 * (size_t)image->width)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_image_to_srgb8: row_stride is %zu, expected 4 x width = %zu at least", row_stride,
                   4 * (size_t)image->width);
  hl_image_write_options chosen;
  hl_image_write_options_defaults(&chosen);
  if (options == NULL) options = &chosen;
  hl_status status = hl_image_check_options(options, "hl_image_to_srgb8", error);
  hl_codes codes;
  if (status == HL_OK) status = hl_codes_begin(image->context, options, 8, &codes, error);
  if (status != HL_OK) return status;
  codes.opaque_alpha = true;
  for (int y = 0; y < image->height; y++)
    hl_codes_of_row(&codes, image->pixels + (size_t)y * (size_t)image->width * 4, image->width, y,
                    bytes + (size_t)y * row_stride);
  hl_codes_end(&codes);
  return HL_OK;
}
