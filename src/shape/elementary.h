/* shape/elementary.h - computes exp, log, sine and cosine by plain arithmetic.
 *
 * The C library's functions differ between machines in their last bits, but shapes must have the same bytes
 * everywhere. The functions here are accurate to a few units in the last place. */
#ifndef HL_SHAPE_ELEMENTARY_H
#define HL_SHAPE_ELEMENTARY_H

#include <stdint.h>
#include <string.h>

#define HL_LN2 0.69314718055994530942

/* Computes 2^k for whole numbers k from -1022 to 1023. */
static inline double hl_power_of_two(int k) {
  uint64_t bits = (uint64_t)(k + 1023) << 52;
  double power;
  memcpy(&power, &bits, sizeof power);
  return power;
}

/* Computes e^x for x <= 0. Derived: x = k ln 2 + r with abs(r) <= ln 2 / 2, so that e^x = 2^k * (Taylor
 * series of e^r). */
static inline double hl_exp_negative(double x) {
  if (!(x > -700)) return 0;
  int k = (int)(x / HL_LN2 - 0.5);
  double r = x - k * HL_LN2, sum = 1;
  for (int n = 14; n >= 1; n--) sum = 1 + sum * r / n;
  return sum * hl_power_of_two(k);
}

/* Computes ln x for normal numbers x > 0. Derived: x = 2^k m with sqrt(1/2) <= m < sqrt(2), and ln m = 2
 * artanh((m - 1) / (m + 1)). */
static inline double hl_log(double x) {
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  int k = (int)(bits >> 52 & 0x7ff) - 1023;
  double m = x * (k < 0 ? hl_power_of_two(-k) : 1 / hl_power_of_two(k));
  if (m > 1.4142135623730951) m /= 2, k++;
  double s = (m - 1) / (m + 1), square = s * s, sum = 0;
  for (int n = 23; n >= 1; n -= 2) sum = sum * square + 1.0 / n;
  return k * HL_LN2 + 2 * s * sum;
}

/* Computes the sine and the cosine of an angle in degrees. They are exact at multiples of 90. Derived: the
 * angle is a multiple of 90 degrees plus a rest of at most 45 degrees, whose Taylor series are used.
 * angle_deg: its magnitude is at most 1e6. */
static inline void hl_sine_cosine(double angle_deg, double *sine, double *cosine) {
  int64_t quarter = (int64_t)(angle_deg / 90 + (angle_deg < 0 ? -0.5 : 0.5));
  double x = (angle_deg - 90.0 * (double)quarter) * (3.14159265358979323846 / 180), square = x * x;
  double s = 1, c = 1;
  for (int n = 18; n >= 2; n -= 2) {
    s = 1 - s * square / (n * (n + 1));
    c = 1 - c * square / (n * (n - 1));
  }
  s *= x;
  switch (quarter & 3) {
    case 0: *sine = s, *cosine = c; break;
    case 1: *sine = c, *cosine = -s; break;
    case 2: *sine = -s, *cosine = -c; break;
    default: *sine = -c, *cosine = s; break;
  }
}

#endif
