/* analytic/numbers_voxels.c - pictures of voxels that are not finite, all equal, huge, tiny, or the only one.
 */
#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { SIDE = 18, FLOATS = SIDE * SIDE * 4, GRID = 8, VOXELS = GRID * GRID * GRID };

static void aim(stage *set) {
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 15;
  set->scene.render.threads = 1;
  stage_look(set, (vec3){12, -15, 9}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  stage_add_directional(set, (vec3){-0.5, 0.3, -1});
  set->scene.ambient[0] = 0.1;
}

static void fill_noise(float *voxels) {
  for (int i = 0; i < VOXELS; i++)
    voxels[i] = stage_noise(0.9 * (i % GRID), 0.8 * (i / GRID % GRID), 0.7 * (i / GRID / GRID));
}

static hl_scene_volume *add_cube(stage *set, const float *voxels) {
  return stage_add_grid(set, (size_t[3]){GRID, GRID, GRID}, (double[3]){1, 1, 1}, (vec3){-4, -4, -4}, voxels);
}

/* ---- no numbers ---- */

static void render_cube_of(hl_voxel_type type, hl_kernel kernel, const float *voxels, float *pixels) {
  static const hl_opacity_point opacity[] = {{0, 0}, {0.2, 0}, {1, 0.6}};
  stage set;
  stage_open(&set);
  aim(&set);
  set.type = type;
  set.scene.render.kernel = kernel;
  hl_scene_volume *volume = add_cube(&set, voxels);
  volume->transfer_function.opacity = opacity;
  volume->transfer_function.opacity_count = 3;
  volume->shading = HL_SHADING_PHONG;
  stage_render_sheets(&set, pixels);
  stage_close(&set);
}
static void render_cube(const float *voxels, float *pixels) {
  render_cube_of(HL_VOXEL_F32, HL_KERNEL_BSPLINE, voxels, pixels);
}

/* Voxels that are not finite are transparent. The picture is the same as with the most common transparent
 * value in their places. */
static void test_not_finite(void **state) {
  (void)state;
  static float voxels[VOXELS], pixels[FLOATS], expected[FLOATS];
  static const float values[] = {NAN, INFINITY, -INFINITY};
  for (int kind = 0; kind < 4; kind++) {
    fill_noise(voxels);
    for (int i = 0; i < VOXELS; i++) voxels[i] = i % 3 == 1 || voxels[i] < 0.2f ? 0 : voxels[i];
    render_cube(voxels, expected);
    for (int i = 0; i < VOXELS; i++)
      if (i % 3 == 1 && i % 6 != 1) voxels[i] = values[kind < 3 ? kind : i % 3];
    render_cube(voxels, pixels);
    assert_memory_equal(pixels, expected, sizeof expected);
  }
}

static void test_nothing_finite(void **state) {
  (void)state;
  static float voxels[VOXELS], pixels[FLOATS];
  for (int i = 0; i < VOXELS; i++) voxels[i] = i % 2 ? NAN : INFINITY;
  render_cube(voxels, pixels);
  for (int i = 0; i < FLOATS; i++) assert_true(pixels[i] == 0);
}

/* ---- all equal ---- */

static void test_all_equal(void **state) {
  (void)state;
  static const float values[] = {0, 1, -7, 1e-42f, 1e-20f, 1e30f, -1e30f, 1e36f, -1e36f};
  static float voxels[VOXELS], pixels[FLOATS];
  for (size_t v = 0; v < sizeof values / sizeof *values; v++)
    for (int kernel = 0; kernel < 3; kernel++) {
      stage set;
      stage_open(&set);
      aim(&set);
      for (int i = 0; i < VOXELS; i++) voxels[i] = values[v];
      hl_scene_volume *volume = add_cube(&set, voxels);
      stage_set_opacity(&set, volume, 0.2, 1);
      volume->shading = kernel == 1 ? HL_SHADING_PHONG : HL_SHADING_NONE;
      set.scene.render.kernel = (hl_kernel)kernel;
      stage_render_sheets(&set, pixels);
      for (int i = 0; i < SIDE * SIDE; i++) {
        vec3 origin, direction;
        stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &direction);
        double alpha = 1 - pow(0.8, stage_chord((vec3){-4, -4, -4}, (vec3){4, 4, 4}, origin, direction));
        if (!(fabs((double)pixels[4 * i + 3] - alpha) < 1e-3))
          fail_msg("all voxels %g, kernel %d: alpha %.9g instead of %.9g", (double)values[v], kernel,
                   (double)pixels[4 * i + 3], alpha);
        for (int c = 0; c < 3; c++)
          assert_true(pixels[4 * i + c] >= 0 && pixels[4 * i + c] <= 2 * pixels[4 * i + 3]);
      }
      stage_close(&set);
    }
}

/* ---- huge and tiny values ---- */

static void render_scaled(double by, hl_shading shading, hl_sky_type sky, float *pixels) {
  static float voxels[VOXELS];
  static hl_opacity_point opacity[3];
  static hl_color_point color[2];
  stage set;
  stage_open(&set);
  aim(&set);
  fill_noise(voxels);
  for (int i = 0; i < VOXELS; i++) voxels[i] = (float)((double)voxels[i] * by);
  hl_scene_volume *volume = add_cube(&set, voxels);
  const double at[3] = {0.25, 0.5, 1}, alpha[3] = {0, 0.7, 0.9};
  for (int p = 0; p < 3; p++) opacity[p] = (hl_opacity_point){at[p] * by, alpha[p]};
  for (int p = 0; p < 2; p++) color[p] = (hl_color_point){p * by, {p, 0.5, 1 - p}};
  volume->transfer_function.opacity = opacity;
  volume->transfer_function.opacity_count = 3;
  volume->transfer_function.color = color;
  volume->transfer_function.color_count = 2;
  volume->shading = shading;
  set.scene.sky.type = sky;
  for (int c = 0; c < 3; c++) set.scene.sky.color[c] = 1;
  stage_render_sheets(&set, pixels);
  stage_close(&set);
}

/* The picture does not depend on the unit of the data. Floats below 2^-126 have fewer digits; at 2^-135 they
 * have 14 bits. */
static void test_units_of_data(void **state) {
  (void)state;
  static float expected[FLOATS], pixels[FLOATS];
  static const int exponents[] = {90, 40, -40, -90, -105};
  for (int shading = 0; shading < 2; shading++) {
    render_scaled(1, (hl_shading)shading, HL_SKY_NONE, expected);
    for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
      render_scaled(ldexp(1, exponents[e]), (hl_shading)shading, HL_SKY_NONE, pixels);
      for (int i = 0; i < FLOATS; i++)
        if (pixels[i] != expected[i])
          fail_msg("data of 2^%d: %.9g instead of %.9g", exponents[e], (double)pixels[i],
                   (double)expected[i]);
    }
    render_scaled(ldexp(1, -135), (hl_shading)shading, HL_SKY_NONE, pixels);
    for (int i = 0; i < FLOATS; i++) assert_true(isfinite(pixels[i]) && pixels[i] >= 0);
  }
}

/* Data below 1e-30 have no bits of cells, so that voxels that the kernel smooths away may shade the sky. */
static void test_units_of_data_under_a_sky(void **state) {
  (void)state;
  static float expected[FLOATS], pixels[FLOATS];
  static const int exponents[] = {90, -90, -105};
  render_scaled(1, HL_SHADING_NONE, HL_SKY_UNIFORM, expected);
  for (size_t e = 0; e < sizeof exponents / sizeof *exponents; e++) {
    render_scaled(ldexp(1, exponents[e]), HL_SHADING_NONE, HL_SKY_UNIFORM, pixels);
    for (int i = 0; i < FLOATS; i++)
      if (!(fabsf(pixels[i] - expected[i]) <= (exponents[e] > -100 ? 0 : 1e-3f)))
        fail_msg("data of 2^%d under a sky: %.9g instead of %.9g", exponents[e], (double)pixels[i],
                 (double)expected[i]);
  }
}

/* A few voxels hold a huge or tiny fill value among ordinary data. Fill values beyond 1e36 are refused. */
static void test_extremes_among_data(void **state) {
  (void)state;
  static float voxels[VOXELS], pixels[FLOATS];
  static const float values[] = {1e36f, -1e36f, FLT_MIN, 1e-45f};
  for (int kind = 0; kind < 5; kind++) {
    fill_noise(voxels);
    for (int i = 0; i < VOXELS; i++)
      if (i % 5 == 0) voxels[i] = kind < 4 ? values[kind] : values[i / 5 % 2];
    render_cube(voxels, pixels);
    for (int i = 0; i < FLOATS; i++)
      if (!(isfinite(pixels[i]) && pixels[i] >= 0 && (i % 4 != 3 || pixels[i] <= 1)))
        fail_msg("extremes %d: %g", kind, (double)pixels[i]);
  }
}

/* ---- types ---- */

/* Pictures of voxels of whole numbers and of floats agree. Clumps of voxels hold 0 or the greatest number, so
 * that the weighted sums and slopes are the greatest that whole numbers must hold. Means of differences are
 * compared, since single pixels differ by more if a surface turns away from the light. */
static void test_types_agree(void **state) {
  (void)state;
  static const hl_voxel_type whole[] = {HL_VOXEL_U8, HL_VOXEL_U16};
  static float voxels[VOXELS], pixels[FLOATS], expected[FLOATS];
  for (int i = 0; i < VOXELS; i++)
    voxels[i] = stage_noise(0.6 * (i % GRID), 0.5 * (i / GRID % GRID), 0.7 * (i / GRID / GRID)) > 0.5f ? 1
                                                                                                       : 0;
  for (int kernel = HL_KERNEL_BSPLINE; kernel <= HL_KERNEL_LINEAR; kernel++) {
    render_cube_of(HL_VOXEL_F32, (hl_kernel)kernel, voxels, expected);
    for (int type = 0; type < 2; type++) {
      render_cube_of(whole[type], (hl_kernel)kernel, voxels, pixels);
      double apart = 0, seen = 0;
      for (int i = 0; i < FLOATS; i++) {
        apart += fabs((double)pixels[i] - (double)expected[i]) / FLOATS;
        seen += (double)expected[i] / FLOATS;
      }
      assert_true(seen > 0.1);
      assert_true(apart < 5e-5);
    }
  }
}

/* ---- one voxel along an axis ---- */

/* One thick layer looks like a stack of thinner layers, because the values at a grid's borders continue
 * beyond the borders. Shadows are off, because shadow buffers are as coarse as the voxels. */
static void render_layers(const size_t n[3], int axis, size_t layers, hl_shading shading, float *pixels) {
  static float voxels[12 * 12 * 12];
  static const hl_opacity_point opacity[] = {{0.2, 0}, {0.5, 0.4}, {1, 0.6}};
  stage set;
  stage_open(&set);
  aim(&set);
  size_t dimensions[3] = {n[0], n[1], n[2]};
  double spacing[3] = {8.0 / (double)n[0], 8.0 / (double)n[1], 8.0 / (double)n[2]};
  dimensions[axis] *= layers;
  spacing[axis] /= (double)layers;
  for (size_t i = 0; i < dimensions[0] * dimensions[1] * dimensions[2]; i++) {
    size_t at[3] = {i % dimensions[0], i / dimensions[0] % dimensions[1], i / dimensions[0] / dimensions[1]};
    at[axis] = 0;
    voxels[i] = stage_noise(0.9 * (double)at[0], 0.8 * (double)at[1], 0.7 * (double)at[2]);
  }
  hl_scene_volume *volume = stage_add_grid(&set, dimensions, spacing, (vec3){-4, -4, -4}, voxels);
  volume->transfer_function.opacity = opacity;
  volume->transfer_function.opacity_count = 3;
  volume->shading = shading;
  /* the gradient shades the volume's faces, because the two voxels at a face otherwise have another light,
   * which depends on the layers' thickness */
  volume->cut_shading = HL_CUT_SHADING_GRADIENT;
  set.scene.render.shadows = HL_SHADOWS_OFF;
  double smallest = fmin(spacing[0], fmin(spacing[1], spacing[2]));
  set.scene.render.sheet_spacing = 0.2 / smallest;
  stage_render_sheets(&set, pixels);
  stage_close(&set);
}

static void test_one_voxel_thick(void **state) {
  (void)state;
  static const size_t grids[][3] = {{1, 8, 8}, {8, 1, 8}, {8, 8, 1}, {1, 1, 8},
                                    {8, 1, 1}, {1, 8, 1}, {1, 1, 1}, {1, 2, 3}};
  static float thin[FLOATS], thick[FLOATS];
  for (size_t g = 0; g < sizeof grids / sizeof *grids; g++)
    for (int axis = 0; axis < 3; axis++)
      for (int shading = 0; shading < 2 && grids[g][axis] == 1; shading++) {
        double sum = 0, seen = 0;
        render_layers(grids[g], axis, 1, (hl_shading)shading, thin);
        render_layers(grids[g], axis, 5, (hl_shading)shading, thick);
        for (int i = 0; i < FLOATS; i++) {
          sum += fabs((double)thin[i] - (double)thick[i]) / FLOATS;
          seen += (double)thick[i] / FLOATS;
        }
        if (!(sum <
              (shading == HL_SHADING_NONE
                   ? 1e-5
                   : 4e-3))) /* the bar for shaded pictures is higher because normals at borders differ */
          fail_msg("grid %zu along %d: differs by %.3g of %.3g", g, axis, sum, seen);
        assert_true(seen > 0.05);
      }
}

/* ---- transfer functions and sheets ---- */

/* The opacity of a medium does not depend on the length for which it is given, or on how the medium is cut
 * into voxels. */
static void test_unit_distances_and_spacings(void **state) {
  (void)state;
  static const double units[] = {1e-15, 1e-3, 1, 1e3, 1e15}, spacings[] = {0.01, 0.5, 7, 100};
  static float pixels[FLOATS];
  for (size_t u = 0; u < sizeof units / sizeof *units; u++)
    for (size_t s = 0; s < sizeof spacings / sizeof *spacings; s++) {
      stage set;
      stage_open(&set);
      aim(&set);
      hl_scene_volume *volume = add_cube(&set, NULL);
      stage_set_opacity(&set, volume, 0.2, units[u]);
      set.scene.render.sheet_spacing = spacings[s];
      stage_render_sheets(&set, pixels);
      for (int i = 0; i < SIDE * SIDE; i++) {
        vec3 origin, direction;
        stage_eye_ray(&set, i % SIDE, i / SIDE, &origin, &direction);
        double chord = stage_chord((vec3){-4, -4, -4}, (vec3){4, 4, 4}, origin, direction);
        double alpha = -expm1(log1p(-0.2) * chord / units[u]);
        /* the ray passes the box's edge at a distance that floats cannot tell from 0 */
        if (chord > 0 && chord < 1e-4 * spacings[s]) continue;
        if (!(fabs((double)pixels[4 * i + 3] - alpha) < 1e-3)) /* alpha from 1 - 1/2048 on counts as opaque */
          fail_msg("per %g, spacing %g: alpha %.9g instead of %.9g", units[u], spacings[s],
                   (double)pixels[4 * i + 3], alpha);
      }
      stage_close(&set);
    }
}

static void test_refused(void **state) {
  (void)state;
  stage set;
  stage_open(&set);
  aim(&set);
  hl_scene_volume *volume = add_cube(&set, NULL);
  static float voxels[VOXELS] = {FLT_MAX};
  hl_scene_volume *filled = add_cube(&set, voxels);
  stage_refused(&set,
                "/volumes/1/file: its voxels reach 3.4e+38, more than the 1e36 that pictures can be computed "
                "with: scale "
                "them, and mark missing ones by NaN");
  hl_volume_release(filled->volume);
  set.scene.volume_count = 1;
  hl_opacity_point points[3] = {{0, 0}, {1, 0.5}, {0.5, 1}};
  hl_transfer_function *function = &volume->transfer_function;
  function->opacity = points;
  function->opacity_count = 3;
  stage_refused(&set,
                "/volumes/0/transfer_function/opacity/2/0: 0.5 comes after 1: sort the points by value");
  points[0].value = points[1].value = points[2].value = 0.5;
  stage_refused(&set,
                "/volumes/0/transfer_function/opacity/2/0: 0.5 is there a third time: two points at one "
                "value make a step, "
                "remove the others");
  points[2].value = NAN;
  stage_refused(&set,
                "/volumes/0/transfer_function/opacity/2/0: nan is not a number: give a data value between "
                "-1e30 and 1e30");
  points[2] = (hl_opacity_point){0.6, 1.5};
  stage_refused(&set,
                "/volumes/0/transfer_function/opacity/2/1: 1.5 is out of range: give an opacity from 0 to 1");
  points[2].opacity = NAN;
  stage_refused(&set,
                "/volumes/0/transfer_function/opacity/2/1: nan is not a number: give an opacity from 0 to 1");
  points[2].opacity = 1;
  function->unit_distance = 0;
  stage_refused(
      &set,
      "/volumes/0/transfer_function/unit_distance: 0 is not above 0: give the length in world units that the "
      "opacities are for, above 0");
  function->unit_distance = 1;
  set.scene.render.sheet_spacing = 0;
  stage_refused(&set,
                "/render/sheet_spacing: 0 is out of range: give voxels between sheets, from 0.01 to 100");
  set.scene.render.sheet_spacing = 1e9;
  stage_refused(&set,
                "/render/sheet_spacing: 1e+09 is out of range: give voxels between sheets, from 0.01 to 100");
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_not_finite),
      cmocka_unit_test(test_nothing_finite),
      cmocka_unit_test(test_all_equal),
      cmocka_unit_test(test_units_of_data),
      cmocka_unit_test(test_units_of_data_under_a_sky),
      cmocka_unit_test(test_extremes_among_data),
      cmocka_unit_test(test_types_agree),
      cmocka_unit_test(test_one_voxel_thick),
      cmocka_unit_test(test_unit_distances_and_spacings),
      cmocka_unit_test(test_refused),
  };
  return cmocka_run_group_tests_name("numbers_voxels", tests, NULL, NULL);
}
