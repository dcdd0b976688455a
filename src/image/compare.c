/* image/compare.c - finds the differences of two pictures.
 *
 * In: two pictures of the same size. Out: hl_image_difference. The first pass over the pixels finds the sums
 * and the greatest difference. Two more passes find the percentile by counting the bits of the differences as
 * floats, because the bits of floats have the order of the numbers. The first pass for the percentile counts
 * the upper 16 bits of the differences, and the second pass counts the lower 16 bits. The comparison
 * therefore needs no buffer of the picture's size, and its time does not depend on the data. */
#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/memory.h"
#include "image/image.h"

/* Returns the difference b - a of two values. Equal values differ by 0, even if they are infinite. A NaN in
 * either picture counts as an infinite difference, so that no limit accepts it. */
static double channel_difference(float a, float b) {
  if (a == b) return 0;
  double difference = (double)b - (double)a;
  return isnan(difference) ? INFINITY : difference;
}

static double pixel_difference(const float a[4], const float b[4]) {
  double greatest = 0;
  for (int c = 0; c < 4; c++) greatest = fmax(greatest, fabs(channel_difference(a[c], b[c])));
  return greatest;
}

static uint32_t difference_bits(const float a[4], const float b[4]) {
  float rounded = (float)pixel_difference(a, b);
  uint32_t bits;
  memcpy(&bits, &rounded, sizeof bits);
  return bits;
}

/* Finds 16 bits of the difference with the rank *rank in rising order. If `high` is negative, finds the upper
 * 16 bits among all pixels; otherwise finds the lower 16 bits among the pixels whose upper 16 bits are
 * `high`. *rank becomes the difference's rank among the pixels that have the found bits. */
static uint32_t select_half(const hl_image *a, const hl_image *b, int64_t high, uint64_t *rank,
                            uint64_t *counts) {
  size_t pixels = (size_t)a->width * (size_t)a->height;
  memset(counts, 0, 65536 * sizeof *counts);
  for (size_t i = 0; i < pixels; i++) {
    uint32_t bits = difference_bits(a->pixels + 4 * i, b->pixels + 4 * i);
    if (high < 0) counts[bits >> 16]++;
    else if ((int64_t)(bits >> 16) == high) counts[bits & 0xffff]++;
  }
  uint32_t half = 0;
  while (*rank >= counts[half]) *rank -= counts[half++];
  return half;
}

/* The percentile of the differences by nearest rank: the least difference that at least 99.9 % of the pixels
 * do not exceed. */
static double percentile_99_9(const hl_image *a, const hl_image *b, uint64_t *counts) {
  uint64_t pixels = (uint64_t)a->width * (uint64_t)a->height;
  uint64_t rank = (pixels * 999 + 999) / 1000 - 1;
  uint32_t high = select_half(a, b, -1, &rank, counts);
  uint32_t bits = high << 16 | select_half(a, b, high, &rank, counts);
  float value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

static void measure(const hl_image *a, const hl_image *b, hl_image_difference *difference) {
  double sum[4] = {0}, square[4] = {0};
  for (int y = 0; y < a->height; y++)
    for (int x = 0; x < a->width; x++) {
      size_t at = 4 * ((size_t)y * (size_t)a->width + (size_t)x);
      double greatest = 0;
      for (int c = 0; c < 4; c++) {
        double d = channel_difference(a->pixels[at + (size_t)c], b->pixels[at + (size_t)c]);
        sum[c] += d;
        square[c] += d * d;
        greatest = fmax(greatest, fabs(d));
      }
      difference->differing_pixels += greatest > 0;
      if (greatest > difference->maximum) {
        difference->maximum = greatest;
        difference->maximum_x = x;
        difference->maximum_y = y;
      }
    }
  double pixels = (double)a->width * (double)a->height;
  for (int c = 0; c < 4; c++) {
    /* the sum of infinite differences of opposite signs is NaN */
    difference->mean_signed[c] = isnan(sum[c]) ? INFINITY : sum[c] / pixels;
    difference->rmse_channel[c] = sqrt(square[c] / pixels);
  }
  difference->rmse = sqrt((square[0] + square[1] + square[2] + square[3]) / (4 * pixels));
}

hl_status hl_image_compare(const hl_image *a, const hl_image *b, hl_image_difference *difference,
                           hl_error *error) {
  HL_DOOR;
  if (a == NULL || b == NULL || difference == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_image_compare: a, b and difference must not be null");
  if (difference->struct_size != sizeof *difference)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_image_compare: struct_size is %zu, expected %zu: set it before the call",
                   difference->struct_size, sizeof *difference);
  if (a->width != b->width || a->height != b->height)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "pictures of different size cannot be compared: %d x %d against %d x %d", a->width,
                   a->height, b->width, b->height);
  uint64_t *counts = hl_allocate(a->context, 65536, sizeof *counts);
  if (counts == NULL) return hl_fail_memory(error, 65536 * sizeof *counts, "comparing pictures");
  *difference = (hl_image_difference){.struct_size = sizeof *difference};
  measure(a, b, difference);
  difference->percentile_99_9 = fmin(percentile_99_9(a, b, counts), difference->maximum);
  hl_release(a->context, counts);
  return HL_OK;
}
