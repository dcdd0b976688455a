/* analytic/sheets_convergence.c - half of the distance of the sheets gives a quarter of the error (second
 * order). */
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { N = 24, SIDE = 48, FLOATS = SIDE * SIDE * 4 };

/* Adds a blob that fades out well inside its box, with a smooth transfer function. */
static void stage_blob(stage *set) {
  static const hl_opacity_point ramp[] = {{0, 0}, {1, 0.25}};
  static const hl_color_point color[] = {{0, {0.9, 0.5, 0.3}}, {1, {0.4, 0.7, 0.9}}};
  float *voxels = malloc(N * N * N * sizeof *voxels);
  assert_non_null(voxels);
  for (int i = 0; i < N * N * N; i++) {
    double x = i % N - 11.2, y = i / N % N - 11.9, z = i / N / N - 11.5,
           s = fmax(0, 1 - (x * x + 1.3 * y * y + z * z) / 100);
    voxels[i] = (float)(s * s * s);
  }
  hl_scene_volume *blob = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1},
                                         (vec3){-12, -12, -12}, voxels);
  free(voxels);
  blob->transfer_function.opacity = ramp;
  blob->transfer_function.opacity_count = 2;
  blob->transfer_function.color = color;
  blob->transfer_function.color_count = 2;
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 22;
  set->scene.render.shadow_resolution = 192;
  set->scene.ambient[0] = set->scene.ambient[1] = set->scene.ambient[2] = 0.1;
}

/* Returns the root mean square difference from a picture with sixteen sheets for each voxel. */
static double error_at(stage *set, double spacing, const float *finest) {
  static float pixels[FLOATS];
  double sum = 0;
  set->scene.render.sheet_spacing = spacing;
  stage_render_sheets(set, pixels);
  for (int i = 0; i < FLOATS; i++) sum += ((double)pixels[i] - finest[i]) * ((double)pixels[i] - finest[i]);
  return sqrt(sum / FLOATS);
}

static void check_order(vec3 light, hl_shading shading, double least) {
  static float finest[FLOATS];
  stage set;
  stage_open(&set);
  stage_blob(&set);
  set.volumes[0].shading = shading;
  stage_add_directional(&set, light);
  set.scene.render.sheet_spacing = 1.0 / 16;
  stage_render_sheets(&set, finest);
  double coarse = error_at(&set, 2, finest), middle = error_at(&set, 1, finest),
         fine = error_at(&set, 0.5, finest);
  print_message("# %s: error %.3g at 2, %.3g at 1, %.3g at 1/2; ratios %.2f, %.2f\n",
                shading == HL_SHADING_PHONG ? "phong" : "medium", coarse, middle, fine, coarse / middle,
                middle / fine);
  assert_true(middle / fine >= least);
  stage_close(&set);
}

static void test_phong(void **state) {
  (void)state;
  check_order((vec3){0.6, -0.5, -0.7}, HL_SHADING_PHONG, 3.5);
  check_order((vec3){0.6, -0.5, 0.4}, HL_SHADING_PHONG,
              3); /* most of the matter that is seen lies at the terminator, where N.L has a bend */
}

static void test_medium(void **state) {
  (void)state;
  check_order((vec3){0.6, -0.5, -0.7}, HL_SHADING_NONE, 3.5);
  check_order((vec3){0.6, -0.5, 0.4}, HL_SHADING_NONE, 3.5);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_phong), cmocka_unit_test(test_medium)};
  return cmocka_run_group_tests_name("sheets_convergence", tests, NULL, NULL);
}
