/* Fields at levels (bricks/build.h): borders of any arrangement of bricks are smooth, constants and linear
 * fields are exact, and the bytes are the same for any number of threads. Corners of cells
 * (bricks/corners.h) keep mass. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>
#include <string.h>

#include <halflight/halflight.h>

#include "../dense_bricks.h"
#include "bricks/build.h"
#include "bricks/corners.h"
#include "core/context.h"
#include "core/memory.h"

enum { SHIFT = 3, SIDE = 1 << SHIFT, STORED = SIDE + BRICK_MARGIN };

/* ---- sources ---- */

static double random_of(uint64_t key) {
  key = (key ^ (key >> 31)) * 0x7fb5d329728ea185u;
  key = (key ^ (key >> 27)) * 0x81dadef4bc2dd44du;
  key ^= key >> 33;
  return (double)(key >> 11) / 9007199254740992.0;
}

/* A brick is split where a random number says so, and a field is given by a formula of the world's point. */
typedef struct test_source {
  uint64_t seed;
  double (*value)(uint64_t seed, int level, const ptrdiff_t point[3]);
} test_source;

static double random_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  uint64_t key = seed;
  for (int axis = 0; axis < 3; axis++) key = key * 1000003 + (uint64_t)(point[axis] + 4096);
  return random_of(key * 31 + (uint64_t)level);
}

static double constant_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  (void)seed, (void)level, (void)point;
  return 0.1;
}

static double linear_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  (void)seed;
  double scale = (double)(1 << level);
  return 3 + scale * (0.5 * (double)point[0] - 0.25 * (double)point[1] + 2 * (double)point[2]);
}

static void fill(void *data, int level, const ptrdiff_t first[3], const size_t count[3], float *out) {
  const test_source *source = data;
  size_t n = 0;
  for (size_t k = 0; k < count[2]; k++)
    for (size_t j = 0; j < count[1]; j++)
      for (size_t i = 0; i < count[0]; i++)
        out[n++] = (float)source->value(
            source->seed, level,
            (ptrdiff_t[3]){first[0] + (ptrdiff_t)i, first[1] + (ptrdiff_t)j, first[2] + (ptrdiff_t)k});
}

static hl_bricks_choice choose(void *data, int level, const size_t brick[3]) {
  const test_source *source = data;
  const ptrdiff_t point[3] = {(ptrdiff_t)brick[0], (ptrdiff_t)brick[1], (ptrdiff_t)brick[2]};
  bool splits = level == 3 || random_value(source->seed + 17, level, point) < 0.5;
  return splits ? HL_BRICKS_SPLIT : HL_BRICKS_LEAF;
}

static void build(hl_context *context, int threads, test_source *data, const size_t dimension[3], int levels,
                  hl_bricks *bricks) {
  hl_bricks_source source = {.shift = SHIFT, .levels = levels, .fill = fill, .data = data};
  hl_bricks_leaf *leaves = NULL;
  size_t count = 0;
  hl_pool *pool = NULL;
  memcpy(source.dimension, dimension, sizeof source.dimension);
  assert_int_equal(hl_pool_create(context, threads, &pool, NULL), HL_OK);
  assert_int_equal(hl_bricks_choose(context, &source, choose, data, "a field", &leaves, &count, NULL), HL_OK);
  assert_int_equal(hl_bricks_build(context, pool, &source, leaves, count, "test", bricks, NULL), HL_OK);
  hl_release(context, leaves);
  hl_pool_destroy(pool);
}

/* ---- the field, from the brick that a place names ---- */

static const hl_brick_entry *entry_of(const hl_bricks *bricks, const size_t block[3]) {
  const size_t *n = bricks->directory_size;
  return &bricks->directory[(block[2] * n[1] + block[1]) * n[0] + block[0]];
}

/* The B-spline of four coefficients, or a derivative of it, at t from 0 to 1 after the second coefficient. */
static void spline_weights(double t, int order, double weight[4]) {
  double u = 1 - t;
  const double table[3][4] = {{u * u * u / 6, (4 - 6 * t * t + 3 * t * t * t) / 6,
                               (4 - 6 * u * u + 3 * u * u * u) / 6, t * t * t / 6},
                              {-u * u / 2, (-12 * t + 9 * t * t) / 6, (12 * u - 9 * u * u) / 6, t * t / 2},
                              {u, 3 * t - 2, 3 * u - 2, t}};
  memcpy(weight, table[order], sizeof table[order]);
}

/* The field at a point by the brick of a block of level 0. order: of the derivative along each axis, in the
 * world's coordinates. */
static double field(const hl_bricks *bricks, const size_t block[3], const double at[3], const int order[3]) {
  const hl_brick_entry *entry = entry_of(bricks, block);
  double scale = (double)(1 << entry->level), weight[3][4], sum = 0;
  size_t first[3];
  if (entry->slot < 0) return order[0] + order[1] + order[2] == 0 ? (double)entry->constant : 0;
  for (int axis = 0; axis < 3; axis++) {
    double place = at[axis] / scale, begin = (double)(block[axis] >> entry->level << SHIFT);
    double cell = fmin(fmax(floor(place), begin), begin + SIDE - 1);
    spline_weights(place - cell, order[axis], weight[axis]);
    first[axis] = (size_t)(cell - begin);
    for (int n = 0; n < 4; n++) weight[axis][n] /= pow(scale, order[axis]);
  }
  const float *stored = bricks->pool + (size_t)entry->slot * STORED * STORED * STORED;
  for (size_t k = 0; k < 4; k++)
    for (size_t j = 0; j < 4; j++)
      for (size_t i = 0; i < 4; i++)
        sum += weight[0][i] * weight[1][j] * weight[2][k] *
               (double)stored[((first[2] + k) * STORED + first[1] + j) * STORED + first[0] + i];
  return sum;
}

/* The greatest difference of the field, or of its derivatives of one order, across the faces between blocks.
 */
static double greatest_jump(const hl_bricks *bricks, int order, size_t *borders) {
  double greatest = 0;
  size_t block[3];
  *borders = 0;
  for (block[2] = 0; block[2] < bricks->directory_size[2]; block[2]++)
    for (block[1] = 0; block[1] < bricks->directory_size[1]; block[1]++)
      for (block[0] = 0; block[0] < bricks->directory_size[0]; block[0]++)
        for (int axis = 0; axis < 3; axis++) {
          size_t other[3] = {block[0], block[1], block[2]};
          if (++other[axis] == bricks->directory_size[axis]) continue;
          *borders += entry_of(bricks, block)->level != entry_of(bricks, other)->level;
          for (int sample = 0; sample < 36; sample++) {
            double at[3] = {(double)(block[0] * SIDE), (double)(block[1] * SIDE), (double)(block[2] * SIDE)};
            at[axis] += SIDE;
            at[(axis + 1) % 3] += sample % 6 * 1.6; /* the points go from one edge of the face to the other */
            at[(axis + 2) % 3] += sample / 6 * 1.6;
            for (int d = 0; d < 3; d++) {
              int orders[3] = {0, 0, 0};
              orders[d] = order;
              greatest = fmax(greatest,
                              fabs(field(bricks, block, at, orders) - field(bricks, other, at, orders)));
            }
          }
        }
  return greatest;
}

/* ---- tests ---- */

static int context_up(void **state) {
  return hl_context_create(NULL, (hl_context **)state, NULL) == HL_OK ? 0 : 1;
}
static int context_down(void **state) {
  hl_context_destroy(*state);
  return 0;
}

static void borders_are_smooth(void **state) {
  hl_context *context = *state;
  for (uint64_t seed = 1; seed <= 4; seed++) {
    test_source data = {seed, random_value};
    hl_bricks bricks;
    size_t borders;
    build(context, 2, &data, (size_t[3]){70, 64, 61}, 4, &bricks);
    double value = greatest_jump(&bricks, 0, &borders);
    assert_true(borders > 50);
    assert_true(value < 1e-6);
    assert_true(greatest_jump(&bricks, 1, &borders) < 1e-6);
    assert_true(greatest_jump(&bricks, 2, &borders) < 2e-6);
    hl_bricks_release(context, &bricks);
  }
}

/* The test above can fail: if one coefficient at a border is wrong, it finds that. */
static void a_wrong_border_is_seen(void **state) {
  hl_context *context = *state;
  test_source data = {1, random_value};
  hl_bricks bricks;
  size_t borders;
  build(context, 1, &data, (size_t[3]){70, 64, 61}, 4, &bricks);
  for (size_t n = 0; n < STORED * STORED; n++) bricks.pool[n * STORED] += 0.01f;
  assert_true(greatest_jump(&bricks, 0, &borders) > 1e-3);
  hl_bricks_release(context, &bricks);
}

static void constants_are_exact(void **state) {
  hl_context *context = *state;
  test_source data = {2, constant_value};
  hl_bricks bricks;
  build(context, 2, &data, (size_t[3]){70, 64, 61}, 4, &bricks);
  assert_int_equal(bricks.slots, 0);
  const size_t *n = bricks.directory_size;
  for (size_t at = 0; at < n[0] * n[1] * n[2]; at++) {
    assert_int_equal(bricks.directory[at].slot, -1);
    assert_true(bricks.directory[at].constant == 0.1f);
  }
  hl_bricks_release(context, &bricks);
}

static void linear_fields_are_exact(void **state) {
  hl_context *context = *state;
  test_source data = {3, linear_value};
  hl_bricks bricks;
  size_t size[3], n = 0;
  float *voxels = NULL;
  hl_pool *pool = NULL;
  build(context, 2, &data, (size_t[3]){70, 64, 61}, 4, &bricks);
  assert_int_equal(hl_pool_create(context, 2, &pool, NULL), HL_OK);
  for (int level = 0; level < 4; level++) {
    assert_int_equal(hl_bricks_evaluate_dense(context, pool, &bricks, level, "test", size, &voxels, NULL),
                     HL_OK);
    n = 0;
    for (size_t k = 0; k < size[2]; k++)
      for (size_t j = 0; j < size[1]; j++)
        for (size_t i = 0; i < size[0]; i++) {
          const ptrdiff_t point[3] = {(ptrdiff_t)i, (ptrdiff_t)j, (ptrdiff_t)k};
          bool last = i + 1 == size[0] || j + 1 == size[1] || k + 1 == size[2];
          if (!last) assert_float_equal(voxels[n], linear_value(0, level, point), 1e-4);
          n++;
        }
    assert_int_equal(size[0], level == 0 ? 70 : (69 + (1 << level) - 1) / (1 << level) + 1);
    hl_release(context, voxels);
  }
  hl_pool_destroy(pool);
  hl_bricks_release(context, &bricks);
}

/* The dense grid of level 0 gives the field of the bricks everywhere. */
static void dense_is_the_same_field(void **state) {
  hl_context *context = *state;
  test_source data = {4, random_value};
  hl_bricks bricks;
  size_t size[3];
  float *voxels = NULL;
  hl_pool *pool = NULL;
  build(context, 2, &data, (size_t[3]){70, 64, 61}, 4, &bricks);
  assert_int_equal(hl_pool_create(context, 2, &pool, NULL), HL_OK);
  assert_int_equal(hl_bricks_evaluate_dense(context, pool, &bricks, 0, "test", size, &voxels, NULL), HL_OK);
  for (uint64_t sample = 0; sample < 4000; sample++) {
    double at[3], weight[3][4], sum = 0;
    size_t block[3], first[3];
    for (uint64_t axis = 0; axis < 3; axis++) {
      at[axis] = 1 + random_of(sample * 3 + axis + 99) * (double)(size[axis] - 4);
      block[axis] = (size_t)at[axis] >> SHIFT;
      first[axis] = (size_t)at[axis] - 1;
      spline_weights(at[axis] - floor(at[axis]), 0, weight[axis]);
    }
    for (size_t k = 0; k < 4; k++)
      for (size_t j = 0; j < 4; j++)
        for (size_t i = 0; i < 4; i++)
          sum += weight[0][i] * weight[1][j] * weight[2][k] *
                 (double)voxels[((first[2] + k) * size[1] + first[1] + j) * size[0] + first[0] + i];
    assert_float_equal(sum, field(&bricks, block, at, (int[3]){0, 0, 0}), 1e-6);
  }
  hl_release(context, voxels);
  hl_pool_destroy(pool);
  hl_bricks_release(context, &bricks);
}

static void threads_make_no_difference(void **state) {
  hl_context *context = *state;
  test_source data = {5, random_value};
  hl_bricks bricks[2];
  for (int n = 0; n < 2; n++) build(context, n == 0 ? 1 : 3, &data, (size_t[3]){70, 64, 61}, 4, &bricks[n]);
  const size_t *n = bricks[0].directory_size;
  assert_int_equal(bricks[0].slots, bricks[1].slots);
  assert_memory_equal(bricks[0].pool, bricks[1].pool,
                      bricks[0].slots * STORED * STORED * STORED * sizeof(float));
  assert_memory_equal(bricks[0].directory, bricks[1].directory, n[0] * n[1] * n[2] * sizeof(hl_brick_entry));
  for (int b = 0; b < 2; b++) hl_bricks_release(context, &bricks[b]);
}

/* Two bricks at one place, a brick beyond the field, and a field beyond memory are refused. */
static void impossible_bricks_are_refused(void **state) {
  hl_context *context = *state;
  test_source data = {6, random_value};
  hl_bricks_source source = {
      .shift = SHIFT, .levels = 2, .dimension = {32, 32, 32}, .fill = fill, .data = &data};
  const hl_bricks_leaf twice[2] = {{1, {0, 0, 0}}, {0, {1, 1, 1}}}, beyond[1] = {{0, {4, 0, 0}}};
  hl_bricks bricks;
  hl_error error;
  hl_pool *pool = NULL;
  assert_int_equal(hl_pool_create(context, 1, &pool, NULL), HL_OK);
  assert_int_equal(hl_bricks_build(context, pool, &source, twice, 2, "test", &bricks, &error),
                   HL_ERROR_INPUT);
  assert_string_equal(error.message, "test: the brick 1, 1, 1 of level 0 lies where another brick is");
  assert_int_equal(hl_bricks_build(context, pool, &source, beyond, 1, "test", &bricks, &error),
                   HL_ERROR_INPUT);
  assert_string_equal(error.message, "test: the brick 4, 0, 0 of level 0 lies outside the field");
  source.dimension[0] = source.dimension[1] = source.dimension[2] = 1 << 24;
  assert_int_equal(hl_bricks_build(context, pool, &source, twice, 1, "test", &bricks, &error),
                   HL_ERROR_MEMORY);
  hl_pool_destroy(pool);
}

/* Counts the bricks about which the descent asks. All of them are split. */
static hl_bricks_choice count_and_split(void *data, int level, const size_t brick[3]) {
  (void)level, (void)brick;
  ++*(size_t *)data;
  return HL_BRICKS_SPLIT;
}

/* If the memory limit has no room for the coefficients of all bricks, the list of bricks ends before. If it
 * has no room for the field's directory, the field is refused before anything is asked about its bricks. */
static void lists_keep_within_the_limit(void **state) {
  hl_context *context = *state;
  enum { LIMIT = 1 << 20, BRICK_BYTES = 7 * 7 * 7 * 4 };
  hl_bricks_source source = {.shift = 2, .levels = 3, .dimension = {256, 256, 256}};
  hl_bricks_leaf *leaves = NULL;
  size_t count = 0, asked = 0;
  hl_error error;
  assert_int_equal(hl_context_limit_memory(context, 8 * LIMIT, NULL, NULL), HL_OK);
  assert_int_equal(
      hl_bricks_choose(context, &source, count_and_split, &asked, "a field", &leaves, &count, &error),
      HL_ERROR_MEMORY);
  assert_null(leaves);
  assert_true(asked > 8 * LIMIT / BRICK_BYTES && asked < 10 * LIMIT / BRICK_BYTES);
  for (int axis = 0; axis < 3; axis++) source.dimension[axis] = 1 << 30;
  asked = 0;
  assert_int_equal(
      hl_bricks_choose(context, &source, count_and_split, &asked, "a field", &leaves, &count, &error),
      HL_ERROR_MEMORY);
  assert_int_equal(asked, 0);
  assert_int_equal(hl_context_limit_memory(context, 0, NULL, NULL), HL_OK);
}

/* ---- corners of cells ---- */

enum {
  AROUND = 24,
  MATTER = 12,
  FROM = (AROUND - MATTER) / 2
}; /* cells along an edge: all, those with matter */

typedef double cells_value(const ptrdiff_t cell[3]);

/* Thin walls: one cell in five has matter. */
static double thin_matter(const ptrdiff_t cell[3]) {
  for (int axis = 0; axis < 3; axis++)
    if (cell[axis] < FROM || cell[axis] >= FROM + MATTER) return .25;
  double random = random_value(77, 0, cell);
  return random < .2 ? 1 + 8 * random : .25;
}

static double slope_of_cells(const ptrdiff_t cell[3]) {
  return 3 + (double)cell[0] - 2 * (double)cell[1] + .5 * (double)cell[2];
}

/* Finds the coefficients of the corners first .. first + count - 1. */
static void corners_of(cells_value *value, const ptrdiff_t first[3], const size_t count[3], float *out) {
  float cells[CORNERS_CELLS][CORNERS_CELLS][CORNERS_CELLS];
  for (int k = 0; k < CORNERS_CELLS; k++)
    for (int j = 0; j < CORNERS_CELLS; j++)
      for (int i = 0; i < CORNERS_CELLS; i++)
        cells[k][j][i] = (float)value((const ptrdiff_t[3]){
            first[0] + i - CORNERS_BEFORE, first[1] + j - CORNERS_BEFORE, first[2] + k - CORNERS_BEFORE});
  hl_corners_of_cells(&cells[0][0][0], count, out);
}

/* The sum of the coefficients is the sum of the cells, and no coefficient leaves the range of the cells, also
 * where walls are thinner than a cell. */
static void corners_keep_mass_and_range(void **state) {
  (void)state;
  float out[CORNERS_MOST * CORNERS_MOST * CORNERS_MOST];
  const size_t count[3] = {CORNERS_MOST, CORNERS_MOST, CORNERS_MOST};
  double coefficients = 0, cells = 0;
  ptrdiff_t at[3];
  for (at[2] = 0; at[2] < AROUND; at[2]++)
    for (at[1] = 0; at[1] < AROUND; at[1]++)
      for (at[0] = 0; at[0] < AROUND; at[0]++) cells += (double)(float)thin_matter(at) - .25;
  for (at[2] = 0; at[2] < AROUND; at[2] += CORNERS_MOST)
    for (at[1] = 0; at[1] < AROUND; at[1] += CORNERS_MOST)
      for (at[0] = 0; at[0] < AROUND; at[0] += CORNERS_MOST) {
        corners_of(thin_matter, at, count, out);
        for (size_t n = 0; n < sizeof out / sizeof *out; n++) {
          assert_true(out[n] >= .25f && out[n] <= 2.6f);
          coefficients += (double)out[n] - .25;
        }
      }
  assert_true(cells > 100);
  assert_true(fabs(coefficients - cells) < 1e-6 * cells);
}

/* Linear cells give the linear field at their corners. */
static void corners_of_linear_cells(void **state) {
  (void)state;
  float out[5 * 6 * 7];
  corners_of(slope_of_cells, (const ptrdiff_t[3]){2, 3, 4}, (const size_t[3]){5, 6, 7}, out);
  for (size_t n = 0; n < sizeof out / sizeof *out; n++) {
    double corner[3] = {(double)(2 + n % 5) - .5, (double)(3 + n / 5 % 6) - .5, (double)(4 + n / 30) - .5};
    assert_true(fabs((double)out[n] - (3 + corner[0] - 2 * corner[1] + .5 * corner[2])) < 1e-5);
  }
}

/* A corner has the same coefficient in every call. */
static void corners_do_not_depend_on_calls(void **state) {
  (void)state;
  float all[CORNERS_MOST * CORNERS_MOST * CORNERS_MOST], one;
  const size_t count[3] = {CORNERS_MOST, CORNERS_MOST, CORNERS_MOST}, single[3] = {1, 1, 1};
  corners_of(thin_matter, (const ptrdiff_t[3]){8, 8, 8}, count, all);
  for (size_t n = 0; n < sizeof all / sizeof *all; n++) {
    const ptrdiff_t first[3] = {8 + (ptrdiff_t)(n % CORNERS_MOST),
                                8 + (ptrdiff_t)(n / CORNERS_MOST % CORNERS_MOST),
                                8 + (ptrdiff_t)(n / CORNERS_MOST / CORNERS_MOST)};
    corners_of(thin_matter, first, single, &one);
    assert_true(one == all[n]);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test_setup_teardown(borders_are_smooth, context_up, context_down),
      cmocka_unit_test_setup_teardown(a_wrong_border_is_seen, context_up, context_down),
      cmocka_unit_test_setup_teardown(constants_are_exact, context_up, context_down),
      cmocka_unit_test_setup_teardown(linear_fields_are_exact, context_up, context_down),
      cmocka_unit_test_setup_teardown(dense_is_the_same_field, context_up, context_down),
      cmocka_unit_test_setup_teardown(threads_make_no_difference, context_up, context_down),
      cmocka_unit_test_setup_teardown(impossible_bricks_are_refused, context_up, context_down),
      cmocka_unit_test_setup_teardown(lists_keep_within_the_limit, context_up, context_down),
      cmocka_unit_test(corners_keep_mass_and_range),
      cmocka_unit_test(corners_of_linear_cells),
      cmocka_unit_test(corners_do_not_depend_on_calls),
  };
  return cmocka_run_group_tests_name("bricks", tests, NULL, NULL);
}
