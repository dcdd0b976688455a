/* gpu/plane_kernels.c - the kernels' functions for transfer functions of value and gradient, compiled as C17,
 * give the bytes of the processors' functions (fill/plane_lanes.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "fill/plane_lanes.h"

static lanes row_of_lanes(const plane_table *table, lanes3 slope) {
  (void)slopes_at; /* the header declares it; it is not called here */
  return row_of_matter(table, NULL, slope, slope, 0xffff, 1);
}
static lanes extinction_of_lanes(const plane_table *table, lanes row, lanes from, lanes to) {
  return extinction_in_row(table, row, from, to);
}
static void color_of_lanes(const plane_table *table, lanes row, const lanes shown[2], const lanes whole[2],
                           lanes color[3]) {
  color_in_row(table, row, shown, whole, 0xffff, color);
}

/* The kernels' names are those of the processors' functions in places. */
#define sums_at_column    device_sums_at_column
#define extinction_in_row device_extinction_in_row
#define colors_at_column  device_colors_at_column
#define colors_between    device_colors_between
#define color_in_row      device_color_in_row
#define dot3              device_dot3
#define cross3            device_cross3
#define row_of_vector     device_row_of_vector
#define row_of_point      device_row_of_point
#define linear_in_view    device_linear_in_view
#include "gpu/kernels/plane.h"

enum { ROUNDS = 3000, POINTS = PLAN_PLANE_FLOATS / 4 };

static uint32_t next_bits(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 32);
}

static float number_between(uint64_t *state, float low, float high) {
  return low + (high - low) * ((float)(next_bits(state) >> 8) * 0x1p-24f);
}

/* Tables of rising integrals. The first hundred columns show nothing. */
static void make_tables(float (*sums)[4], float (*color)[4], uint64_t *seed) {
  for (int at = 0; at < POINTS; at++) {
    const int column = at % PLAN_PLANE_STRIDE, some = column > 100;
    for (int i = 0; i < 4; i++) {
      sums[at][i] = some ? number_between(seed, 0, i % 2 == 0 ? 1 : 0.5f) : 0;
      color[at][i] = some ? number_between(seed, 0, 0.3f) : 0;
      if (column == 0) continue;
      if (i % 2 == 1) sums[at][i] += sums[at - 1][i];
      color[at][i] += color[at - 1][i];
    }
  }
}

static void test_planes(void **state) {
  (void)state;
  uint64_t seed = 7;
  float(*sums)[4] = calloc(2 * (size_t)POINTS, sizeof *sums), (*color)[4] = sums + POINTS;
  assert_non_null(sums);
  make_tables(sums, color, &seed);
  const plane_table table = {.sums = sums,
                             .color = color,
                             .column_scale = 0.13f,
                             .column_offset = -7,
                             .row_scale = 90,
                             .row_offset = -3,
                             .axis = HL_SECOND_GRADIENT};
  const plane_data plane = {&sums[0][0], &color[0][0], table.column_scale, table.column_offset};
  for (int round = 0; round < ROUNDS; round++) {
    lanes3 slope;
    lanes shown[2], whole[2], found[3];
    for (int lane = 0; lane < 16; lane++) {
      slope.x[lane] = number_between(&seed, -2, 2);
      slope.y[lane] = number_between(&seed, -2, 2);
      slope.z[lane] = number_between(&seed, -2, 2);
      for (int end = 0; end < 2; end++) {
        whole[end][lane] = number_between(&seed, 0, PLAN_ENTRIES);
        shown[end][lane] = end == 0 ? whole[0][lane] : whole[0][lane] + number_between(&seed, -40, 40);
      }
    }
    const lanes row = row_of_lanes(&table, slope),
                extinction = extinction_of_lanes(&table, row, shown[0], shown[1]),
                far = extinction_of_lanes(&table, row, whole[0], whole[1]);
    color_of_lanes(&table, row, (const lanes *)shown, (const lanes *)whole, found);
    for (int lane = 0; lane < 16; lane++) {
      const float own = row_of_slope(vector_of(slope.x[lane], slope.y[lane], slope.z[lane]), 90, -3);
      const vector seen = device_color_in_row(&plane, own, shown[0][lane], shown[1][lane], whole[0][lane],
                                              whole[1][lane]);
      const float numbers[6] = {own,
                                device_extinction_in_row(&plane, own, shown[0][lane], shown[1][lane]),
                                device_extinction_in_row(&plane, own, whole[0][lane], whole[1][lane]),
                                seen.x,
                                seen.y,
                                seen.z};
      const float wanted[6] = {row[lane],      extinction[lane], far[lane],
                               found[0][lane], found[1][lane],   found[2][lane]};
      assert_memory_equal(numbers, wanted, sizeof numbers);
    }
  }
  free(sums);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_planes)};
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
