/* analytic/sheets_levels.c - fields at random levels. By every way to draw, the picture of such a field is
 * near the picture of the dense volume of its coefficients and near the reference's picture, and has the same
 * bytes with any instruction set. A homogeneous field follows the law of Beer and Lambert. The borders of
 * levels do not show. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../octree.h"
#include "core/context.h"
#include "grid/faces.h"
#include "grid/make_grid.h"
#include "grid/relevant.h"
#include "reference_stage.h"
#include "render/hot.h"
#include "scene/geometry/placement.h"
#include "volume/in_bricks.h"
#include "ways_in_bricks.h"

enum { CELLS = 32, LEVELS = 4 };

/* A field at random levels. The field's box has 20 units where the lattice's cells are voxels. */
typedef struct field_kind {
  octree_value *value;
  int shift, levels;
  /* whether voxels stand on the lattice's points between the outermost ones, or in the middles of its cells
   */
  bool on_points;
} field_kind;

static hl_scene_volume *add_field(stage *set, uint64_t seed, field_kind kind) {
  const size_t side = CELLS - (size_t)kind.on_points, n[3] = {side, side, side};
  const double step = 20.0 / CELLS, low = -step * (double)side / 2;
  hl_scene_volume *volume = stage_add_grid(set, n, (const double[3]){step, step, step}, (vec3){low, low, low},
                                           NULL);
  hl_volume_description grid = stage_describe_volume(volume->volume);
  octree source = {seed, kind.value};
  hl_bricks bricks;
  octree_build(set->context, 2, &source, (const size_t[3]){CELLS + 1, CELLS + 1, CELLS + 1}, kind.shift,
               kind.levels, &bricks);
  for (int a = 0; a < 3; a++) bricks.origin[a] = kind.on_points ? 1 : 0.5;
  hl_volume_release(volume->volume);
  volume->volume = NULL;
  assert_int_equal(hl_volume_take_bricks(set->context, &bricks, &grid, "octree", &volume->volume, NULL),
                   HL_OK);
  stage_look(set, (vec3){31, 17, 23}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  return volume;
}

static hl_scene_volume *add_octree(stage *set, uint64_t seed, octree_value *value, int shift) {
  return add_field(set, seed, (field_kind){value, shift, LEVELS, false});
}

/* By the law of Beer and Lambert, exp(-extinction * length) of the light passes, whatever the levels are. */
static void test_homogeneous(void **state) {
  (void)state;
  for (uint64_t seed = 0; seed < 6; seed++) {
    stage set;
    static float pixels[FLOATS];
    stage_open(&set);
    hl_scene_volume *volume = add_octree(&set, seed, octree_constant_value, 2 + (int)(seed % 3));
    assert_true(volume->volume->minimum == volume->volume->maximum && volume->volume->mean == 0.75);
    stage_set_opacity(&set, volume, 0.4, 6);
    set.scene.width = set.scene.height = SIDE;
    set.scene.camera.height = 12; /* pixels are smaller than voxels: each has one ray */
    stage_render_sheets(&set, pixels);
    int crossed = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
      vec3 origin, direction;
      stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &direction);
      double length = stage_chord((vec3){-10, -10, -10}, (vec3){10, 10, 10}, origin, direction);
      double passes = pow(0.6, length / 6), found = 1 - (double)pixels[4 * i + 3];
      if (!(fabs(found - passes) < 1e-4))
        fail_msg("pixel %d, %d: %.9g passes, not %.9g", i % SIDE, i / SIDE, found, passes);
      crossed++;
    }
    assert_true(crossed == SIDE * SIDE);
    stage_close(&set);
  }
}

/* The sheets' pictures are near the pictures of the reference, which evaluates fields by code of its own. */
static void test_against_reference(void **state) {
  (void)state;
  for (int n = 0; n < 7; n++) {
    stage set;
    static float sheets[FLOATS], judged[FLOATS];
    stage_open(&set);
    hl_scene_volume *volume = add_octree(&set, 40 + (uint64_t)n, octree_random_value, 2 + n % 3);
    stage_set_opacity(&set, volume, 0.5, 6);
    volume->shading = n % 2 ? HL_SHADING_PHONG : HL_SHADING_NONE;
    set_soft_edge(volume);
    volume->transfer_function.unit_distance = 6;
    stage_add_directional(&set, (vec3){-1, 0.5, -1});
    if (n == 2 || n == 3) draw_gradient_opacity(&set);
    if (n == 4) draw_mask(&set);
    if (n == 5) draw_function_of_gradients(&set);
    if (n == 6) draw_function_of_volume(&set);
    set.scene.render.sheet_spacing = 0.25;
    set.scene.width = set.scene.height = SIDE;
    set.scene.camera.height = 12; /* pixels are smaller than voxels: each has one ray */
    stage_render_by(&set, true, judged);
    stage_render_by(&set, false, sheets);
    double error = difference(sheets, judged);
    if (!(error < 0.01)) fail_msg("octree %d: the sheets differ from the reference by %.4g", n, error);
    close_way(&set);
  }
}

/* Any number of threads and any instruction set give the same bytes. */
static void test_same_bytes(void **state) {
  (void)state;
  for (size_t n = 0; n < WAYS; n++) {
    static float first[FLOATS], pixels[FLOATS];
    bool any = false;
    for (int set_of = HL_INSTRUCTION_SET_SCALAR; set_of <= HL_INSTRUCTION_SET_AVX512_VBMI; set_of++) {
      if (!hl_cpu_has_instruction_set((hl_instruction_set)set_of)) continue;
      stage set;
      hl_context_options options;
      hl_context_options_defaults(&options);
      options.instruction_set = (hl_instruction_set)set_of;
      stage_open_with(&set, &options);
      light_scene(&set, add_octree(&set, 7, octree_random_value, 3));
      ways[n].draw(&set);
      set.scene.width = set.scene.height = SIDE;
      set.scene.render.threads = 1 + set_of % 3;
      stage_render_sheets(&set, pixels);
      if (set_of == HL_INSTRUCTION_SET_SCALAR) memcpy(first, pixels, sizeof first);
      for (int i = 0; i < FLOATS; i++) any |= pixels[i] > 0;
      if (memcmp(first, pixels, sizeof first) != 0)
        fail_msg("%s: other bytes with %s", ways[n].name,
                 hl_instruction_set_name((hl_instruction_set)set_of));
      close_way(&set);
    }
    assert_true(any);
  }
}

/* ---- against one level ---- */

/* Returns a value of a random field that is 0 wherever a B-spline of any level reaches one unit from the
 * box's border. */
static double inner_random_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  for (int a = 0; a < 3; a++) {
    ptrdiff_t at = point[a] * ((ptrdiff_t)1 << level);
    if (at < 10 || at > CELLS - 10) return 0;
  }
  return octree_random_value(seed, level, point);
}

/* Puts the coefficients of level 0, which the field of the first volume has everywhere, into a dense
 * volume. */
static void make_dense(stage *set) {
  static float voxels[CELLS * CELLS * CELLS];
  hl_volume *field = set->volumes[0].volume, *dense = NULL;
  hl_volume_description grid = stage_describe_volume(field);
  for (size_t k = 0; k < field->dimension[2]; k++)
    for (size_t j = 0; j < field->dimension[1]; j++)
      hl_volume_row_in(field, j, k, voxels + (k * field->dimension[1] + j) * field->dimension[0]);
  grid.voxels = voxels;
  assert_int_equal(hl_volume_create(set->context, &grid, &dense, NULL), HL_OK);
  dense->colors = field->colors; /* the colours now belong to the dense volume */
  field->colors = NULL;
  for (size_t v = 0; v < set->scene.volume_count; v++) {
    if (set->volumes[v].volume != field) continue;
    hl_volume_release(field);
    hl_volume_retain(dense);
    set->volumes[v].volume = dense;
  }
  hl_volume_release(dense);
}

static double greatest(const float *pixels) {
  double most = 0;
  for (int i = 0; i < FLOATS; i++) most = fmax(most, (double)pixels[i]);
  return most;
}

/* Asserts that two maximum projections are the same. A value counts if its opacity is above 0. The two
 * volumes' tables of opacity are exact to one step of their ranges, so that a sample may show such a value in
 * one of the pictures alone. */
static void assert_same_projections(const float *levels, const float *dense) {
  int apart = 0;
  for (int i = 0; i < FLOATS; i += 4) {
    float most = 0;
    for (int c = 0; c < 4; c++) most = fmaxf(most, fabsf(levels[i + c] - dense[i + c]));
    apart += most > 1e-6f;
    assert_true(most < 1e-6f || fabsf(levels[i + 3] - dense[i + 3]) == 0.25f);
  }
  assert_true(apart <= 1);
}

/* The whole field is one B-spline of level 0. The dense volume of its coefficients gives the same picture by
 * every way to draw. */
static void test_ways_against_dense(void **state) {
  (void)state;
  for (size_t n = 0; n < WAYS; n++) {
    static float levels[FLOATS], dense[FLOATS];
    stage set;
    stage_open(&set);
    light_scene(&set, add_field(&set, 7 + n, (field_kind){inner_random_value, 2, 3, true}));
    ways[n].draw(&set);
    set.scene.width = set.scene.height = SIDE;
    set.scene.render.kernel = HL_KERNEL_BSPLINE;
    stage_render_sheets(&set, levels);
    make_dense(&set);
    stage_render_sheets(&set, dense);
    /* the sheets lie where matter may be visible, which bricks of coarse levels bound less exactly than
     * voxels do */
    if (ways[n].draw == draw_maximum) assert_same_projections(levels, dense);
    else if (!(difference(levels, dense) < 2e-3))
      fail_msg("%s: the picture at levels differs from the dense one by %.4g", ways[n].name,
               difference(levels, dense));
    assert_true(greatest(dense) > 0.05);
    close_way(&set);
  }
}

/* ---- borders of levels ---- */

enum { WIDE = 96, REACH = 2 };

/* Two smooth fields follow. A cubic B-spline of spacing s on coefficients c is c plus s^2 / 6 times c's
 * Laplacian plus terms of s^4 (derived: the B-spline's variance along an axis is s^2 / 3). So the
 * coefficients f - s^2 / 6 times f's Laplacian give a quadratic field exactly, whatever the spacing is, and
 * waves up to terms of s^4.
 */
static double quadratic_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  (void)seed;
  static const double bend[3] = {1, 0.6, 0.8};
  const double scale = ldexp(1, level);
  double sum = 0.95, laplacian = 0;
  for (int a = 0; a < 3; a++) {
    const double at = (scale * (double)point[a] - CELLS / 2.0) / CELLS;
    sum -= 2 * bend[a] * at * at;
    laplacian -= 4 * bend[a] / (CELLS * CELLS);
  }
  return sum - scale * scale / 6 * laplacian;
}
static double wave_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  (void)seed;
  static const double turns[3] = {0.1, 0.08, 0.07}; /* radians a cell */
  const double scale = ldexp(1, level);
  double product = 0.4, squares = 0;
  for (int a = 0; a < 3; a++) {
    product *= sin(turns[a] * scale * (double)point[a] + 0.3 * a);
    squares += turns[a] * turns[a];
  }
  return 0.5 + product * (1 + scale * scale / 6 * squares);
}

static void draw_wide(octree_value *value, int levels, float spoil, hl_shadows shadows, float *pixels) {
  stage set;
  stage_open(&set);
  light_scene(&set, add_field(&set, 5, (field_kind){value, 2, levels, false}));
  set.scene.camera.type = HL_CAMERA_ORTHOGRAPHIC;
  set.scene.camera.height = 36;
  set.scene.render.shadows = shadows;
  set.scene.width = set.scene.height = WIDE;
  const hl_bricks *bricks = set.volumes[0].volume->bricks;
  const size_t stored = ((size_t)1 << bricks->shift) + BRICK_MARGIN, count = stored * stored * stored;
  for (size_t n = 0; n < bricks->slots * count; n += stored) bricks->pool[n] += spoil;
  stage_render_sheets(&set, pixels);
  stage_close(&set);
}

/* Returns the greatest value of the high-passed difference of two pictures: the difference minus its mean
 * over (2 REACH + 1)^2 pixels. */
static double high_passed(const float *a, const float *b) {
  const int around = (2 * REACH + 1) * (2 * REACH + 1);
  double most = 0;
  for (int y = REACH; y < WIDE - REACH; y++)
    for (int x = REACH; x < WIDE - REACH; x++)
      for (int c = 0; c < 4; c++) {
        double mean = 0;
        for (int n = 0; n < around; n++) {
          int i = 4 * ((y - REACH + n / (2 * REACH + 1)) * WIDE + x - REACH + n % (2 * REACH + 1)) + c;
          mean += ((double)a[i] - (double)b[i]) / around;
        }
        const int i = 4 * (y * WIDE + x) + c;
        most = fmax(most, fabs((double)a[i] - (double)b[i] - mean));
      }
  return most;
}

/* The picture of a smooth field at random levels shows no borders, with hard and with soft shadows. The
 * difference from the picture of the field at one level changes by less than 0.1 % from pixel to pixel. If
 * coefficients at the borders of bricks were wrong by 1 %, the test would fail. */
static void test_borders(void **state) {
  (void)state;
  octree_value *values[] = {quadratic_value, wave_value};
  const hl_shadows shadows[] = {HL_SHADOWS_HARD, HL_SHADOWS_SOFT};
  static float one[WIDE * WIDE * 4], levels[WIDE * WIDE * 4], spoiled[WIDE * WIDE * 4], hard[WIDE * WIDE * 4];
  for (int n = 0; n < 2; n++)
    for (int kind = 0; kind < 2; kind++) {
      draw_wide(values[n], 1, 0, shadows[kind], one);
      draw_wide(values[n], 3 - n, 0, shadows[kind], levels);
      draw_wide(values[n], 3 - n, 0.01f, shadows[kind], spoiled);
      print_message("# smooth field %d, %s shadows: borders show by %.3g\n", n, kind == 0 ? "hard" : "soft",
                    high_passed(levels, one));
      assert_true(high_passed(levels, one) < 1e-3);
      assert_true(high_passed(spoiled, one) > 2e-3);
      if (kind == 0) memcpy(hard, one, sizeof hard);
      else assert_true(high_passed(hard, one) > 2e-5); /* soft shadows differ from hard shadows */
    }
}

/* ---- the box's faces ---- */

/* The field has matter at the far end of x, and no matter at the far end of y. */
static double far_value(uint64_t seed, int level, const ptrdiff_t point[3]) {
  (void)seed;
  const ptrdiff_t scale = (ptrdiff_t)1 << level;
  return point[0] * scale > CELLS - 6 && point[1] * scale < CELLS / 2 ? 1 : 0;
}

/* The last cell of a lattice of corners ends at the box's far face. The light at the face depends on that
 * cell's brick. The next brick in memory begins the next row, in which nothing shows, and must not be read.
 */
static void test_far_faces(void **state) {
  (void)state;
  stage set;
  hl_pool *pool = NULL;
  grid grid;
  classifier classifier;
  stage_open(&set);
  hl_scene_volume *volume = add_field(&set, 3, (field_kind){far_value, 2, 1, false});
  set_soft_edge(volume);
  const kernel *kernel = hl_kernel_get(HL_KERNEL_BSPLINE);
  const grid_functions *functions = hl_hot_functions(HL_INSTRUCTION_SET_SCALAR)->grid;
  const grid_source source = {volume, kernel, volume->volume->index_to_world,
                              hl_scene_volume_empty_value(volume)};
  assert_int_equal(hl_pool_create(set.context, 1, &pool, NULL), HL_OK);
  assert_int_equal(hl_grid_create(set.context, pool, functions, &source, &grid, NULL), HL_OK);
  assert_int_equal(hl_classifier_create(set.context, volume, NULL, &grid, &classifier, NULL), HL_OK);
  hl_grid_mark_relevant(&grid, functions, &classifier, pool);
  hl_faces_find(pool, kernel, &classifier, &grid);
  assert_int_equal(grid.dimension[0] % HL_BRICK_CELLS,
                   HL_BRICK_CELLS - 1); /* a brick ends at the last cell */
  assert_true(grid.face_shows[0][1] && !grid.face_shows[0][0]);
  hl_classifier_release(set.context, &classifier);
  hl_grid_release(set.context, &grid);
  hl_pool_destroy(pool);
  stage_close(&set);
}

/* ---- places without data ---- */

static double with_holes(uint64_t seed, int level, const ptrdiff_t point[3]) {
  ptrdiff_t place = (point[0] + 2 * point[1] + 3 * point[2]) * ((ptrdiff_t)1 << level);
  return place % 64 < 24 ? (double)NAN : octree_random_value(seed, level, point);
}

/* Coefficients that are not finite are empty space, for the sheets and for the reference. Such coefficients
 * do not count in the statistics. */
static void test_holes(void **state) {
  (void)state;
  stage set;
  static float sheets[FLOATS], judged[FLOATS];
  stage_open(&set);
  hl_scene_volume *volume = add_octree(&set, 12, with_holes, 3);
  const hl_volume *made = volume->volume;
  uint64_t counted = 0;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) counted += made->histogram[bin];
  assert_true(made->nonfinite_count > 0 && counted > 0);
  assert_true(made->minimum >= 0 && made->maximum <= 1 && made->mean > 0.3 && made->mean < 0.7);
  set_soft_edge(volume);
  volume->transfer_function.unit_distance = 6;
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 12; /* pixels are smaller than voxels: each has one ray */
  stage_render_by(&set, true, judged);
  stage_render_by(&set, false, sheets);
  double error = difference(sheets, judged);
  if (!(error < 0.01)) fail_msg("the sheets differ from the reference by %.4g", error);
  stage_close(&set);
}

/* ---- inputs that are refused ---- */

static void assert_refused(const stage *set, const char *message) {
  hl_scene *scene = NULL;
  hl_error error;
  assert_int_equal(hl_scene_create(set->context, &set->scene, &scene, &error), HL_ERROR_UNSUPPORTED);
  assert_string_equal(error.message, message);
}

static void test_refusals(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  add_octree(&set, 1, octree_random_value, 3);
  set.scene.render.kernel = HL_KERNEL_LINEAR;
  assert_refused(&set,
                 "/render/kernel: volume 0 is a field at levels, made of B-splines: use \"bspline\" or "
                 "\"interpolating\", which are the same there, or save it as voxels");
  set.scene.render.kernel = HL_KERNEL_BSPLINE;
  set.scene.render.reconstruction = HL_RECONSTRUCTION_SPLAT;
  assert_refused(&set,
                 "/render/reconstruction: volume 0 is a field in bricks, which has no voxels to splat: use "
                 "\"gather\"");
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_homogeneous), cmocka_unit_test(test_against_reference),
      cmocka_unit_test(test_same_bytes),  cmocka_unit_test(test_ways_against_dense),
      cmocka_unit_test(test_borders),     cmocka_unit_test(test_far_faces),
      cmocka_unit_test(test_holes),       cmocka_unit_test(test_refusals)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
