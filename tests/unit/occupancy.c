/* unit/occupancy.c - which tiles and sheets are marked as touched by bricks, compared with bounds in double
 * precision: all that bricks touch, and beyond rounding no more. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/sheet_constants.h"
#include "sheet_bench.h"

enum { SIDE = 23, ROUNDS = 120, SHEETS = 5, TILES = 3 };

typedef struct marks {
  bool at[TILES][TILES][SHEETS];
} marks;

/* The pixels and sheets that a brick touches, with a margin of pixels and sheets. */
static void mark(const bench *bench, const footprint_map *map, uint32_t brick, double pixels, double sheets,
                 marks *marks) {
  int32_t place[3];
  double centre[3], half[3];
  footprint_bounds bounds;
  hl_brick_coordinates(&bench->grid, brick, place);
  hl_brick_bounds(&bench->grid, place, GRID_MARGIN, centre, half);
  if (!hl_footprint_bounds(map, centre, half, &bounds)) return;
  for (int y = 0; y < TILES; y++)
    for (int x = 0; x < TILES; x++)
      for (int k = 0; k < SHEETS; k++) {
        double height = hl_sheet_height(&bench->sheets, k), reach = sheets * bench->sheets.spacing;
        if (bounds.low[0] - pixels < (x + 1) * TILE && bounds.high[0] + pixels >= x * TILE &&
            bounds.low[1] - pixels < (y + 1) * TILE && bounds.high[1] + pixels >= y * TILE &&
            bounds.low_height - reach <= height && bounds.high_height + reach >= height)
          marks->at[y][x][k] = true;
      }
}

static void check(const bench *bench, const occupancy *o, long counts[2]) {
  footprint_map map;
  marks least = {0}, greatest = {0};
  hl_footprint_map(&bench->view, bench->sheets.normal, bench->grid.index_to_frame, &map);
  for (uint32_t i = 0; i < bench->grid.relevant_count; i++) {
    mark(bench, &map, bench->grid.relevant_list[i], o->spare, 0, &least);
    mark(bench, &map, bench->grid.relevant_list[i], o->spare + 0.01, 1e-3, &greatest);
  }
  for (size_t tile = 0; tile < TILES * TILES; tile++)
    for (int k = 0; k < SHEETS; k++) {
      size_t patch = o->first_patch[tile];
      bool marked = patch < o->first_patch[tile + 1] && hl_occupancy_has(o, patch, k);
      bool in_sheet = o->by_sheet[(size_t)k * (size_t)o->tile_words] >> tile & 1;
      assert_int_equal(marked, in_sheet);
      if (least.at[tile / TILES][tile % TILES][k]) assert_true(marked);
      if (marked) assert_true(greatest.at[tile / TILES][tile % TILES][k]);
      counts[marked]++;
    }
}

/* The next slab that touches a patch is the first one whose sheets do. */
static void check_slabs(const occupancy *o) {
  for (size_t patch = 0; patch < o->patch_count; patch++)
    for (int slab = 1; slab < o->sheets; slab++) {
      int next = slab;
      while (next < o->sheets && !hl_occupancy_has(o, patch, next - 1) && !hl_occupancy_has(o, patch, next))
        next++;
      assert_int_equal(hl_occupancy_next_slab(o, patch, slab), next < o->sheets ? next : INT32_MAX);
    }
}

static void test_next_slabs(void **state) {
  (void)state;
  enum { WORDS = 4, LEFT_OUT = 40 };
  static uint64_t bits[LEFT_OUT][WORDS];
  uint32_t seed = 6;
  for (int patch = 0; patch < LEFT_OUT; patch++)
    for (int n = 0; n < patch; n++) {
      int sheet = (int)(bench_random(&seed) * (WORDS * 64 - LEFT_OUT));
      bits[patch][sheet / 64] |= (uint64_t)1 << sheet % 64;
    }
  bits[0][0] = bits[1][1] = (uint64_t)1 << 63;
  check_slabs(&(occupancy){
      .sheets = WORDS * 64 - LEFT_OUT, .words = WORDS, .patch_count = LEFT_OUT, .by_patch = bits[0]});
}

/* The range of slabs of a grid ends where the sheets of its patches end. */
static void check_range(const occupancy *o) {
  sheet_range all = {INT32_MAX, -1};
  for (size_t patch = 0; patch < o->patch_count; patch++)
    for (int sheet = 0; sheet < o->sheets; sheet++) {
      if (!hl_occupancy_has(o, patch, sheet)) continue;
      if (sheet < all.first) all.first = sheet;
      if (sheet > all.last) all.last = sheet;
    }
  assert_int_equal(o->sheets_of[0].first, all.first);
  assert_int_equal(o->sheets_of[0].last, all.last);
}

/* With a few bright voxels, few bricks are marked. */
static void open_grid(bench *bench, uint8_t *voxels) {
  memset(voxels, 0, SIDE * SIDE * SIDE);
  uint32_t seed = 4;
  for (int i = 0; i < 9; i++) voxels[(size_t)(bench_random(&seed) * SIDE * SIDE * SIDE)] = 255;
  bench_open(bench, (size_t[3]){SIDE, SIDE, SIDE}, HL_STORAGE_U8, voxels, bench_oblique_axes());
  static const hl_opacity_point ramp[] = {{20, 0}, {40, 0.9}};
  bench_show(bench, ramp, 2);
}

static void test_bricks_mark_what_they_touch(void **state) {
  (void)state;
  static uint8_t voxels[SIDE * SIDE * SIDE];
  bench bench;
  open_grid(&bench, voxels);
  assert_true(bench.grid.relevant_count > 0 && bench.grid.relevant_count < hl_grid_bricks(&bench.grid) / 2);
  uint32_t seed = 9;
  long counts[2] = {0};
  for (int round = 0; round < ROUNDS; round++) {
    /* views in parallel, from outside, from within, and from far away */
    static const double distances[] = {0, 40, 5, 1e5}, pixels[] = {0.5, 0.1, 2};
    vec3 direction = bench_random_direction(&seed), normal = bench_random_normal(direction, &seed);
    bench_look(&bench, direction, normal, pixels[round % 3], distances[round % 4], HL_KERNEL_BSPLINE);
    occupancy o = {0};
    const occupancy_source source = {&bench.grid, 1, &bench.view, &bench.sheets, round % 2 ? 1.0 : 0.3};
    assert_int_equal(
        hl_occupancy_build(bench.context, bench.pool, hl_hot_scalar.view->brick_ranges, &source, &o, NULL),
        HL_OK);
    check(&bench, &o, counts);
    check_range(&o);
    hl_occupancy_release(bench.context, &o);
  }
  assert_true(counts[0] > 1000 && counts[1] > 1000);
  bench_close(&bench);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_bricks_mark_what_they_touch),
                                     cmocka_unit_test(test_next_slabs)};
  return cmocka_run_group_tests_name("occupancy", tests, NULL, NULL);
}
