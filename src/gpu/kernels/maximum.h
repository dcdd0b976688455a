/* gpu/kernels/maximum.h - finds the greatest value along a pixel's ray (maximum projection). The functions
 * compute for one pixel and one volume the same numbers as render/maximum_lanes.h for sixteen pixels and
 * several volumes. */
#ifndef HL_GPU_MAXIMUM_H
#define HL_GPU_MAXIMUM_H

#include "gpu/kernels/rays.h"

/* The greatest value between low and high that the transfer function shows. All values are coordinates in the
 * volume's tables. A result below 0 means that no value is shown. shown: the table of shown values
 * (plan/shown_values.h). */
DEVICE float greatest_shown(GLOBAL const float *shown, float low, float high) {
  GLOBAL const float *row = shown + 4 * (int)high;
  const float value = high > row[PLAN_SHOWN_FROM] ? lesser(high, row[PLAN_SHOWN_TO]) : row[PLAN_SHOWN_BELOW];
  return value >= low ? value : -1.0f;
}

/* The peak of the parabola through the values p, a, b on three successive sheets, if a is the greatest of the
 * three; otherwise a. */
DEVICE float peak_of_three(float p, float a, float b) {
  const float bend = fused(a, 2.0f, -(p + b)), slope = b - p;
  const float rise = divided(slope * slope, greater(bend * 8.0f, 1e-20f));
  const int peaks = a >= p && a >= b && bend > 1e-6f;
  return limited(a + (peaks ? rise : 0.0f), 0.0f, PLAN_ENTRIES);
}

/* The part of the way through a slab that lies behind the walls of a mesh of cells. first, last: the depths
 * behind the walls on the slab's two sheets. part: the part of the way that the box and cuts leave. */
DEVICE covered_span part_within_walls(float first, float last, covered_span part) {
  const int enters = first < 0.0f && last >= 0.0f, leaves = first >= 0.0f && last < 0.0f,
            without = first < 0.0f && last < 0.0f;
  const float wall = divided(first, enters || leaves ? first - last : 1.0f);
  covered_span within;
  within.begin = enters ? greater(part.begin, wall) : part.begin;
  float end = part.begin + part.length;
  if (leaves) end = lesser(end, wall);
  within.length = without ? 0.0f : greater(end - within.begin, 0.0f);
  return within;
}

/* The state of a pixel of a maximum projection: the numbers of the same meaning in render/slab.h
 * (MAXIMUM_GREATEST and so on). */
typedef struct ray_maximum {
  float greatest, before, sheet;
} ray_maximum;

/* Takes the values of a slab into account. sheet: the slab's last sheet. a, b: the values at the two ends of
 * the slab's covered part. length: of this part; 0 if the slab lies behind the eye. Returns whether the slab
 * shows any value. */
DEVICE int take_slab(GLOBAL const float *shown, int sheet, float a, float b, float length, ray_maximum *ray) {
  const int whole = length > 0.999f, follows = whole && ray->sheet == (float)(sheet - 1);
  const float low = lesser(a, b);
  float high = greater(a, b), value = -1.0f;
  if (follows) high = greater(high, peak_of_three(ray->before, a, b));
  if (length > 0.0f) value = greatest_shown(shown, low, high);
  ray->greatest = greater(ray->greatest, value);
  ray->before = a;
  ray->sheet = whole ? (float)sheet : -1.0f;
  return value >= 0.0f;
}

#endif
