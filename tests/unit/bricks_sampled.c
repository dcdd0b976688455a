/* Samples of fields at levels (bricks/evaluate.h, fill/). Every instruction set gives the same bytes, which
 * are the field's values. Constants and linear fields are exact. Percentiles are those of all voxels. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../dense_bricks.h"
#include "../octree.h"
#include "bricks/evaluate.h"
#include "core/context.h"
#include "render/hot.h"
#include "volume/coarser.h"
#include "volume/in_bricks.h"

enum { SIDE = 48 }; /* cells of the field along each axis */

typedef struct field_bench {
  hl_context *context;
  hl_bricks bricks;
} field_bench;

static void open_bench(field_bench *bench, uint64_t seed, octree_value *value, int shift) {
  assert_int_equal(hl_context_create(NULL, &bench->context, NULL), HL_OK);
  octree source = {seed, value};
  octree_build(bench->context, 2, &source, (const size_t[3]){SIDE + 1, SIDE + 1, SIDE + 1}, shift, 4,
               &bench->bricks);
}

static void close_bench(field_bench *bench) {
  hl_bricks_release(bench->context, &bench->bricks);
  assert_true(hl_context_memory_held(bench->context) == 0);
  hl_context_destroy(bench->context);
}

/* ---- one B-spline of level 0 ---- */

/* The coefficients of level 0 are those of the dense grid, and the sum of B-splines with them is the field's
 * value. */
static void test_coefficients(void **state) {
  (void)state;
  for (int shift = 2; shift <= 4; shift++) {
    field_bench bench;
    open_bench(&bench, 5 + (uint64_t)shift, octree_random_value, shift);
    size_t size[3];
    float *dense = NULL;
    hl_pool *pool = NULL;
    assert_int_equal(hl_pool_create(bench.context, 2, &pool, NULL), HL_OK);
    assert_int_equal(
        hl_bricks_evaluate_dense(bench.context, pool, &bench.bricks, 0, "test", size, &dense, NULL), HL_OK);
    hl_pool_destroy(pool);
    size_t at = 0;
    for (int64_t k = 0; k < (int64_t)size[2]; k++)
      for (int64_t j = 0; j < (int64_t)size[1]; j++)
        for (int64_t i = 0; i < (int64_t)size[0]; i++, at++) {
          float found = hl_bricks_coefficient(&bench.bricks, (const int64_t[3]){i, j, k});
          assert_true(fabs((double)found - (double)dense[at]) < 1e-6);
        }
    hl_release(bench.context, dense);
    close_bench(&bench);
  }
}

/* The numbers of a window are those of its points, also if the window crosses borders of bricks or leaves the
 * lattice. */
static void test_windows(void **state) {
  (void)state;
  enum { WINDOWS = 300, LONGEST = 21 };
  static double values[LONGEST * LONGEST * LONGEST];
  for (int shift = 2; shift <= 4; shift++) {
    field_bench bench;
    open_bench(&bench, 11 + (uint64_t)shift, octree_random_value, shift);
    for (uint64_t n = 0; n < WINDOWS; n++) {
      int64_t first[3], count[3];
      for (uint64_t axis = 0; axis < 3; axis++) {
        first[axis] = (int64_t)(octree_random(n, axis) * (SIDE + 16)) - 8;
        count[axis] = 1 + (int64_t)(octree_random(n, axis + 3) * LONGEST);
      }
      hl_bricks_window(&bench.bricks, first, count, values);
      const double *value = values;
      for (int64_t k = 0; k < count[2]; k++)
        for (int64_t j = 0; j < count[1]; j++)
          for (int64_t i = 0; i < count[0]; i++, value++) {
            const int64_t point[3] = {first[0] + i, first[1] + j, first[2] + k};
            assert_true(*value == (double)hl_bricks_coefficient(&bench.bricks, point));
          }
    }
    close_bench(&bench);
  }
}

/* ---- sampling ---- */

/* A sheet of parallel rays, and the grid, as a frame has them. */
static void make_source(const field_bench *bench, uint64_t seed, grid *grid, fill_source *source) {
  memset(grid, 0, sizeof *grid);
  memset(source, 0, sizeof *source);
  grid->bricks = &bench->bricks;
  grid->storage = HL_STORAGE_F32;
  for (int axis = 0; axis < 3; axis++)
    grid->dimension[axis] = (int32_t)hl_bricks_cells(&bench->bricks, axis) - 1;
  source->grid = grid;
  source->kernel = hl_kernel_get(HL_KERNEL_BSPLINE);
  for (int axis = 0; axis < 3; axis++) {
    source->rays.p0[axis] = (float)(octree_random(seed, (uint64_t)axis) * (SIDE + 6) - 4);
    source->rays.pu[axis] = (float)(octree_random(seed, (uint64_t)axis + 3) * 2 - 1);
    source->rays.pv[axis] = (float)(octree_random(seed, (uint64_t)axis + 6) * 2 - 1);
  }
}

enum { SHEETS = 400 };

static void test_gathered(void **state) {
  (void)state;
  octree_value *values[] = {octree_random_value, octree_constant_value, octree_linear_value};
  for (int n = 0; n < 9; n++) {
    field_bench bench;
    open_bench(&bench, 90 + (uint64_t)n, values[n % 3], 2 + n / 3);
    double size = n % 3 == 2 ? 200 : 1; /* of the values */
    for (uint64_t sheet = 0; sheet < SHEETS; sheet++) {
      grid grid;
      fill_source source;
      make_source(&bench, 1000 * (uint64_t)n + sheet, &grid, &source);
      float scalar[TILE_PIXELS], density[TILE_PIXELS];
      hl_hot_scalar.fill->gather(&source, 0, 0, ALL_BLOCKS, 0, scalar);
      for (int i = 0; i < TILE_PIXELS; i++) {
        double at[3];
        bool within = true;
        for (int axis = 0; axis < 3; axis++) {
          double p = (double)source.rays.p0[axis] + hl_pixel_column(i) * (double)source.rays.pu[axis] +
                     hl_pixel_row(i) * (double)source.rays.pv[axis];
          within = within && p > -0.999 && p < grid.dimension[axis] - 0.01;
          at[axis] = p + 1; /* the lattice's coordinate */
        }
        double expected = n % 3 == 1   ? octree_constant_value(0, 0, (const ptrdiff_t[3]){0, 0, 0})
                          : n % 3 == 2 ? octree_linear_at(at)
                                       : hl_bricks_value(&bench.bricks, at);
        /* positions are floats, and the steepest slope is a few values per cell */
        if (within && !(fabs((double)scalar[i] - expected) < 1e-5 * size))
          fail_msg("field %d at %g %g %g: %.9g, not %.9g", n, at[0], at[1], at[2], (double)scalar[i],
                   expected);
      }
      for (int set = HL_INSTRUCTION_SET_SCALAR; set <= HL_INSTRUCTION_SET_AVX512_VBMI; set++) {
        if (!hl_cpu_has_instruction_set((hl_instruction_set)set)) continue;
        hl_hot_functions((hl_instruction_set)set)->fill->gather(&source, 0, 0, ALL_BLOCKS, 0, density);
        assert_memory_equal(density, scalar, sizeof density);
      }
    }
    close_bench(&bench);
  }
}

/* All values in a box of cells lie in the range that is found for the box. */
static void test_ranges(void **state) {
  (void)state;
  field_bench bench;
  open_bench(&bench, 77, octree_random_value, 3);
  for (uint64_t n = 0; n < 3000; n++) {
    int64_t first[3], last[3];
    double at[3];
    float range[2];
    for (int axis = 0; axis < 3; axis++) {
      first[axis] = (int64_t)(octree_random(n, (uint64_t)axis) * SIDE) - 1;
      last[axis] = first[axis] + (int64_t)(octree_random(n, 3 + (uint64_t)axis) * 6);
      at[axis] = (double)first[axis] +
                 octree_random(n, 6 + (uint64_t)axis) * (double)(last[axis] + 1 - first[axis]);
    }
    hl_bricks_range(&bench.bricks, first, last, range);
    double value = hl_bricks_value(&bench.bricks, at);
    assert_true(value >= (double)range[0] - 1e-6 && value <= (double)range[1] + 1e-6);
    assert_true(range[1] - range[0] <= 1);
  }
  close_bench(&bench);
}

/* The ranges of a row of boxes along y are those of the single boxes, also if the row leaves the lattice. */
static void test_ranges_of_rows(void **state) {
  (void)state;
  enum { COUNT = SIDE / 2, ROWS = 12 };
  octree_value *values[] = {octree_random_value, octree_constant_value};
  for (int n = 0; n < 6; n++) {
    field_bench bench;
    open_bench(&bench, 130 + (uint64_t)n, values[n % 2], 2 + n / 2);
    for (uint64_t start = 0; start < 100; start++) {
      int64_t first[3], last[3];
      const int64_t step = 1 + (int64_t)(octree_random(start, 6) * 4),
                    down = 1 + (int64_t)(octree_random(start, 7) * 4);
      hl_bricks_row row = {.boxes = {0}};
      for (int axis = 0; axis < 3; axis++) {
        first[axis] = (int64_t)(octree_random(start, (uint64_t)axis) * (axis == 0 ? 8 : SIDE)) - 3;
        last[axis] = first[axis] + (int64_t)(octree_random(start, 3 + (uint64_t)axis) * 6);
      }
      for (int r = 0; r < ROWS; r++, first[1] += down, last[1] += down) {
        hl_bricks_ranges(&bench.bricks, first, last, step, COUNT, &row);
        for (int box = 0; box < COUNT; box++) {
          const int64_t low[3] = {first[0] + box * step, first[1], first[2]},
                        high[3] = {last[0] + box * step, last[1], last[2]};
          float range[2];
          hl_bricks_range(&bench.bricks, low, high, range);
          assert_memory_equal(row.ranges[box], range, sizeof range);
        }
      }
    }
    close_bench(&bench);
  }
}

/* The values of a row are those of its points, also beyond the lattice and if the row crosses bricks of
 * several levels. */
static void test_values_of_rows(void **state) {
  (void)state;
  enum { COUNT = 3 * SIDE / 2 };
  for (int n = 0; n < 6; n++) {
    field_bench bench;
    open_bench(&bench, 170 + (uint64_t)n, octree_random_value, 2 + n / 2);
    for (uint64_t row = 0; row < 300; row++) {
      double first[3], values[COUNT];
      for (int axis = 0; axis < 3; axis++)
        first[axis] = floor(octree_random(row, (uint64_t)axis) * (SIDE + 8)) - 4;
      for (int axis = 0; axis < 3; axis++) first[axis] += row % 3 * 0.25;
      hl_bricks_values(&bench.bricks, first, COUNT, values);
      for (int i = 0; i < COUNT; i++) {
        const double value = hl_bricks_value(&bench.bricks,
                                             (const double[3]){first[0] + i, first[1], first[2]});
        assert_memory_equal(&values[i], &value, sizeof value);
      }
    }
    close_bench(&bench);
  }
}

/* ---- without the finest level ---- */

/* A linear field stays the same when it is made of voxels, each in the middle of eight points. A brick of a
 * coarser level keeps its coefficients, and there are no more bricks than before. */
static void test_coarser(void **state) {
  (void)state;
  for (int shift = 2; shift <= 4; shift++) {
    field_bench bench;
    open_bench(&bench, 31, octree_linear_value, shift);
    hl_volume_description grid;
    hl_volume *fine = NULL, *coarse = NULL;
    const size_t slots = bench.bricks.slots;
    hl_volume_description_defaults(&grid);
    grid.type = HL_VOXEL_F32;
    for (int a = 0; a < 3; a++) grid.dimensions[a] = SIDE, bench.bricks.origin[a] = 0.5;
    assert_int_equal(hl_volume_take_bricks(bench.context, &bench.bricks, &grid, "test", &fine, NULL), HL_OK);
    assert_int_equal(hl_volume_make_coarser(fine, HL_COARSER_MEANS, &coarse, NULL), HL_OK);
    assert_true(coarse->bricks->levels == 3 && coarse->bricks->slots <= slots);
    for (size_t k = 4; k < SIDE / 2 - 4; k++)
      for (size_t j = 4; j < SIDE / 2 - 4; j++)
        for (size_t i = 4; i < SIDE / 2 - 4; i++) {
          const double at[3] = {2 * (double)i + 1, 2 * (double)j + 1, 2 * (double)k + 1};
          assert_float_equal(hl_volume_value(coarse, i, j, k), octree_linear_at(at), 1e-4);
        }
    assert_float_equal(coarse->index_to_world.offset.x, 0.5, 0);
    hl_volume_release(fine);
    hl_volume_release(coarse);
    close_bench(&bench);
  }
}

/* ---- statistics ---- */

static int compare_floats(const void *a, const void *b) {
  const float x = *(const float *)a, y = *(const float *)b;
  return (x > y) - (x < y);
}

/* The coefficient of the brick that contains a lattice point of level 0: it stands for the whole cell of the
 * brick's level. */
static float coefficient_around(const hl_bricks *bricks, const int64_t point[3]) {
  int64_t block[3];
  for (int a = 0; a < 3; a++) block[a] = point[a] >> bricks->shift;
  const hl_brick_entry *entry = hl_bricks_entry(bricks, block);
  if (entry->slot < 0) return entry->constant;
  size_t at[3];
  const size_t width = hl_brick_width(bricks);
  for (int a = 0; a < 3; a++)
    at[a] = (size_t)((point[a] >> entry->level) - (block[a] >> entry->level << bricks->shift)) + 1;
  return hl_brick_pool(bricks, entry->slot)[(at[2] * width + at[1]) * width + at[0]];
}

/* A percentile has the rank that it has among the coefficients of all voxels, of which a brick of a coarser
 * level has several for each of its own. */
static void test_percentiles(void **state) {
  (void)state;
  static float sorted[SIDE * SIDE * SIDE];
  for (int shift = 2; shift <= 4; shift++) {
    field_bench bench;
    open_bench(&bench, 41 + (uint64_t)shift, octree_random_value, shift);
    size_t n = 0;
    for (int64_t k = 0; k < SIDE; k++)
      for (int64_t j = 0; j < SIDE; j++)
        for (int64_t i = 0; i < SIDE; i++)
          sorted[n++] = coefficient_around(&bench.bricks, (const int64_t[3]){i, j, k});
    qsort(sorted, n, sizeof *sorted, compare_floats);
    hl_volume_description grid;
    hl_volume *volume = NULL;
    hl_volume_description_defaults(&grid);
    grid.type = HL_VOXEL_F32;
    for (int a = 0; a < 3; a++) grid.dimensions[a] = SIDE;
    assert_int_equal(hl_volume_take_bricks(bench.context, &bench.bricks, &grid, "test", &volume, NULL),
                     HL_OK);
    static const double percents[] = {0, 1, 37.5, 50, 99.9, 100};
    double found[sizeof percents / sizeof *percents];
    assert_int_equal(hl_volume_percentiles(volume, percents, sizeof percents / sizeof *percents, found, NULL),
                     HL_OK);
    for (size_t p = 0; p < sizeof percents / sizeof *percents; p++) {
      const double place = percents[p] / 100 * (double)(n - 1);
      const size_t rank = (size_t)place, after = rank + 1 < n ? rank + 1 : rank;
      const double low = (double)sorted[rank], high = (double)sorted[after];
      assert_true(found[p] == low + (place - (double)rank) * (high - low));
    }
    hl_volume_release(volume);
    close_bench(&bench);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_coefficients),   cmocka_unit_test(test_windows),
      cmocka_unit_test(test_coarser),        cmocka_unit_test(test_gathered),
      cmocka_unit_test(test_ranges),         cmocka_unit_test(test_ranges_of_rows),
      cmocka_unit_test(test_values_of_rows), cmocka_unit_test(test_percentiles)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
