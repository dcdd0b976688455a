/* unit/simd_lanes.c - the functions of lanes.h and packing.h that are not the compiler's own, in the code of
 * the baseline: arithmetic, compared with the C library's in floats and doubles, and moving of lanes.
 * simd_equal.c compares the other instruction sets with the baseline. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "simd/packing.h"

static uint32_t next_random(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 32);
}

static float float_of_bits(uint32_t bits) {
  float x;
  memcpy(&x, &bits, sizeof x);
  return x;
}

/* Numbers from 1 to 2. Every float is equally likely. */
static float one_to_two(uint64_t *state) { return 1.0f + (float)(next_random(state) >> 9) * 0x1p-23f; }

/* Returns whether two floats are the same, or both NaN. */
static void assert_same(float found, float wanted, float a, float b, float c) {
  uint32_t bits[2];
  memcpy(&bits[0], &found, sizeof found);
  memcpy(&bits[1], &wanted, sizeof wanted);
  if (bits[0] == bits[1] || (found != found && wanted != wanted)) return;
  fail_msg("fma(%a, %a, %a) is %a instead of %a", (double)a, (double)b, (double)c, (double)found,
           (double)wanted);
}

static void assert_fma(lanes a, lanes b, lanes c) {
  lanes found = lanes_fma(a, b, c);
  for (int lane = 0; lane < LANES; lane++)
    assert_same(found[lane], fmaf(a[lane], b[lane], c[lane]), a[lane], b[lane], c[lane]);
}

/* Random floats of all kinds, infinite ones, subnormal ones and NaN included. */
static void test_fma_of_any(void **state) {
  (void)state;
  uint64_t random = 1;
  for (int i = 0; i < 100000; i++) {
    lanes a, b, c;
    for (int lane = 0; lane < LANES; lane++) {
      a[lane] = float_of_bits(next_random(&random));
      b[lane] = float_of_bits(next_random(&random));
      c[lane] = float_of_bits(next_random(&random));
      /* in one of two sums, both numbers matter */
      if (lane % 2 == 0)
        c[lane] = a[lane] * b[lane] * ldexpf(one_to_two(&random), (int)(next_random(&random) % 60) - 30);
    }
    assert_fma(a, b, c);
  }
}

/* Sums that lie in the middle between two floats, or so near to it that doubles cannot tell. If they were
 * rounded twice, they would be wrong. */
static void test_fma_near_the_middle(void **state) {
  (void)state;
  uint64_t random = 2;
  for (int i = 0; i < 100000; i++) {
    lanes a, b, c;
    for (int lane = 0; lane < LANES; lane++) {
      int subnormal = i % 2, scale = subnormal ? -149 : (int)(next_random(&random) % 200) - 100,
          half = (scale - 1) / 2;
      float sign = next_random(&random) % 2 == 0 ? 1.0f : -1.0f,
            odd = (float)((next_random(&random) & 0x7fffff) | 0x800000);
      float little = (float)(next_random(&random) % 4) * 0x1p-23f;
      if (subnormal) odd = (float)(next_random(&random) & 0x3ff);
      /* the sum's last bit is 2^scale, and a b is half of it, or less by about one part in 2^46 */
      c[lane] = sign * ldexpf(odd, scale);
      a[lane] = ldexpf(1.0f + little, half);
      b[lane] = ldexpf(next_random(&random) % 2 == 0 ? 1.0f - little : little - 1.0f, scale - 1 - half);
    }
    assert_fma(a, b, c);
  }
}

/* The rest of products that cancel each other, down to subnormal floats. */
static void test_fma_that_cancels(void **state) {
  (void)state;
  uint64_t random = 3;
  for (int i = 0; i < 100000; i++) {
    lanes a, b, c;
    for (int lane = 0; lane < LANES; lane++) {
      a[lane] = ldexpf(one_to_two(&random), -(int)(next_random(&random) % 70));
      b[lane] = ldexpf(one_to_two(&random), -(int)(next_random(&random) % 70));
      c[lane] = -(a[lane] * b[lane]);
    }
    assert_fma(a, b, c);
  }
}

/* lanes_exp2() and lanes_log2() are as exact as lanes.h says. If nothing attenuates light, all of it is left.
 */
static void test_powers(void **state) {
  (void)state;
  double worst = 0, worst_log = 0;
  for (int i = -1250000; i < 1250000; i += LANES) {
    lanes x;
    for (int lane = 0; lane < LANES; lane++) x[lane] = (float)(i + lane) * 1e-4f;
    lanes found = lanes_exp2(x), log = lanes_log2(found);
    for (int lane = 0; lane < LANES; lane++) {
      worst = fmax(worst, fabs((double)found[lane] / exp2((double)x[lane]) - 1));
      worst_log = fmax(worst_log,
                       fabs((double)log[lane] - log2((double)found[lane])) / fmax(1, fabs((double)x[lane])));
    }
  }
  assert_true(worst < 2e-7);
  assert_true(worst_log < 1e-6);
  assert_true(lanes_exp_negative(lanes_set(0))[0] == 1.0f);
}

/* For each choice of lanes: the lanes move to their places in their order, other lanes stay the same, and
 * moving back gives the lanes of before. */
static void test_packing(void **state) {
  (void)state;
  lanes x, into;
  for (int lane = 0; lane < LANES; lane++) {
    x[lane] = (float)(lane + 1);
    into[lane] = (float)(-1 - lane);
  }
  for (uint32_t bits = 1; bits <= 0xffff; bits++) {
    int room = LANES - __builtin_popcount(bits);
    for (int at = 0; at <= room; at += room > 1 ? room : 1) {
      lanes_packing packing = lanes_packing_of(bits, at);
      lanes packed = lanes_pack(&packing, into, x), back = lanes_unpack(&packing, packed);
      int next = at;
      for (int lane = 0; lane < LANES; lane++) {
        int chosen = (int)(bits >> lane & 1);
        if (chosen) assert_true(packed[next++] == x[lane]);
        assert_true(back[lane] == (chosen ? x[lane] : 0));
      }
      for (int lane = 0; lane < LANES; lane++)
        if (lane < at || lane >= next) assert_true(packed[lane] == into[lane]);
    }
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_fma_of_any), cmocka_unit_test(test_fma_near_the_middle),
      cmocka_unit_test(test_fma_that_cancels), cmocka_unit_test(test_powers), cmocka_unit_test(test_packing)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
