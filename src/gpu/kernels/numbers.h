/* gpu/kernels/numbers.h - defines the numbers, functions and vectors of simd/lanes.h and view/rays_lanes.h
 * for one pixel instead of sixteen. */
#ifndef HL_GPU_NUMBERS_H
#define HL_GPU_NUMBERS_H

#include "gpu/kernels/dialect.h"

/* Two functions that return the second number if either number is NaN. */
DEVICE float lesser(float a, float b) { return a < b ? a : b; }
DEVICE float greater(float a, float b) { return a > b ? a : b; }
DEVICE float limited(float x, float low, float high) { return lesser(greater(x, low), high); }
DEVICE float magnitude(float x) { return of_bits(bits_of(x) & 0x7fffffff); }
/* The greatest integer not above x; |x| must be below 2^31. */
DEVICE int whole_below(float x) {
  int i = (int)x;
  return (float)i > x ? i - 1 : i;
}

/* lanes_exp2() */
DEVICE float power_of_two(float x) {
  int n = whole_below(x + 0.5f);
  float f = x - (float)n;
  float p = fused(f, 0.00132647273f, 0.00967151279f);
  p = fused(p, f, 0.0555073374f);
  p = fused(p, f, 0.240222421f);
  p = fused(p, f, 0.693146978f);
  p = fused(p, f, 1.0f);
  return p * of_bits((n + 127) << 23);
}

/* as lanes_exp_negative() */
DEVICE float exp_negative(float x) { return power_of_two(greater(x * -1.44269504089f, -123.0f)); }

/* lanes_log2() */
DEVICE float log_of_two(float x) {
  int bits = bits_of(x) - 0x3f3504f3;
  int n = bits >> 23;
  float m = of_bits((bits & 0x007fffff) + 0x3f3504f3);
  float t = divided(m - 1.0f, m + 1.0f), t2 = t * t;
  float series = fused(t2, 1.0f / 9, 1.0f / 7);
  series = fused(series, t2, 1.0f / 5);
  series = fused(series, t2, 1.0f / 3);
  series = fused(series, t2, 1.0f);
  return fused(t * series, 2.88539008178f, (float)n);
}

/* computes the same number as power() in render/shade_lanes.h */
DEVICE float power_of(float base, float exponent) {
  float safe = greater(base, 1e-12f);
  return base > 1e-12f ? power_of_two(greater(log_of_two(safe) * exponent, -100.0f)) : 0.0f;
}

/* lanes_power_of_part() */
DEVICE float power_of_part(float base, float exponent) {
  return power_of_two(greater(log_of_two(greater(base, 1e-6f)) * exponent, -100.0f));
}

typedef struct vector {
  float x, y, z;
} vector;

DEVICE vector vector_of(float x, float y, float z) {
  vector v;
  v.x = x;
  v.y = y;
  v.z = z;
  return v;
}
DEVICE vector vector_at(GLOBAL const float *v) { return vector_of(v[0], v[1], v[2]); }
DEVICE float dot3(vector a, vector b) { return fused(a.x, b.x, fused(a.y, b.y, a.z * b.z)); }
DEVICE vector scaled(vector a, float s) { return vector_of(a.x * s, a.y * s, a.z * s); }
DEVICE vector add(vector a, vector b) { return vector_of(a.x + b.x, a.y + b.y, a.z + b.z); }
/* a + b s */
DEVICE vector add_scaled(vector a, vector b, float s) {
  return vector_of(fused(b.x, s, a.x), fused(b.y, s, a.y), fused(b.z, s, a.z));
}
DEVICE vector cross3(vector a, vector b) {
  return vector_of(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
}
DEVICE float row_of_vector(GLOBAL const float *row, vector v) {
  return fused(v.x, row[0], fused(v.y, row[1], v.z * row[2]));
}
DEVICE float row_of_point(GLOBAL const float *row, vector p) {
  return fused(p.x, row[0], fused(p.y, row[1], fused(p.z, row[2], row[3])));
}
/* A function that is linear in pixel coordinates. */
DEVICE float linear_in_view(float at, float by_u, float by_v, float u, float v) {
  return fused(u, by_u, fused(v, by_v, at));
}
DEVICE vector linear_vector(GLOBAL const float *at, GLOBAL const float *by_u, GLOBAL const float *by_v,
                            float u, float v) {
  return vector_of(linear_in_view(at[0], by_u[0], by_v[0], u, v),
                   linear_in_view(at[1], by_u[1], by_v[1], u, v),
                   linear_in_view(at[2], by_u[2], by_v[2], u, v));
}

#endif
