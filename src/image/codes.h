/* image/codes.h - converts pixels to sRGB codes of 8 or 16 bits. */
#ifndef HL_IMAGE_CODES_H
#define HL_IMAGE_CODES_H

#include <stdbool.h>

#include "image/image.h"
#include "image/srgb.h"

typedef struct hl_codes {
  hl_srgb_encoder encoder;
  int depth;           /* number of bits of a code: 8 or 16 */
  bool transparent;    /* whether a pixel has four codes, of which the last one is alpha; if not, the pixel
                        * has three codes */
  bool opaque_alpha;   /* whether a pixel has four codes, but alpha is always opaque */
  float background[3]; /* colour behind the picture, linear RGB */
  float exposure;      /* the factor by which the picture's light is multiplied */
  hl_tone tone;        /* the tone mapping, which is applied after the exposure */
} hl_codes;

hl_status hl_codes_begin(hl_context *context, const hl_image_write_options *options, int depth,
                         hl_codes *codes, hl_error *error);
void hl_codes_end(hl_codes *codes);

/* Converts row y of a picture, [width][4], to codes, [width][3 or 4]. Codes of 16 bits have the greater byte
 * first. */
void hl_codes_of_row(const hl_codes *codes, const float *pixels, int width, int y, unsigned char *to);

#endif
