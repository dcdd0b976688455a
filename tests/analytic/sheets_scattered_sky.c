/* analytic/sheets_scattered_sky.c - light of a sky that is scattered repeatedly, compared with the white
 * furnace, a half space, and random paths of the reference. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"
#include "scatter/parts.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE, MIDDLE = SIDE / 2 * SIDE + SIDE / 2 };

/* Opens a scene of a block of matter, 48 x 48 x 24, under an even sky of radiance 1. */
static hl_scene_volume *open_stage(stage *set, double opacity, double albedo) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 6;
  for (int c = 0; c < 3; c++) set->scene.ambient[c] = 0;
  set->scene.sky.type = HL_SKY_UNIFORM;
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){48, 48, 24}, (double[3]){1, 1, 1},
                                           (vec3){-24, -24, -12}, NULL);
  stage_set_opacity(set, volume, opacity, 1);
  stage_set_color(set, volume, 1, 1, 1);
  volume->shading = HL_SHADING_NONE;
  for (int c = 0; c < 3; c++) volume->albedo[c] = albedo;
  volume->multiple_scattering = 1;
  stage_look(set, (vec3){0, 0, 40}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  return volume;
}

/* White furnace: matter that absorbs no light, in light of radiance 1 from everywhere, has the radiance 1
 * everywhere, so that the matter cannot be told from a sky of radiance 1. The matter is thin or thick,
 * scatters evenly, forwards or backwards, and is seen from a corner. */
static void test_white_furnace(void **state) {
  (void)state;
  static const double opacities[] = {0.02, 0.4, 0.9}, anisotropies[] = {0, 0.6, -0.4};
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 5; k++) {
    stage set;
    hl_scene_volume *volume = open_stage(&set, opacities[k < 3 ? k : 1], 1);
    volume->anisotropy = anisotropies[k < 3 ? 0 : k - 2];
    set.scene.camera.height = 70;
    stage_look(&set, (vec3){50, -70, 40}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
    stage_render_sheets(&set, pixels);
    double most = 0, seen = 0;
    for (int i = 0; i < PIXELS; i++) {
      double alpha = (double)pixels[4 * i + 3];
      seen += alpha;
      for (int c = 0; c < 3; c++) most = fmax(most, fabs((double)pixels[4 * i + c] - alpha));
    }
    assert_true(seen > 20);
    assert_near(most, 0, 0.01);
    stage_close(&set);
  }
}

/* The light of an even sky enters equally along each line of the grid, in each colour. */
static void test_inflow_of_an_even_sky(void **state) {
  (void)state;
  scatter_inflow inflow[3];
  hl_scene_description plain;
  hl_scene_description_defaults(&plain);
  plain.sky.type = HL_SKY_UNIFORM;
  plain.sky.color[1] = 0.5;
  hl_scatter_sky_inflow(&plain.sky, inflow);
  for (int line = 0; line < SCATTER_LINES; line++)
    for (int c = 0; c < 3; c++) {
      assert_near((double)inflow[c].along[line], c == 1 ? 0.5 : 1, 1e-6);
      assert_near((double)inflow[c].against[line], c == 1 ? 0.5 : 1, 1e-6);
    }
}

/* The light that enters along all lines of the grid has the sky's mean, and more light enters from where the
 * sky is bright. */
static void test_inflow_of_a_hemisphere(void **state) {
  (void)state;
  scatter_inflow inflow[3];
  hl_scene_description plain;
  hl_scene_description_defaults(&plain);
  plain.sky.type = HL_SKY_UNIFORM;
  plain.sky.hemisphere = 1;
  hl_scatter_sky_inflow(&plain.sky, inflow);
  double mean = 0;
  for (int line = 0; line < SCATTER_LINES; line++)
    mean += (double)hl_scatter_line_weight(line) / 2 *
            ((double)inflow[0].along[line] + (double)inflow[0].against[line]);
  assert_near(mean, 0.5, 1e-6);
  int up = 2; /* along z, the light that travels down comes from the zenith */
  assert_true(inflow[0].against[up] > 0.95f && inflow[0].along[up] == 0);
}

/* Chandrasekhar's function H of even scattering ("Radiative transfer", 1950, chapter V), by iteration: 1 /
 * H(m) = sqrt(1 - w) + w/2 times the integral of n H(n) / (m + n) over n from 0 to 1. */
static double chandrasekhar(double albedo) {
  enum { N = 200 };
  static double h[N + 1];
  for (int i = 0; i <= N; i++) h[i] = 1;
  for (int turn = 0; turn < 200; turn++)
    for (int i = 0; i <= N; i++) {
      double m = i < N ? (i + 0.5) / N : 1, sum = 0;
      for (int k = 0; k < N; k++) sum += (k + 0.5) / N * h[k] / (m + (k + 0.5) / N) / N;
      h[i] = 1 / (sqrt(1 - albedo) + albedo / 2 * sum);
    }
  return h[N];
}

/* A half space under an even sky of 1 sends out 1 - sqrt(1 - w) H(m) (Chandrasekhar 1950). By reciprocity,
 * the light that a layer under even light sends towards m equals all of the light that the layer sends out
 * under light from m. */
static void test_half_space(void **state) {
  (void)state;
  static const double albedos[] = {0.5, 0.9, 0.99};
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 3; k++) {
    stage set;
    (void)open_stage(&set, 0.6, albedos[k]);
    stage_render_sheets(&set, pixels);
    double expected = 1 - sqrt(1 - albedos[k]) * chandrasekhar(albedos[k]);
    assert_near((double)pixels[4 * MIDDLE], expected, 0.05 * expected);
    stage_close(&set);
  }
}

/* A slab of albedo 1 with even scattering lies below a hemisphere of radiance 1. `up` and `down` are the
 * light that leaves the slab along its normal, upwards and downwards. Another program traced 200,000 paths,
 * which enter along the normal, in blocks of 64 x 64 x 16 of this optical depth (standard error .001). */
static void test_slab_below_a_hemisphere(void **state) {
  (void)state;
  static const double depths[] = {1, 2, 4, 8}, up[] = {0.339, 0.517, 0.690, 0.821},
                      down[] = {0.293, 0.348, 0.291, 0.178};
  static float pixels[PIXELS * 4];
  for (int k = 0; k < 8; k++) {
    const double expected = k % 2 ? down[k / 2] : up[k / 2];
    stage set;
    stage_open(&set);
    set.scene.width = set.scene.height = SIDE;
    set.scene.camera.height = 4;
    set.scene.sky.type = HL_SKY_UNIFORM;
    set.scene.sky.hemisphere = 1;
    hl_scene_volume *slab = stage_add_grid(&set, (size_t[3]){64, 64, 16}, (double[3]){1, 1, 1},
                                           (vec3){-32, -32, -8}, NULL);
    stage_set_opacity(&set, slab, 1 - exp(-depths[k / 2]), 16);
    stage_set_color(&set, slab, 1, 1, 1);
    slab->shading = HL_SHADING_NONE;
    slab->multiple_scattering = 1;
    stage_look(&set, (vec3){0, 0, k % 2 ? -40 : 40}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
    stage_render_sheets(&set, pixels);
    print_message("# slab of optical depth %g, %s: %+.4f of its light\n", depths[k / 2],
                  k % 2 ? "below" : "above", (double)pixels[4 * MIDDLE] / expected - 1);
    assert_near((double)pixels[4 * MIDDLE], expected, 0.05 * expected);
    stage_close(&set);
  }
}

/* The reference's random paths have the white furnace's radiance 1, too, within four standard errors of the
 * paths. */
static void test_paths_of_the_reference(void **state) {
  (void)state;
  static float pixels[PIXELS * 4], errors[PIXELS * 3];
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.paths = 8;
  options.light_points = 100;
  options.step = 1;
  options.error = errors;
  stage set;
  (void)open_stage(&set, 0.1, 1);
  set.scene.camera.height = 40;
  stage_render(&set, &options, pixels);
  double mean = 0, alpha = 0, square = 0;
  for (int i = 0; i < PIXELS; i++) {
    mean += (double)pixels[4 * i] / PIXELS;
    alpha += (double)pixels[4 * i + 3] / PIXELS;
    square += (double)errors[3 * i] * (double)errors[3 * i] / PIXELS / PIXELS;
  }
  assert_true(alpha > 0.5);
  assert_near(mean, alpha, 4 * sqrt(square) + 0.01);
  stage_close(&set);
}

/* The light of a medium is its albedo times the sky's light, by the sheets and the reference. */
static void test_albedo(void **state) {
  (void)state;
  static float white[PIXELS * 4], grey[PIXELS * 4];
  for (int i = 0; i < 2; i++) {
    hl_reference_options options;
    hl_reference_options_defaults(&options);
    options.light_points = 12;
    options.step = 1;
    for (int k = 0; k < 2; k++) {
      stage set;
      open_stage(&set, 0.1, k == 0 ? 1 : 0.25)->multiple_scattering = 0;
      float *pixels = k == 0 ? white : grey;
      if (i == 0) stage_render_sheets(&set, pixels);
      else stage_render(&set, &options, pixels);
      stage_close(&set);
    }
    assert_true(white[4 * MIDDLE] > 0.1f);
    for (int p = 0; p < PIXELS * 4; p++)
      assert_near((double)grey[p], (double)white[p] * (p % 4 == 3 ? 1 : 0.25), 1e-6);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_white_furnace),
      cmocka_unit_test(test_inflow_of_an_even_sky),
      cmocka_unit_test(test_inflow_of_a_hemisphere),
      cmocka_unit_test(test_half_space),
      cmocka_unit_test(test_slab_below_a_hemisphere),
      cmocka_unit_test(test_paths_of_the_reference),
      cmocka_unit_test(test_albedo),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
