/* gpu/kernels.c - the kernels' functions, compiled as C17, give the bytes of the processors' functions. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fill/row_lanes.h"
#include "grid/kernel_lanes.h"

/* The kernels' names are those of the processors' functions in places. */
#define kernel_piece       device_kernel_piece
#define kernel_piece_slope device_kernel_piece_slope
#define bspline_inner      device_bspline_inner
#define bspline_outer      device_bspline_outer
#define tap_weights        device_tap_weights
#define tap_slopes         device_tap_slopes
#define fold_border        device_fold_border
#define taps_inside        device_taps_inside
#define round_to_units     device_round_to_units
#define round_weights      device_round_weights
#define row_weights        device_row_weights
#define weights_of_row     device_weights_of_row
#define slopes_of_row      device_slopes_of_row
#define split_weights      device_split_weights
#define dot3               device_dot3
#define cross3             device_cross3
#define row_of_vector      device_row_of_vector
#define row_of_point       device_row_of_point
#define linear_in_view     device_linear_in_view
#define STORAGE            1
#define BSPLINE            1
#include "gpu/kernels/taps.h"
#include "gpu/kernels/trial.h"

enum { ROUNDS = 20000 };

static uint32_t next_bits(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 32);
}

/* A random number from low to high. */
static float number_between(uint64_t *state, float low, float high) {
  return low + (high - low) * ((float)(next_bits(state) >> 8) * 0x1p-24f);
}

static void assert_same(float a, float b) { assert_memory_equal(&a, &b, sizeof a); }

static void test_functions(void **state) {
  (void)state;
  uint64_t seed = 3;
  for (int i = 0; i < ROUNDS; i++) {
    float x = number_between(&seed, -120, 120), y = number_between(&seed, 1e-20f, 1e6f);
    assert_same(power_of_two(x), lanes_exp2(lanes_set(x))[5]);
    assert_same(exp_negative(magnitude(x)), lanes_exp_negative(lanes_set(fabsf(x)))[0]);
    assert_same(log_of_two(y), lanes_log2(lanes_set(y))[15]);
    assert_int_equal(whole_below(x), lanes_floor(lanes_set(x))[3]);
    assert_same(lesser(x, y), lanes_min(lanes_set(x), lanes_set(y))[1]);
    assert_same(greater(x, y), lanes_max(lanes_set(x), lanes_set(y))[1]);
  }
  assert_same(lesser(NAN, 1), lanes_min(lanes_set(NAN), lanes_set(1))[0]);
  assert_same(greater(NAN, 1), lanes_max(lanes_set(NAN), lanes_set(1))[0]);
}

/* Weights of 16-bit voxels are split into bytes. Their sums are those of whole numbers, also with slopes. */
static void test_rows(void **state) {
  (void)state;
  uint64_t seed = 5;
  _Alignas(8) uint16_t voxels[12];
  for (int i = 0; i < ROUNDS; i++) {
    float weight[4], slope[4], t = number_between(&seed, 0, 1);
    int whole[4], slopes[4], at = (int)(next_bits(&seed) >> 30);
    int64_t sum = 0, rising = 0;
    device_tap_weights(NULL, t, weight);
    device_tap_slopes(NULL, t, slope);
    device_round_weights(weight, WEIGHT_UNITS, 1, whole);
    device_round_weights(slope, SLOPE_UNITS, 0, slopes);
    for (int v = 0; v < 12; v++) voxels[v] = (uint16_t)(next_bits(&seed) >> 16);
    for (int tap = 0; tap < 4; tap++) {
      sum += (int64_t)voxels[at + tap] * whole[tap];
      rising += (int64_t)voxels[at + tap] * slopes[tap];
    }
    const device_row_weights by_byte = device_weights_of_row(weight),
                             slopes_by_byte = device_slopes_of_row(slope);
    const byte *first = (const byte *)&voxels[at];
    const unsigned shift = shift_of_row(first);
    const row_voxels row = load_row(first - (shift >> 3), shift);
    assert_int_equal(weigh(row, by_byte), sum);
    assert_int_equal(weigh_signed(row, slopes_by_byte), rising);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_functions), cmocka_unit_test(test_rows)};
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
