/* tests/unit/elementary.c - tests exponentials, logarithms, powers and angles against the C library's
 * functions of `long double`, and holds their bits. */
#include "elementary/elementary.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define COUNT(array) (int)(sizeof(array) / sizeof(array)[0])

static double random_number(uint64_t *seed) {
  *seed = *seed * 6364136223846793005u + 1442695040888963407u;
  return (double)(*seed >> 11) * 0x1p-53;
}

/* A function of one number, the C library's function of `long double`, the interval on which they are
 * compared, and the greatest error in units of the last place. */
typedef struct compared {
  const char *name;
  double (*own)(double);
  long double (*right)(long double);
  double low, high, units;
} compared;

static const compared FUNCTIONS[] = {
    {"exp", hl_exp, expl, -740, 709, 1},
    {"exp", hl_exp, expl, -2, 2, 1},
    {"exp2", hl_exp2, exp2l, -1070, 1023, 1},
    {"exp2", hl_exp2, exp2l, -2, 2, 1},
    {"expm1", hl_expm1, expm1l, -40, 40, 2},
    {"expm1", hl_expm1, expm1l, -1, 1, 2},
    {"expm1", hl_expm1, expm1l, -1e-6, 1e-6, 1},
    {"ln", hl_ln, logl, 0, 1e300, 1},
    {"ln", hl_ln, logl, 0, 3, 1},
    {"ln", hl_ln, logl, 0.99, 1.01, 1},
    {"log1p", hl_log1p, log1pl, -1, 1, 2},
    {"log1p", hl_log1p, log1pl, -1e-3, 1e-3, 1},
    {"log1p", hl_log1p, log1pl, 0, 1e9, 1},
    {"log2", hl_log2, log2l, 0, 10, 2},
    {"log10", hl_log10, log10l, 0, 1e6, 3},
    {"cbrt", hl_cbrt, cbrtl, -1000, 1000, 1},
    {"sin", hl_sin, sinl, -4, 4, 2},
    {"sin", hl_sin, sinl, -1e6, 1e6, 2},
    {"cos", hl_cos, cosl, -4, 4, 2},
    {"cos", hl_cos, cosl, -1e6, 1e6, 2},
    {"tan", hl_tan, tanl, -4, 4, 3},
    {"asin", hl_asin, asinl, -1, 1, 3},
    {"acos", hl_acos, acosl, -1, 1, 3},
    {"atan", hl_atan, atanl, -20, 20, 2},
    {"atan", hl_atan, atanl, -1, 1, 2},
    {"erf", hl_erf, erfl, -6, 6, 4},
};

/* The difference of two numbers in units of the last place of `right`. */
static double units_between(double own, long double right) {
  int exponent;
  frexpl(right, &exponent);
  long double unit = ldexpl(1, (exponent < -1021 ? -1021 : exponent) - 53);
  return (double)(fabsl((long double)own - right) / unit);
}

static void values_are_accurate(void **state) {
  (void)state;
  if (LDBL_MANT_DIG < 64) skip(); /* here long double is no better than double */
  uint64_t seed = 4;
  for (int f = 0; f < COUNT(FUNCTIONS); f++) {
    const compared *of = &FUNCTIONS[f];
    double worst = 0, at = 0;
    for (int n = 0; n < 20000; n++) {
      double x = of->low + (of->high - of->low) * random_number(&seed);
      double units = units_between(of->own(x), of->right(x));
      if (units > worst) worst = units, at = x;
    }
    if (worst > of->units) fail_msg("%s(%.17g): %.2f units of the last place", of->name, at, worst);
  }
}

static void values_of_two_numbers_are_accurate(void **state) {
  (void)state;
  if (LDBL_MANT_DIG < 64) skip();
  uint64_t seed = 5;
  double worst[3] = {0};
  for (int n = 0; n < 50000; n++) {
    double x = random_number(&seed), y = 12 * random_number(&seed) - 6, z = random_number(&seed) - 0.5;
    double base = n % 2 == 0 ? x : exp2(100 * x - 50);
    worst[0] = fmax(worst[0], units_between(hl_pow(base, y), powl(base, y)));
    worst[1] = fmax(worst[1], units_between(hl_hypot(x, y), hypotl(x, y)));
    worst[2] = fmax(worst[2], units_between(hl_atan2(y, z), atan2l(y, z)));
  }
  if (worst[0] > 4 || worst[1] > 1.5 || worst[2] > 2)
    fail_msg("pow %.2f, hypot %.2f, atan2 %.2f units of the last place", worst[0], worst[1], worst[2]);
}

static void whole_values_are_exact(void **state) {
  (void)state;
  for (int n = -22; n <= 22; n++) {
    assert_true(hl_log10(n < 0 ? 1 / hl_pow(10, -n) : hl_pow(10, n)) == n);
    assert_true(hl_exp2(n) == ldexp(1, n) && hl_log2(ldexp(1, n)) == n && hl_pow(2, n) == ldexp(1, n));
    assert_true(hl_cbrt((double)n * n * n) == n);
    assert_true(hl_hypot(3 * n, 4 * n) == 5 * abs(n));
  }
  assert_true(hl_pow(10, 15) == 1e15 && hl_pow(-3, 3) == -27 && hl_pow(0.25, 0.5) == 0.5);
  assert_true(hl_exp(0) == 1 && hl_ln(1) == 0 && hl_cos(0) == 1 && hl_acos(1) == 0 && hl_acos(-1) == HL_PI);
  double s, c;
  hl_sine_cosine(-270, &s, &c);
  assert_true(s == 1 && c == 0);
  hl_sine_cosine(30, &s, &c);
  assert_true(fabs(s - 0.5) < 1e-16);
}

/* Returns whether two numbers are the same: both no number, or the same value with the same sign. */
static int same(double a, double b) { return (isnan(a) && isnan(b)) || (a == b && signbit(a) == signbit(b)); }

static void special_values_are_those_of_the_standard(void **state) {
  (void)state;
  static const double SPECIAL[] = {0,   -0.0, 1,        -1,        2,   3,      -3,    0.5,   -0.5,
                                   1.5, -1.5, INFINITY, -INFINITY, NAN, 1e-320, 1e308, -1e308};
  static const struct {
    const char *name;
    double (*own)(double), (*right)(double);
  } OF_ONE[] = {{"exp", hl_exp, exp},       {"exp2", hl_exp2, exp2},    {"expm1", hl_expm1, expm1},
                {"ln", hl_ln, log},         {"log1p", hl_log1p, log1p}, {"log2", hl_log2, log2},
                {"log10", hl_log10, log10}, {"cbrt", hl_cbrt, cbrt},    {"asin", hl_asin, asin},
                {"acos", hl_acos, acos},    {"atan", hl_atan, atan},    {"erf", hl_erf, erf}};
  for (int i = 0; i < COUNT(SPECIAL); i++) {
    double x = SPECIAL[i];
    for (int f = 0; f < COUNT(OF_ONE); f++) {
      double own = OF_ONE[f].own(x), right = OF_ONE[f].right(x);
      if (!same(own, right) && !(fabs(own - right) <= 4e-16 * fabs(right)))
        fail_msg("%s(%g): %.17g for %.17g", OF_ONE[f].name, x, own, right);
    }
    for (int k = 0; k < COUNT(SPECIAL); k++) {
      double y = SPECIAL[k];
      const double own[] = {hl_pow(x, y), hl_atan2(x, y), hl_hypot(x, y)},
                   right[] = {pow(x, y), atan2(x, y), hypot(x, y)};
      for (int f = 0; f < 3; f++)
        if (!same(own[f], right[f]) && !(fabs(own[f] - right[f]) <= 1e-13 * fabs(right[f])))
          fail_msg("function %d of %g and %g: %.17g for %.17g", f, x, y, own[f], right[f]);
    }
  }
  assert_true(isnan(hl_sin(INFINITY)) && isnan(hl_cos(NAN)) && same(hl_sin(-0.0), -0.0) &&
              same(hl_tan(-0.0), -0.0));
}

/* Adds the bits of a number to a sum over all numbers (FNV-1a). */
static void add_bits(uint64_t *sum, double value) {
  uint64_t bits;
  memcpy(&bits, &value, sizeof bits);
  for (int byte = 0; byte < 8; byte++) *sum = (*sum ^ (bits >> (8 * byte) & 255)) * 1099511628211u;
}

static void bits_are_the_same_on_every_machine(void **state) {
  (void)state;
  uint64_t seed = 6, sum = 14695981039346656037u;
  for (int n = 0; n < 2000; n++) {
    for (int f = 0; f < COUNT(FUNCTIONS); f++)
      add_bits(&sum, FUNCTIONS[f].own(FUNCTIONS[f].low +
                                      (FUNCTIONS[f].high - FUNCTIONS[f].low) * random_number(&seed)));
    double x = 3 * random_number(&seed), y = 12 * random_number(&seed) - 6;
    add_bits(&sum, hl_pow(x, y));
    add_bits(&sum, hl_atan2(y, x - 1));
    add_bits(&sum, hl_hypot(x, y));
  }
  if (sum != UINT64_C(0x58ac722fd01905c5)) fail_msg("the bits' sum is 0x%" PRIx64, sum);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_are_accurate),
      cmocka_unit_test(values_of_two_numbers_are_accurate),
      cmocka_unit_test(whole_values_are_exact),
      cmocka_unit_test(special_values_are_those_of_the_standard),
      cmocka_unit_test(bits_are_the_same_on_every_machine),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
