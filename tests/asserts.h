/* tests/asserts.h - cmocka, with what it needs before it, and assertions that it lacks. */
#ifndef HL_TESTS_ASSERTS_H
#define HL_TESTS_ASSERTS_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* Fails, at the caller's line, where value differs from expected by more than the tolerance or is NaN. */
#define assert_near(value, expected, tolerance) assert_near_at(value, expected, tolerance, __FILE__, __LINE__)

static inline void assert_near_at(double value, double expected, double tolerance, const char *file,
                                  int line) {
  if (fabs(value - expected) <= tolerance) return;
  print_error("%.9g is not within %g of %.9g\n", value, tolerance, expected);
  _fail(file, line);
}

#endif
