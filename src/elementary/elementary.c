/* elementary/elementary.c - exponentials, logarithms, powers, roots and angles by plain arithmetic
 * (elementary.h).
 *
 * Each function reduces its argument to a short interval, on which a Taylor series is accurate. The number of
 * terms of a series is the number that double precision needs on its interval. */
#include "elementary/elementary.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* Two parts of ln 2. The first part has 32 bits, so that its product with a whole number of up to 20 bits is
 * exact. The second part is ln 2 minus the first part. */
static const double LN2_HIGH = 0x1.62e42feep-1, LN2_LOW = 0x1.a39ef35793c76p-33;

/* Three parts of pi / 2: 33 bits, the next 33 bits, and the rest. The products of the first two parts with
 * whole numbers of up to 20 bits are exact. */
static const double RIGHT_ANGLE[3] = {0x1.921fb544p+0, 0x1.0b4611a6p-34, 0x1.3198a2e037073p-69};

/* ---- the parts of a number ---- */

/* Computes 2^k for whole numbers k from -1022 to 1023. */
static double power_of_two(int k) {
  uint64_t bits = (uint64_t)(k + 1023) << 52;
  double power;
  memcpy(&power, &bits, sizeof power);
  return power;
}

/* Computes x 2^k for whole numbers k from -2044 to 2046. The number x is multiplied by two factors, because
 * 2^k itself may lie outside the range of normal numbers. */
static double scaled(double x, int k) {
  int half = k / 2;
  return x * power_of_two(half) * power_of_two(k - half);
}

/* Divides a finite x > 0 into 2^k m with 1 <= m < 2, and returns m. */
static double mantissa(double x, int *k) {
  uint64_t bits;
  int shift = 0;
  if (x < 0x1p-1022) x *= 0x1p54, shift = -54; /* makes a subnormal number normal */
  memcpy(&bits, &x, sizeof bits);
  *k = (int)(bits >> 52) - 1023 + shift;
  bits = (bits & 0x000fffffffffffff) | (uint64_t)1023 << 52;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/* The sum of coefficient[i] x^i. */
static double polynomial(const double *coefficient, int count, double x) {
  double sum = coefficient[count - 1];
  for (int i = count - 2; i >= 0; i--) sum = sum * x + coefficient[i];
  return sum;
}

/* ---- exponentials ---- */

/* Computes e^r - 1 for abs(r) <= ln 2 / 2. */
static double small_expm1(double r) {
  /* 1 / (i + 2)!, for i from 0 */
  static const double series[] = {1.0 / 2,          1.0 / 6,        1.0 / 24,        1.0 / 120,
                                  1.0 / 720,        1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                                  1.0 / 3628800,    1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800,
                                  1.0 / 87178291200};
  return r + r * r * polynomial(series, 13, r);
}

/* Derived: x = k ln 2 + r with abs(r) <= ln 2 / 2, so that e^x = 2^k e^r. */
double hl_exp(double x) {
  if (isnan(x)) return x;
  if (x > 709.8) return INFINITY;
  if (x < -745.2) return 0;
  double k = floor(x / HL_LN2 + 0.5), r = (x - k * LN2_HIGH) - k * LN2_LOW;
  return scaled(1 + small_expm1(r), (int)k);
}

double hl_exp2(double x) {
  if (isnan(x)) return x;
  if (x >= 1024) return INFINITY;
  if (x < -1075) return 0;
  double k = floor(x + 0.5);
  return scaled(1 + small_expm1((x - k) * HL_LN2), (int)k);
}

/* Derived: with x = k ln 2 + r, e^x - 1 = 2^k (e^r - 1) + (2^k - 1). For x of at least 40, the 1 is less than
 * the rounding error of e^x.
 */
double hl_expm1(double x) {
  if (x == 0 || isnan(x)) return x;
  if (x > 40) return hl_exp(x);
  if (x < -40) return -1;
  double k = floor(x / HL_LN2 + 0.5), r = (x - k * LN2_HIGH) - k * LN2_LOW, power = power_of_two((int)k);
  return power * small_expm1(r) + (power - 1);
}

/* ---- logarithms ---- */

/* Computes k ln 2 + ln(1 + f), for sqrt(1/2) <= 1 + f < sqrt(2). more: the difference of the argument and 1 +
 * f, divided by the argument. Derived: with s = f / (2 + f), ln(1 + f) = 2 artanh s = 2 s + s R, where R is
 * the sum of 2 s^(2n) / (2n + 1) from n = 1. As 2 s = f - s f and f - s f = f - f^2 / 2 + s f^2 / 2, ln(1 +
 * f) = f - (f^2 / 2 - s (f^2 / 2 + R)): the greatest term of this sum, f, is exact. */
static double ln_of_parts(double f, int k, double more) {
  static const double series[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11, 2.0 / 13,
                                  2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21, 2.0 / 23};
  double s = f / (2 + f), square = s * s, rest = square * polynomial(series, 11, square), half = 0.5 * f * f;
  return k * LN2_HIGH - ((half - (s * (half + rest) + (k * LN2_LOW + more))) - f);
}

/* Divides a finite x > 0 into 2^k (1 + f) with sqrt(1/2) <= 1 + f < sqrt(2), and returns f. */
static double centred_mantissa(double x, int *k) {
  double m = mantissa(x, k);
  if (m > 1.4142135623730951) m *= 0.5, ++*k;
  return m - 1;
}

/* Returns whether x has a logarithm that is a finite number. If the logarithm is infinite or NaN, sets *value
 * to it. */
static int has_logarithm(double x, double *value) {
  if (x > 0 && x < INFINITY) return 1;
  *value = x == 0 ? -INFINITY : x > 0 ? x : NAN;
  return 0;
}

double hl_ln(double x) {
  double value;
  int k;
  if (!has_logarithm(x, &value)) return value;
  double f = centred_mantissa(x, &k);
  return ln_of_parts(f, k, 0);
}

double hl_log1p(double x) {
  double value, sum = 1 + x;
  int k;
  if (!has_logarithm(sum, &value)) return value;
  if (fabs(x) < 0.25) return x == 0 ? x : ln_of_parts(x, 0, 0);
  /* the sum 1 + x is rounded; its rounding error is added to the argument */
  double lacking = x > 1 ? 1 - (sum - x) : x - (sum - 1), f = centred_mantissa(sum, &k);
  return ln_of_parts(f, k, lacking / sum);
}

double hl_log2(double x) {
  double value;
  int k;
  if (!has_logarithm(x, &value)) return value;
  double f = centred_mantissa(x, &k);
  return k + ln_of_parts(f, 0, 0) / HL_LN2;
}

/* Computes 10^n for whole numbers n from 0 to 22, which is exact: 5^22 has 52 bits. */
static double power_of_ten(int n) {
  double power = 1;
  while (n-- > 0) power *= 10;
  return power;
}

double hl_log10(double x) {
  double value = hl_ln(x) / 2.30258509299404568402, whole = floor(value + 0.5);
  if (!(fabs(whole) <= 22)) return value;
  double power = power_of_ten((int)fabs(whole));
  return x == (whole < 0 ? 1 / power : power) ? whole : value;
}

/* ---- powers and roots ---- */

static double whole_power(double x, int n) {
  double power = 1;
  for (; n > 0; n /= 2, x *= x)
    if (n % 2 == 1) power *= x;
  return power;
}

/* Divides x into two halves of 26 bits each: x = *high + *low (Veltkamp). abs(x): below 1e300. */
static void halves(double x, double *high, double *low) {
  double spread = x * 134217729.0; /* 2^27 + 1 */
  *high = spread - (spread - x);
  *low = x - *high;
}

/* The rounding error of a product: a b minus its rounded value `product` (Dekker). */
static double lacking_of_product(double a, double b, double product) {
  double a_high, a_low, b_high, b_low;
  halves(a, &a_high, &a_low);
  halves(b, &b_high, &b_low);
  return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
}

/* Computes x^y for a finite x > 0. Derived: with x = 2^k m, x^y = 2^(y k) e^(y ln m); the whole part of y k
 * becomes the exponent, so that the argument of the exponential stays small. */
static double power_of_positive(double x, double y) {
  int k;
  double ln = ln_of_parts(centred_mantissa(x, &k), 0, 0), product = y * k, depth = y * ln;
  if (fabs(y) > 1e15 || fabs(product + depth / HL_LN2) > 1100)
    return product * HL_LN2 + depth > 0 ? INFINITY : product * HL_LN2 + depth < 0 ? 0 : 1;
  double whole = floor(product + 0.5);
  double rest = (product - whole) + lacking_of_product(y, k, product);
  double value = hl_exp(depth + rest * HL_LN2);
  value += value * lacking_of_product(y, ln, depth);
  return scaled(value, (int)fmin(fmax(whole, -2044), 2046));
}

double hl_pow(double x, double y) {
  if (y == 0 || x == 1) return 1;
  if (isnan(x) || isnan(y)) return NAN;
  int whole = floor(y) == y, odd = whole && floor(y / 2) * 2 != y;
  if (whole && y > 0 && y <= 32) return whole_power(x, (int)y);
  double size = fabs(x), power;
  if (isinf(y)) return size == 1 ? 1 : (size > 1) == (y > 0) ? INFINITY : 0;
  if (size == 0 || isinf(size)) power = (size == 0) == (y > 0) ? 0 : INFINITY;
  else if (x < 0 && !whole) return NAN;
  else power = power_of_positive(size, y);
  return odd && signbit(x) ? -power : power;
}

/* Newton's method for m = 2^(3 j) n with 1 <= n < 8; each step squares the relative error. */
double hl_cbrt(double x) {
  if (x == 0 || isnan(x) || isinf(x)) return x;
  int k;
  double m = mantissa(fabs(x), &k), root;
  int thirds = (k + 3072) / 3 - 1024;
  m *= power_of_two(k - 3 * thirds);
  root = 0.9 + m * 0.15;
  for (int step = 0; step < 6; step++) root -= (root - m / (root * root)) / 3;
  root = scaled(root, thirds);
  return x < 0 ? -root : root;
}

double hl_hypot(double x, double y) {
  double most = fmax(fabs(x), fabs(y));
  if (isinf(x) || isinf(y)) return INFINITY;
  if (!(most < 1e150)) return sqrt(x * 0x1p-600 * (x * 0x1p-600) + y * 0x1p-600 * (y * 0x1p-600)) * 0x1p600;
  if (most < 1e-150) return sqrt(x * 0x1p600 * (x * 0x1p600) + y * 0x1p600 * (y * 0x1p600)) * 0x1p-600;
  return sqrt(x * x + y * y);
}

/* ---- angles ---- */

/* The sine of abs(r) <= pi / 4. */
static double small_sine(double r) {
  /* (-1)^(i + 1) / (2 i + 3)!, for i from 0 */
  static const double series[] = {-1.0 / 6,
                                  1.0 / 120,
                                  -1.0 / 5040,
                                  1.0 / 362880,
                                  -1.0 / 39916800.0,
                                  1.0 / 6227020800.0,
                                  -1.0 / 1307674368000.0,
                                  1.0 / 355687428096000.0};
  double square = r * r;
  return r + r * square * polynomial(series, 8, square);
}

/* The cosine of abs(r) <= pi / 4. Derived: 1 - r^2 / 2 is rounded, and the rounding error is added to the
 * small terms. */
static double small_cosine(double r) {
  /* (-1)^i / (2 i + 4)!, for i from 0 */
  static const double series[] = {1.0 / 24,
                                  -1.0 / 720,
                                  1.0 / 40320,
                                  -1.0 / 3628800,
                                  1.0 / 479001600,
                                  -1.0 / 87178291200.0,
                                  1.0 / 20922789888000.0,
                                  -1.0 / 6402373705728000.0};
  double square = r * r, half = 0.5 * square, begin = 1 - half;
  return begin + (((1 - begin) - half) + square * square * polynomial(series, 8, square));
}

/* The sine and cosine of the angle `quarter` pi / 2 + rest. */
static void turned(double rest, int64_t quarter, double *sine, double *cosine) {
  double s = small_sine(rest), c = small_cosine(rest);
  switch (quarter & 3) {
    case 0: *sine = s, *cosine = c; break;
    case 1: *sine = c, *cosine = -s; break;
    case 2: *sine = -s, *cosine = -c; break;
    default: *sine = -c, *cosine = s; break;
  }
}

static void sine_and_cosine(double x, double *sine, double *cosine) {
  if (!(fabs(x) < 1e15)) {
    *sine = *cosine = NAN;
    return;
  }
  double quarters = floor(x * (2 / HL_PI) + 0.5);
  /* the first two products and the first difference are exact; the rounding error of the second difference is
   * added */
  double first = x - quarters * RIGHT_ANGLE[0], second = quarters * RIGHT_ANGLE[1], rest = first - second;
  rest += ((first - rest) - second) - quarters * RIGHT_ANGLE[2];
  turned(rest, (int64_t)quarters, sine, cosine);
}

double hl_sin(double x) {
  double sine, cosine;
  if (x == 0) return x; /* keeps the sign of zero */
  sine_and_cosine(x, &sine, &cosine);
  return sine;
}

double hl_cos(double x) {
  double sine, cosine;
  sine_and_cosine(x, &sine, &cosine);
  return cosine;
}

double hl_tan(double x) {
  double sine, cosine;
  if (x == 0) return x;
  sine_and_cosine(x, &sine, &cosine);
  return sine / cosine;
}

void hl_sine_cosine(double angle_deg, double *sine, double *cosine) {
  double quarters = floor(angle_deg / 90 + 0.5);
  turned((angle_deg - 90 * quarters) * (HL_PI / 180), (int64_t)quarters, sine, cosine);
}

/* The arc tangent of 0 <= x <= 1. Derived: tan(a - b) = (tan a - tan b) / (1 + tan a tan b). The number tan b
 * is the nearest multiple of 1/8, whose arc tangent is in a table, so that the series is needed only for
 * arguments up to 1/16. */
static double small_atan(double x) {
  static const double known[] = {0,
                                 0.12435499454676143503,
                                 0.24497866312686415417,
                                 0.35877067027057222040,
                                 0.46364760900080611621,
                                 0.55859931534356243597,
                                 0.64350110879328438680,
                                 0.71882999962162450542,
                                 0.78539816339744830962};
  static const double series[] = {-1.0 / 3, 1.0 / 5, -1.0 / 7, 1.0 / 9, -1.0 / 11, 1.0 / 13};
  int eighth = (int)(x * 8 + 0.5);
  double b = eighth / 8.0, t = (x - b) / (1 + x * b), square = t * t;
  return known[eighth] + (t + t * square * polynomial(series, 6, square));
}

double hl_atan(double x) {
  if (isnan(x) || x == 0) return x;
  double size = fabs(x), angle = size <= 1 ? small_atan(size) : HL_PI / 2 - small_atan(1 / size);
  return x < 0 ? -angle : angle;
}

double hl_atan2(double y, double x) {
  if (isnan(x) || isnan(y)) return NAN;
  double across = fabs(y), along = fabs(x), angle;
  if (across == 0 && along == 0) angle = 0;
  else if (isinf(across) && isinf(along)) angle = HL_PI / 4;
  else if (across <= along) angle = small_atan(across / along);
  else angle = HL_PI / 2 - small_atan(along / across);
  if (signbit(x)) angle = HL_PI - angle;
  return signbit(y) ? -angle : angle;
}

/* Derived: 1 - x^2 = (1 - x) (1 + x), whose factors are accurate near 1. */
double hl_asin(double x) { return hl_atan2(x, sqrt((1 - x) * (1 + x))); }

double hl_acos(double x) { return hl_atan2(sqrt((1 - x) * (1 + x)), x); }

/* ---- the error function ---- */

/* Computes 1 - erf(x) for x >= 2 by the continued fraction exp(-x^2) / sqrt(pi) / (x + (1/2) / (x + 1 / (x +
 * (3/2) / (x + ...)))) (Abramowitz and Stegun 7.1.14). */
static double complement_of_error(double x) {
  enum { TERMS = 60 };
  double fraction = x;
  for (int n = TERMS; n >= 1; n--) fraction = x + 0.5 * n / fraction;
  return 0.56418958354775628695 * hl_exp(-x * x) / fraction;
}

enum { TERMS_OF_ERROR = 40 };

/* For x up to 2, erf(x) is computed by the Taylor series about 0, multiplied by exp(x^2) term by term: 2 /
 * sqrt(pi) exp(-x^2) sum of 2^n x^(2n + 1) / (2n + 1)!! (Abramowitz and Stegun 7.1.6). All terms of this
 * series have the same sign. */
double hl_erf(double x) {
  if (isnan(x)) return x;
  if (x > 2) return 1 - complement_of_error(x);
  if (x < -2) return complement_of_error(-x) - 1;
  double sum = 1;
  for (int n = TERMS_OF_ERROR; n >= 1; n--) sum = 1 + sum * (2 * x * x) / (2 * n + 1);
  return 1.12837916709551257390 * x * (hl_exp(-x * x) * sum);
}
