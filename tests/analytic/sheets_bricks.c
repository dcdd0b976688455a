/* analytic/sheets_bricks.c - fields in bricks: with a dense volume's coefficients at level 0 they give its
 * bytes by every method; random octrees give the reference's pictures, a homogeneous one what Beer and
 * Lambert say. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../octree.h"
#include "core/context.h"
#include "reference_stage.h"
#include "volume/in_bricks.h"
#include "ways_to_draw.h"

enum { SIDE = 24, FLOATS = SIDE * SIDE * 4, WIDE = 40, MOST_VOXELS = WIDE * WIDE * WIDE };

/* ---- a dense volume in bricks ---- */

/* The volume's voxel for a lattice point, which lies one behind; beyond its faces the border goes on. */
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
  assert_int_equal(hl_bricks_choose(context, &source, take_all, NULL, &leaves, &count, NULL), HL_OK);
  assert_int_equal(hl_bricks_build(context, pool, &source, leaves, count, "bricks", &bricks, NULL), HL_OK);
  hl_release(context, leaves);
  hl_pool_destroy(pool);
  for (int a = 0; a < 3; a++) bricks.origin[a] = 1;
  assert_int_equal(hl_volume_take_bricks(context, &bricks, &grid, "bricks", &made, NULL), HL_OK);
  assert_null(bricks.directory);
  return made;
}

/* Noise in a box of 20 units. blank: the outermost voxels that are 0 at each face. There a dense volume adds
 * weights before it multiplies, so that its sums are rounded elsewhere. */
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

/* Every voxel, every row, and the statistics. */
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

/* The root of the mean square of the differences. */
static double difference(const float *a, const float *b) {
  double sum = 0;
  for (int i = 0; i < FLOATS; i++) sum += pow((double)a[i] - (double)b[i], 2);
  return sqrt(sum / FLOATS);
}

/* Renders a scene with voxels and then in bricks. close: whether pictures may differ as those of two spacings
 * of sheets do. */
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

static void draw_hard(stage *set) { set_method(set, HL_SHADOWS_HARD, HL_SOFT_CASCADE); }
/* A lattice of voxels leaves out cells in which nothing shows, and samples of the sky's light there. */
static void draw_sky(stage *set) {
  set->scene.sky.type = HL_SKY_UNIFORM;
  for (int c = 0; c < 3; c++) set->scene.sky.color[c] = 0.7;
}
static void draw_scattering(stage *set) {
  set->volumes[0].shading = HL_SHADING_NONE;
  set->volumes[0].multiple_scattering = 1;
}
static void draw_clipped(stage *set) {
  set->volumes[0].clipped = 1;
  for (int a = 0; a < 3; a++) {
    set->volumes[0].clip_min[a] = -7.3;
    set->volumes[0].clip_max[a] = 6.1;
  }
}
static void draw_cut(stage *set) {
  static hl_cut ball;
  hl_cut_defaults(&ball);
  ball.type = HL_CUT_SPHERE;
  ball.radius = 6;
  ball.center[0] = 6;
  set->volumes[0].cuts = &ball;
  set->volumes[0].cut_count = 1;
}
static void draw_two(stage *set) {
  set_method(set, HL_SHADOWS_SOFT, HL_SOFT_CASCADE);
  add_noise(set, (const size_t[3]){23, 40, 21}, 3);
}

static const way ways[] = {{"hard", draw_hard},
                           {"paper", draw_paper},
                           {"cascade", draw_cascade},
                           {"sublights", draw_sublights},
                           {"maximum", draw_maximum},
                           {"gradient opacity", draw_gradient_opacity},
                           {"sky", draw_sky},
                           {"scattering", draw_scattering},
                           {"clipped", draw_clipped},
                           {"cut", draw_cut},
                           {"isosurface", draw_isosurface},
                           {"two volumes", draw_two}};

static void light_scene(stage *set, hl_scene_volume *volume) {
  volume->shading = HL_SHADING_PHONG;
  set_soft_edge(volume);
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = 40;
  stage_add_directional(set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
  stage_add_point(set, (vec3){14, 25, 30})->radius = 3;
}

static void test_ways(void **state) {
  (void)state;
  for (size_t n = 0; n < sizeof ways / sizeof *ways; n++)
    for (int border = 0; border < 2; border++) {
      stage set;
      stage_open(&set);
      light_scene(&set, add_noise(&set, (const size_t[3]){37, 29, 34}, border ? 0 : 3));
      ways[n].draw(&set);
      assert_same_in_bricks(&set, 2 + (int)n % 3, border != 0 || ways[n].draw == draw_sky, ways[n].name);
      stage_close(&set);
    }
}

/* ---- octrees ---- */

enum { CELLS = 32 };

/* A field at random levels in a box of 20 units. */
static hl_scene_volume *add_octree(stage *set, uint64_t seed, octree_value *value, int shift) {
  const size_t n[3] = {CELLS, CELLS, CELLS};
  hl_scene_volume *volume = stage_add_grid(
      set, n, (const double[3]){20.0 / CELLS, 20.0 / CELLS, 20.0 / CELLS}, (vec3){-10, -10, -10}, NULL);
  hl_volume_description grid = stage_describe_volume(volume->volume);
  octree source = {seed, value};
  hl_bricks bricks;
  octree_build(set->context, 2, &source, (const size_t[3]){CELLS + 1, CELLS + 1, CELLS + 1}, shift, 4,
               &bricks);
  for (int a = 0; a < 3; a++) bricks.origin[a] = 0.5;
  hl_volume_release(volume->volume);
  volume->volume = NULL;
  assert_int_equal(hl_volume_take_bricks(set->context, &bricks, &grid, "octree", &volume->volume, NULL),
                   HL_OK);
  stage_look(set, (vec3){31, 17, 23}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  return volume;
}

/* Beer and Lambert: what passes is exp(-extinction * length), whatever the levels are. */
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

/* The sheets against the reference, which has its own evaluation. */
static void test_against_reference(void **state) {
  (void)state;
  for (int n = 0; n < 4; n++) {
    stage set;
    static float sheets[FLOATS], judged[FLOATS];
    stage_open(&set);
    hl_scene_volume *volume = add_octree(&set, 40 + (uint64_t)n, octree_random_value, 2 + n % 3);
    stage_set_opacity(&set, volume, 0.5, 6);
    volume->shading = n % 2 ? HL_SHADING_PHONG : HL_SHADING_NONE;
    set_soft_edge(volume);
    volume->transfer_function.unit_distance = 6;
    stage_add_directional(&set, (vec3){-1, 0.5, -1});
    if (n >= 2) draw_gradient_opacity(&set);
    set.scene.render.sheet_spacing = 0.25;
    set.scene.width = set.scene.height = SIDE;
    set.scene.camera.height = 12; /* pixels are smaller than voxels: each has one ray */
    stage_render_by(&set, true, judged);
    stage_render_by(&set, false, sheets);
    double error = difference(sheets, judged);
    if (!(error < 0.01)) fail_msg("octree %d: the sheets differ from the reference by %.4g", n, error);
    stage_close(&set);
  }
}

/* Any number of threads and any instruction set give the same bytes. */
static void test_same_bytes(void **state) {
  (void)state;
  for (size_t n = 0; n < sizeof ways / sizeof *ways - 1; n++) {
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
      stage_close(&set);
    }
    assert_true(any);
  }
}

/* ---- places without data ---- */

static double with_holes(uint64_t seed, int level, const ptrdiff_t point[3]) {
  ptrdiff_t place = (point[0] + 2 * point[1] + 3 * point[2]) * ((ptrdiff_t)1 << level);
  return place % 64 < 24 ? (double)NAN : octree_random_value(seed, level, point);
}

/* Coefficients that are no numbers are empty space for the sheets and the reference, and no statistics. */
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

/* ---- what is refused ---- */

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
      cmocka_unit_test(test_voxels),      cmocka_unit_test(test_ways),
      cmocka_unit_test(test_homogeneous), cmocka_unit_test(test_against_reference),
      cmocka_unit_test(test_same_bytes),  cmocka_unit_test(test_holes),
      cmocka_unit_test(test_refusals)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
