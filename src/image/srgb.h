/* image/srgb.h - computes the sRGB transfer curve (IEC 61966-2-1). Codes are exact, and all results are the
 * same on every machine. */
#ifndef HL_IMAGE_SRGB_H
#define HL_IMAGE_SRGB_H

#include <stdint.h>

#include "core/error.h"

/* Returns 2^stops, for |stops| up to 32, the same on every machine. */
double hl_exposure_factor(double stops);

/* The linear value of a value encoded by the sRGB curve, for |encoded| up to a little above 1. The function f
 * is odd: f(-c) = -f(c). */
double hl_srgb_decode(double encoded);
double hl_srgb_encode_number(double linear); /* the inverse of hl_srgb_decode(), for linear values of at least
                                              * 0 */

/* Converts linear values to codes 0..maximum by a search among the values at which the code changes. The
 * result is exact: each float gets the code to which its exact encoded value is rounded. */
typedef struct hl_srgb_encoder {
  hl_context *context;
  int maximum;      /* the greatest code: 255 or 65535 */
  float *threshold; /* owned; [maximum + 2]; element k is the least linear value whose code is k or more */
  uint16_t *first;  /* owned; [HL_SRGB_KEYS + 1]; the code at the lower end of each interval of float bits */
} hl_srgb_encoder;

/* The number of intervals of float bits: 256 for each of the 21 octaves below 1, by the upper 8 bits of the
 * mantissa. */
enum { HL_SRGB_KEYS = 21 * 256 };

hl_status hl_srgb_encoder_create(hl_context *context, int maximum, hl_srgb_encoder *encoder, hl_error *error);
void hl_srgb_encoder_destroy(hl_srgb_encoder *encoder);

/* The nearest sRGB code of a linear value. Values below 0 and NaN give the code 0; values above 1 give the
 * code `maximum`. */
int hl_srgb_encode(const hl_srgb_encoder *encoder, float linear);

/* The nearest sRGB code of a linear value whose encoded value is first changed by an offset. offset: in
 * codes, between -0.5 and 0.5. */
int hl_srgb_encode_offset(const hl_srgb_encoder *encoder, float linear, float offset);

#endif
