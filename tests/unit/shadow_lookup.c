/* unit/shadow_lookup.c - how a shadow buffer is read between its pixels, as the baseline builds it.
 * simd_equal.c holds the other instruction sets to it. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "shadow/shadow_lookup_lanes.h"
#include "simd/gathers.h"

enum { SIDE = 32, MARGIN = 4, STRIDE = SIDE + 2 * MARGIN };

/* The value of a buffer's pixel is this function of the pixel's middle. */
typedef double surface(double u, double v);

static double plane(double u, double v) { return 0.2 + 0.006 * u + 0.011 * v; }
static double square(double u, double v) { return 0.1 + 0.0003 * u * u - 0.0002 * u * v + 0.0005 * v * v; }
static double edge(double u, double v) { return u + 0.3 * v < 20 ? 0 : 1; }

static shadow_map map_of_buffer(void) {
  return (shadow_map){.stride = STRIDE, .width = SIDE, .height = SIDE};
}

/* Pixel (0,0). */
static const float *fill(float *pixels, surface *of) {
  for (int y = -MARGIN; y < SIDE + MARGIN; y++)
    for (int x = -MARGIN; x < SIDE + MARGIN; x++)
      pixels[(y + MARGIN) * STRIDE + x + MARGIN] = (float)of(x + 0.5, y + 0.5);
  return pixels + MARGIN * STRIDE + MARGIN;
}

typedef struct places {
  lanes u, v;
} places;

static places some_places(uint64_t *state, float from, float to) {
  places at;
  for (int i = 0; i < 2 * LANES; i++) {
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    (i % 2 ? &at.u : &at.v)[0][i / 2] = from + (float)(*state >> 40) * 0x1p-24f * (to - from);
  }
  return at;
}

static void test_cubic_keeps_squares(void **state) {
  (void)state;
  static float pixels[STRIDE * STRIDE];
  const shadow_map map = map_of_buffer();
  uint64_t random = 3;
  double off_bilinear = 0;
  const float *buffer = fill(pixels, square);
  for (int round = 0; round < 1000; round++) {
    places at = some_places(&random, 0.5f, SIDE - 0.5f);
    shadow_taps taps = taps_at_position(&map, 0, at.u, at.v);
    lanes cubic = look_up_cubic(&map, &taps, buffer), bilinear = look_up(&map, &taps, buffer);
    for (int lane = 0; lane < LANES; lane++) {
      double expected = square((double)at.u[lane], (double)at.v[lane]);
      assert_true(fabs((double)cubic[lane] - expected) < 2e-6);
      off_bilinear = fmax(off_bilinear, fabs((double)bilinear[lane] - expected));
    }
  }
  assert_true(off_bilinear > 1e-4); /* bilinear interpolation is exact for planes alone */
  buffer = fill(pixels, plane);
  places at = some_places(&random, 0.5f, SIDE - 0.5f);
  shadow_taps taps = taps_at_position(&map, 0, at.u, at.v);
  lanes bilinear = look_up(&map, &taps, buffer);
  for (int lane = 0; lane < LANES; lane++)
    assert_true(fabs((double)bilinear[lane] - plane((double)at.u[lane], (double)at.v[lane])) < 2e-6);
}

/* Cubic convolution overshoots beside an edge, but the light that is looked up does not. Outside of the
 * buffer there is no shadow. */
static void test_light_stays_light(void **state) {
  (void)state;
  static float pixels[STRIDE * STRIDE];
  const shadow_map map = map_of_buffer();
  const float *buffer = fill(pixels, edge);
  uint64_t random = 5;
  int between = 0;
  for (int round = 0; round < 1000; round++) {
    places at = some_places(&random, -3, SIDE + 3);
    shadow_taps taps = taps_at_position(&map, 0, at.u, at.v);
    lanes cubic = look_up_cubic(&map, &taps, buffer);
    for (int lane = 0; lane < LANES; lane++) {
      double u = (double)at.u[lane], v = (double)at.v[lane];
      assert_true(cubic[lane] >= 0 && cubic[lane] <= 1);
      between += cubic[lane] > 0.01f && cubic[lane] < 0.99f;
      if (u <= 0 || v <= 0 || u >= SIDE || v >= SIDE) assert_true(cubic[lane] == 1);
      else if (edge(u - 2.2, v - 2.2) == edge(u + 2.2, v + 2.2))
        assert_true(fabs((double)cubic[lane] - edge(u, v)) < 1e-6);
    }
  }
  assert_true(between > 100);
}

/* The result of cubic convolution lies within the range of the nearest four pixels. */
static void test_cubic_stays_within(void **state) {
  (void)state;
  static float pixels[STRIDE * STRIDE];
  const shadow_map map = map_of_buffer();
  uint64_t random = 9;
  for (int i = 0; i < STRIDE * STRIDE; i++) pixels[i] = (float)(i * 40503 % 1000) / 1000;
  const float *buffer = pixels + MARGIN * STRIDE + MARGIN;
  int between = 0;
  for (int round = 0; round < 1000; round++) {
    places at = some_places(&random, 0.5f, SIDE - 0.5f);
    shadow_taps taps = taps_at_position(&map, 0, at.u, at.v);
    lanes cubic = look_up_cubic(&map, &taps, buffer);
    for (int lane = 0; lane < LANES; lane++) {
      const float *first = buffer + taps.first.row[lane] * STRIDE + taps.first.column[lane];
      float least = fminf(fminf(first[0], first[1]), fminf(first[STRIDE], first[STRIDE + 1]));
      float greatest = fmaxf(fmaxf(first[0], first[1]), fmaxf(first[STRIDE], first[STRIDE + 1]));
      assert_true(cubic[lane] >= least && cubic[lane] <= greatest);
      between += cubic[lane] > least && cubic[lane] < greatest;
    }
  }
  assert_true(between > 100);
}

/* The squares of pixels of some lanes are close together, and those of other lanes are not. */
static void test_short_squares(void **state) {
  (void)state;
  static uint16_t table[STRIDE * STRIDE];
  uint64_t random = 7;
  for (int i = 0; i < STRIDE * STRIDE; i++) table[i] = (uint16_t)(i * 40503u);
  for (int round = 0; round < 1000; round++) {
    float spread = round % 2 ? 7 : SIDE - 8;
    places at = some_places(&random, (float)(round % 8), (float)(round % 8) + spread);
    lanes_squares squares = {lanes_truncate(at.u), lanes_truncate(at.v)};
    uint32_t active = round % 3 ? 0xffff : (uint32_t)(random >> 32 & 0xffff) | 1;
    lanes_int square[4];
    lanes_gather_short_squares(table, STRIDE, squares, active, square);
    for (int lane = 0; lane < LANES; lane++)
      for (int i = 0; i < 4 && (active >> lane & 1) != 0; i++)
        assert_int_equal(square[i][lane],
                         table[(squares.row[lane] + i / 2) * STRIDE + squares.column[lane] + i % 2]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_cubic_keeps_squares), cmocka_unit_test(test_light_stays_light),
      cmocka_unit_test(test_cubic_stays_within), cmocka_unit_test(test_short_squares)};
  return cmocka_run_group_tests_name("shadow_lookup", tests, NULL, NULL);
}
