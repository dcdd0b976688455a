/* analytic/sheets_bricks.c - fields in bricks that have the coefficients of a dense volume at level 0.
 * Pictures of such fields have the bytes of the dense volume's pictures by every method, also with masks,
 * functions of two numbers, colours and layers. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "core/context.h"
#include "reference_stage.h"
#include "render/renderer_state.h"
#include "volume/in_bricks.h"
#include "ways_in_bricks.h"

enum { WIDE = 40, MOST_VOXELS = WIDE * WIDE * WIDE };

/* ---- a dense volume in bricks ---- */

/* Fills a lattice's points with the volume's voxels. Voxel n belongs to the point n + 1. Beyond the volume's
 * faces, the border voxels are repeated. */
static void fill_from_voxels(void *data, int level, const ptrdiff_t first[3], const size_t count[3],
                             float *out) {
  const hl_volume *volume = data;
  size_t n = 0;
  assert_int_equal(level, 0);
  for (ptrdiff_t k = 0; k < (ptrdiff_t)count[2]; k++)
    for (ptrdiff_t j = 0; j < (ptrdiff_t)count[1]; j++)
      for (ptrdiff_t i = 0; i < (ptrdiff_t)count[0]; i++, n++) {
        const ptrdiff_t at[3] = {first[0] + i - 1, first[1] + j - 1, first[2] + k - 1};
        size_t v[3];
        for (int a = 0; a < 3; a++) {
          ptrdiff_t last = (ptrdiff_t)volume->dimension[a] - 1;
          v[a] = (size_t)(at[a] < 0 ? 0 : at[a] > last ? last : at[a]);
        }
        out[n] = ((const float *)hl_volume_row(volume, v[1], v[2]))[v[0]];
      }
}

static hl_bricks_choice take_all(void *data, int level, const size_t brick[3]) {
  (void)data, (void)level, (void)brick;
  return HL_BRICKS_LEAF;
}

static hl_volume *in_bricks(hl_context *context, hl_volume *volume, int shift) {
  hl_volume_description grid = stage_describe_volume(volume);
  hl_bricks_source source = {.shift = shift, .levels = 1, .fill = fill_from_voxels, .data = volume};
  hl_bricks_leaf *leaves = NULL;
  size_t count = 0;
  hl_pool *pool = NULL;
  hl_bricks bricks;
  hl_volume *made = NULL;
  for (int a = 0; a < 3; a++) source.dimension[a] = volume->dimension[a] + 2;
  assert_int_equal(hl_pool_create(context, 2, &pool, NULL), HL_OK);
  assert_int_equal(hl_bricks_choose(context, &source, take_all, NULL, "a field", &leaves, &count, NULL),
                   HL_OK);
  assert_int_equal(hl_bricks_build(context, pool, &source, leaves, count, "bricks", &bricks, NULL), HL_OK);
  hl_release(context, leaves);
  hl_pool_destroy(pool);
  for (int a = 0; a < 3; a++) bricks.origin[a] = 1;
  assert_int_equal(hl_volume_take_bricks(context, &bricks, &grid, "bricks", &made, NULL), HL_OK);
  assert_null(bricks.directory);
  made->colors = volume->colors; /* the colours now belong to the new volume */
  volume->colors = NULL;
  return made;
}

/* Adds noise in a box of 20 units. blank: the number of layers of voxels at each face that are 0. A dense
 * volume adds the weights of repeated voxels before it multiplies. Without blank layers, its sums at the
 * faces would be rounded in another way than the sums of bricks. */
static hl_scene_volume *add_noise(stage *set, const size_t n[3], size_t blank) {
  static float voxels[MOST_VOXELS];
  double spacing[3];
  for (int a = 0; a < 3; a++) spacing[a] = 20 / (double)n[a];
  for (size_t v = 0; v < n[0] * n[1] * n[2]; v++) {
    const size_t at[3] = {v % n[0], v / n[0] % n[1], v / n[0] / n[1]};
    voxels[v] = stage_noise((double)at[0] * 0.9, (double)at[1] * 1.1, (double)at[2] * 1.3);
    for (int a = 0; a < 3; a++)
      if (at[a] < blank || at[a] + blank >= n[a]) voxels[v] = 0;
  }
  hl_scene_volume *made = stage_add_grid(set, n, spacing, (vec3){-10, -10, -10}, voxels);
  stage_set_opacity(set, made, 0.4, 6);
  stage_look(set, (vec3){31, 17, 23}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  return made;
}

/* A volume in bricks has the same voxels, rows and statistics as the dense volume. */
static void test_voxels(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  hl_volume *dense = add_noise(&set, (const size_t[3]){19, 12, 23}, 0)->volume;
  for (int shift = 2; shift <= 5; shift++) {
    hl_volume *made = in_bricks(set.context, dense, shift);
    float row[WIDE];
    for (size_t k = 0; k < dense->dimension[2]; k++)
      for (size_t j = 0; j < dense->dimension[1]; j++) {
        assert_memory_equal(hl_volume_row_in(made, j, k, row), hl_volume_row(dense, j, k), 19 * sizeof *row);
        for (size_t i = 0; i < dense->dimension[0]; i++)
          assert_true(hl_volume_value(made, i, j, k) == hl_volume_value(dense, i, j, k));
      }
    assert_memory_equal(made->histogram, dense->histogram, sizeof made->histogram);
    assert_true(made->minimum == dense->minimum && made->maximum == dense->maximum);
    assert_true(fabs(made->mean - dense->mean) < 1e-12);
    hl_volume_release(made);
  }
  stage_close(&set);
}

/* ---- pictures ---- */

static void put_in_bricks(stage *set, int shift) {
  for (size_t v = 0; v < set->scene.volume_count; v++) {
    hl_volume *old = set->volumes[v].volume;
    set->volumes[v].volume = in_bricks(set->context, old, shift);
    hl_volume_release(old);
  }
}

static void draw_two(stage *set) {
  set_method(set, HL_SHADOWS_SOFT, HL_SOFT_CASCADE);
  add_noise(set, (const size_t[3]){23, 40, 21}, 3);
}

/* Renders a scene with voxels and then with bricks. close: whether the pictures may differ by as much as
 * pictures with two distances of sheets differ. */
static void assert_same_in_bricks(stage *set, int shift, bool close, const char *what) {
  static float packed[FLOATS], made[FLOATS];
  set->scene.width = set->scene.height = SIDE;
  set->scene.render.kernel = HL_KERNEL_BSPLINE;
  stage_render_sheets(set, packed);
  put_in_bricks(set, shift);
  stage_render_sheets(set, made);
  bool any = false;
  for (int i = 0; i < FLOATS; i++) {
    any |= packed[i] > 0;
    if (!close && packed[i] != made[i])
      fail_msg("%s, bricks of %d: pixel %d, %d: %.9g in voxels, %.9g in bricks", what, 1 << shift,
               i / 4 % SIDE, i / 4 / SIDE, (double)packed[i], (double)made[i]);
  }
  assert_true(any);
  if (!(difference(packed, made) < 1e-5))
    fail_msg("%s, bricks of %d: the picture differs by %.4g", what, 1 << shift, difference(packed, made));
}

static void hold_against_voxels(way_to_draw *draw, int shift, bool border, const char *what) {
  stage set;
  stage_open(&set);
  light_scene(&set, add_noise(&set, (const size_t[3]){37, 29, 34}, border ? 0 : 3));
  draw(&set);
  assert_same_in_bricks(&set, shift, border || draw == draw_sky, what);
  close_way(&set);
}

static void test_ways(void **state) {
  (void)state;
  for (size_t n = 0; n < WAYS; n++)
    for (int border = 0; border < 2; border++)
      hold_against_voxels(ways[n].draw, 2 + (int)n % 3, border != 0, ways[n].name);
  for (int border = 0; border < 2; border++) hold_against_voxels(draw_two, 3, border != 0, "two volumes");
}

/* Every layer beside the picture has the same bytes. */
static void test_layers(void **state) {
  (void)state;
  static layer_buffers packed, made;
  stage set;
  stage_open(&set);
  light_scene(&set, add_noise(&set, (const size_t[3]){37, 29, 34}, 3));
  set_method(&set, HL_SHADOWS_SOFT, HL_SOFT_CASCADE);
  set.scene.render.kernel = HL_KERNEL_BSPLINE;
  render_layers(&set, &packed);
  put_in_bricks(&set, 3);
  render_layers(&set, &made);
  assert_memory_equal(&packed.floats, &made.floats, sizeof made.floats);
  bool any = false;
  for (int i = 0; i < SIDE * SIDE * 3; i++)
    any |= packed.floats.shadow[0][i] > 0 && packed.floats.shadow[0][i] < 1;
  assert_true(any);
  stage_close(&set);
}

/* While a cut stays in its place, the tables that follow from it are kept for the next frame. These tables
 * must be right also if the lattice of the bricks lies half a voxel beside the voxels. */
static void test_kept_cut(void **state) {
  (void)state;
  static const hl_cut CUT = {.type = HL_CUT_PLANE, .normal = {0, 0, 1}};
  static float pixels[FLOATS];
  stage set;
  stage_open(&set);
  hl_scene_volume *noise = add_noise(&set, (const size_t[3]){37, 29, 34}, 3);
  light_scene(&set, noise);
  set.scene.width = set.scene.height = SIDE;
  set.scene.render.kernel = HL_KERNEL_BSPLINE;
  noise->cuts = &CUT, noise->cut_count = 1;
  put_in_bricks(&set, 3);
  for (int axis = 0; axis < 3; axis++) noise->volume->bricks->origin[axis] = 0.5;
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  for (int frame = 0; frame < 2; frame++) {
    stage_render_with(&set, renderer, pixels);
    assert_int_equal(renderer->cache.prepared[0].tables_version, 1);
  }
  hl_renderer_destroy(renderer);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_voxels), cmocka_unit_test(test_ways),
                                     cmocka_unit_test(test_layers), cmocka_unit_test(test_kept_cut)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
