/* gpu/maximum_kernels.c - the kernels' functions for maximum projections, compiled as C17, give the bytes of
 * the processors' functions (render/maximum_lanes.h). */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "render/maximum_lanes.h"

enum { ROUNDS = 4000, ROWS = CLASSIFIER_ENTRIES + 2 };

/* One block of a slab: the arguments of maximum_block(). */
typedef struct made_slab {
  float shown[ROWS][4], values[MAXIMUM_ROWS * TILE_PIXELS];
  _Alignas(64) float before[TILE_PIXELS], current[TILE_PIXELS];
  _Alignas(64) float enter[TILE_PIXELS], leave[TILE_PIXELS];
} made_slab;

static uint32_t block_of_lanes(made_slab *made, const classifier *classifier, lanes path, lanes_int visible) {
  shade_volume volume = {.classifier = classifier, .shown = (const float(*)[4])made->shown, .visible = 1};
  const shade_patch patch = {.volume = &volume,
                             .before = made->before,
                             .current = made->current,
                             .blocks = 1,
                             .enter = made->enter,
                             .leave = made->leave};
  const shade_job job = {.sheet = 7, .height = 1, .spacing = 0.5f};
  (void)maximum_tile;
  return maximum_block(&job, &patch, 0, lanes_set(0), lanes_set(0), path, visible, made->values);
}

/* The kernels' names are those of the processors' functions in places. */
#define peak_of_three      device_peak_of_three
#define greatest_shown     device_greatest_shown
#define covered_span       device_covered_span
#define covered            device_covered
#define ray_section        device_ray_section
#define is_ahead           device_is_ahead
#define path_through_sheet device_path_through_sheet
#define section_in_box     device_section_in_box
#define roots_of_sphere    device_roots_of_sphere
#define section_in_sphere  device_section_in_sphere
#define dot3               device_dot3
#define cross3             device_cross3
#define row_of_vector      device_row_of_vector
#define row_of_point       device_row_of_point
#define linear_in_view     device_linear_in_view
#define CUTS               0
#include "gpu/kernels/maximum.h"

static uint32_t next_bits(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (uint32_t)(*state >> 32);
}

static float number_between(uint64_t *state, float low, float high) {
  return low + (high - low) * ((float)(next_bits(state) >> 8) * 0x1p-24f);
}

static void make_slab(made_slab *made, uint64_t *seed) {
  for (int entry = 0; entry < ROWS; entry++) {
    const float from = (float)entry + number_between(seed, -0.2f, 1.2f);
    made->shown[entry][SHOWN_FROM] = from;
    made->shown[entry][SHOWN_TO] = from + 0.5f;
    made->shown[entry][SHOWN_BELOW] = entry % 7 == 0 ? -1 : (float)entry - 1;
  }
  for (int i = 0; i < TILE_PIXELS; i++) {
    made->values[MAXIMUM_GREATEST * TILE_PIXELS + i] = number_between(seed, -1, 100);
    made->values[MAXIMUM_BEFORE * TILE_PIXELS + i] = number_between(seed, 0, CLASSIFIER_ENTRIES);
    made->values[MAXIMUM_SHEET * TILE_PIXELS + i] = i % 3 ? 6 : -1;
    made->before[i] = number_between(seed, 0, CLASSIFIER_ENTRIES);
    made->current[i] = i % 4 ? number_between(seed, 0, CLASSIFIER_ENTRIES)
                             : made->before[i] + number_between(seed, -2, 2);
    made->enter[i] = i % 2 ? 0 : number_between(seed, 0, 1.2f);
    made->leave[i] = i % 5 ? 2 : number_between(seed, 0.4f, 1.2f);
  }
}

/* The value at a fraction of the way from a to b, as a coordinate of the table. cut_way() moves the ends of
 * the covered part in the same way. */
static void ends_of_part(device_covered_span part, float from, float to, float ends[2]) {
  const float way = to - from;
  ends[0] = fused(way, part.begin, from);
  ends[1] = fused(way, lesser(part.begin + part.length, 1.0f), from);
}

static void test_slabs(void **state) {
  (void)state;
  uint64_t seed = 13;
  static made_slab made, own;
  static classifier classifier;
  classifier.scale = 1;
  int peaks = 0, shown = 0;
  for (int round = 0; round < ROUNDS / 16; round++) {
    make_slab(&made, &seed);
    own = made;
    const lanes_int visible = lanes_from_bits(next_bits(&seed) & 0xffff);
    lanes path = lanes_set(0.5f);
    path[3] = 0;
    const uint32_t bits = block_of_lanes(&made, &classifier, path, visible);
    for (int i = 0; i < BLOCK_PIXELS; i++) {
      float *values = own.values + i, ends[2];
      ray_maximum ray = {values[0], values[MAXIMUM_BEFORE * TILE_PIXELS],
                         values[MAXIMUM_SHEET * TILE_PIXELS]};
      const heights_in_box box = {own.enter[i], own.leave[i]};
      const device_covered_span part = device_covered(box, 1, 0.5f);
      if (visible[i] == 0) { /* a device does not see the slab in this pixel, and no sheet follows */
        assert_true(made.values[i] == ray.greatest && made.values[MAXIMUM_SHEET * TILE_PIXELS + i] != 7 &&
                    (bits >> i & 1) == 0);
        continue;
      }
      ends_of_part(part, own.before[i], own.current[i], ends);
      const ray_maximum before = ray;
      const int shows = take_slab(&own.shown[0][0], 7, ends[0], ends[1], path[i] > 0 ? part.length : 0, &ray);
      assert_int_equal(shows, bits >> i & 1);
      assert_memory_equal(&ray.greatest, &made.values[i], sizeof(float));
      assert_memory_equal(&ray.before, &made.values[MAXIMUM_BEFORE * TILE_PIXELS + i], sizeof(float));
      assert_memory_equal(&ray.sheet, &made.values[MAXIMUM_SHEET * TILE_PIXELS + i], sizeof(float));
      shown += shows;
      peaks += device_peak_of_three(before.before, ends[0], ends[1]) > ends[0];
    }
  }
  assert_true(peaks > 100 && shown > ROUNDS / 4);
}

/* Ways that enter the walls of a mesh of cells, that leave them, or that lie on one side of them. */
static void test_walls(void **state) {
  (void)state;
  const device_covered_span whole = {0, 1}, late = {0.5f, 0.5f};
  device_covered_span part = part_within_walls(-1, 3, whole);
  assert_true(part.begin == 0.25f && part.length == 0.75f);
  part = part_within_walls(3, -1, whole);
  assert_true(part.begin == 0 && part.length == 0.75f);
  part = part_within_walls(3, -1, late);
  assert_true(part.begin == 0.5f && part.length == 0.25f);
  part = part_within_walls(1, -3, late);
  assert_true(part.length == 0);
  part = part_within_walls(2, 1, late);
  assert_true(part.begin == 0.5f && part.length == 0.5f);
  assert_true(part_within_walls(-2, -1, whole).length == 0);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_slabs), cmocka_unit_test(test_walls)};
  cmocka_set_message_output(CM_OUTPUT_TAP);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
