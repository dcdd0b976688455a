/* image/srgb.c - computes the sRGB transfer curve (IEC 61966-2-1).
 *
 * In: linear floats or whole codes. Out: codes or linear floats. The readers and writers of pictures use
 * these functions. The functions use only the four basic operations, square roots and comparisons. The C
 * library's pow() is not used, because its last bit differs between machines, and pictures must not. */
#include "image/srgb.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "elementary/elementary.h"

/* Finds the root of r^5 = value by seven steps of Newton's method. The root has double precision for values
 * in [0.008, 1.02], because the guess is wrong by at most 31 %, and each step squares the relative error. */
static double fifth_root(double value, double guess) {
  double r = guess;
  for (int step = 0; step < 7; step++) {
    double r2 = r * r;
    r = (4 * r + value / (r2 * r2)) / 5;
  }
  return r;
}

/* Finds 2^stops by square roots. Derived: with the fraction's binary digits b1 b2 ..., 2^0.b1b2... is the
 * product of 2^(1/2) if b1 is 1, 2^(1/4) if b2 is 1, and so on. Unlike powers, square roots are correctly
 * rounded on every machine. */
double hl_exposure_factor(double stops) {
  double whole = floor(stops), fraction = stops - whole, root = 2, factor = 1;
  for (int digit = 0; digit < 53 && fraction > 0; digit++) {
    root = sqrt(root);
    fraction *= 2;
    if (fraction < 1) continue;
    fraction -= 1;
    factor *= root;
  }
  return ldexp(factor, (int)whole);
}

/* The sRGB curve of IEC 61966-2-1: a code c stands for the linear value c/12.92 if c is at most 0.04045, else
 * for ((c + 0.055)/1.055)^2.4. The power is computed as u^2.4 = u^2 (u^2)^(1/5). */
double hl_srgb_decode(double encoded) {
  if (encoded < 0) return -hl_srgb_decode(-encoded);
  if (encoded <= 0.04045) return encoded / 12.92;
  double u = (encoded + 0.055) / 1.055, square = u * u;
  return square * fifth_root(square, 0.45 + 0.55 * u);
}

double hl_srgb_encode_number(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * hl_pow(linear, 1 / 2.4) - 0.055;
}

/* The least float that is at least as great as a double. */
static float float_at_least(double value) {
  float rounded = (float)value;
  return rounded < value ? nextafterf(rounded, INFINITY) : rounded;
}

static float float_from_bits(uint32_t bits) {
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

enum {
  KEY_SHIFT = 15,
  KEY_OF_ONE = 127 << 8
}; /* the key of a float x is (the bits of x >> KEY_SHIFT) - (KEY_OF_ONE - HL_SRGB_KEYS) */

hl_status hl_srgb_encoder_create(hl_context *context, int maximum, hl_srgb_encoder *encoder,
                                 hl_error *error) {
  *encoder = (hl_srgb_encoder){.context = context, .maximum = maximum};
  size_t thresholds = (size_t)maximum + 2;
  encoder->threshold = hl_allocate(context, thresholds, sizeof *encoder->threshold);
  encoder->first = hl_allocate(context, HL_SRGB_KEYS + 1, sizeof *encoder->first);
  if (encoder->threshold == NULL || encoder->first == NULL) {
    hl_srgb_encoder_destroy(encoder);
    return hl_fail_memory(error, thresholds * sizeof *encoder->threshold, "the sRGB curve");
  }
  /* derived: round(maximum * encode(x)) >= k holds if and only if x >= decode((k - 0.5) / maximum) */
  for (size_t k = 0; k < thresholds; k++)
    encoder->threshold[k] = float_at_least(hl_srgb_decode(((double)k - 0.5) / maximum));
  int code = 0;
  for (uint32_t key = 0; key <= HL_SRGB_KEYS; key++) {
    float lowest = float_from_bits((KEY_OF_ONE - HL_SRGB_KEYS + key) << KEY_SHIFT);
    while (code < maximum && lowest >= encoder->threshold[code + 1]) code++;
    encoder->first[key] = (uint16_t)code;
  }
  return HL_OK;
}

void hl_srgb_encoder_destroy(hl_srgb_encoder *encoder) {
  hl_release(encoder->context, encoder->threshold);
  hl_release(encoder->context, encoder->first);
  encoder->threshold = NULL;
  encoder->first = NULL;
}

int hl_srgb_encode(const hl_srgb_encoder *encoder, float linear) {
  /* for a NaN the comparison is false, too, so that the code of a NaN is 0 */
  if (!(linear >= encoder->threshold[1])) return 0;
  if (linear >= 1) return encoder->maximum;
  uint32_t bits;
  memcpy(&bits, &linear, sizeof bits);
  uint32_t key = (bits >> KEY_SHIFT) - (KEY_OF_ONE - HL_SRGB_KEYS);
  int low = encoder->first[key], high = encoder->first[key + 1];
  while (low < high) {
    int middle = (low + high + 1) / 2;
    if (linear >= encoder->threshold[middle]) low = middle;
    else high = middle - 1;
  }
  return low;
}

int hl_srgb_encode_offset(const hl_srgb_encoder *encoder, float linear, float offset) {
  int code = hl_srgb_encode(encoder, linear);
  if (!(linear > 0) || linear >= 1) return code;
  /* Between two steps the curve differs from a straight line by less than a hundredth of a code. */
  float low = encoder->threshold[code], high = encoder->threshold[code + 1];
  float place = (linear - low) / (high - low) + offset;
  if (place < 0) return code > 0 ? code - 1 : 0;
  return place >= 1 && code < encoder->maximum ? code + 1 : code;
}
