/* analytic/layers_sky.c - the layers of the sky, against closed forms of the sky's shadow, and the sum of all
 * layers. Each closed form is tested on the sheets and on the reference. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 10, PIXELS = SIDE * SIDE, MIDDLE = SIDE / 2 * SIDE + SIDE / 2 };

/* The buffers of the layers whose sum is the picture, and of the layer of the sky's shadow. */
typedef struct sky_layers {
  float pixels[PIXELS * 4], ambient[PIXELS * 3], emission[PIXELS * 3], sky[PIXELS * 3], shadow[PIXELS * 3],
      light[PIXELS * 3];
} sky_layers;

/* directions: the reference's number of directions of the sky; 0: the sheets render. */
static void render_layers(stage *set, int directions, sky_layers *made) {
  hl_reference_options options;
  const hl_light_layers lights[1] = {{.picture = made->light}};
  memset(made, 0xff, sizeof *made); /* NaN shows which values were not written */
  const hl_layers wanted = {.struct_size = sizeof wanted,
                            .ambient = made->ambient,
                            .emission = made->emission,
                            .lights = lights,
                            .light_count = set->scene.light_count,
                            .sky = made->sky,
                            .sky_shadow = made->shadow};
  if (set->scene.light_count == 0) memset(made->light, 0, sizeof made->light);
  hl_reference_options_defaults(&options);
  options.light_points = directions;
  stage_render_layers(set, directions > 0 ? &options : NULL, made->pixels, &wanted);
}

static void open_sky(stage *set) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 24;
  set->scene.sky.type = HL_SKY_UNIFORM;
}

/* ---- the shadow ---- */

/* The mean of (E2(t) + E2(T - t)) / 2 over the depth t in a slab of the optical depth T, seen through the
 * slab. E2(t) is the integral of exp(-t / mu) over mu from 0 to 1. cast: the factor of the slab's extinction
 * for shadows. */
static double shadow_in_slab(double whole, double cast) {
  double sum = 0, weights = 0;
  for (int i = 0; i < 200; i++) {
    double t = whole * (i + 0.5) / 200, weight = exp(-t), mean = 0;
    for (int j = 0; j < 400; j++) {
      double mu = (j + 0.5) / 400;
      mean += (exp(-cast * t / mu) + exp(-cast * (whole - t) / mu)) / 800;
    }
    sum += weight * mean;
    weights += weight;
  }
  return sum / weights;
}

/* The layer of the sky's shadow shows the colour of the matter that hides the sky. It shows neither the
 * haze's own colour nor the colour of an even sky. */
static void test_shadow_in_slab(void **state) {
  (void)state;
  static sky_layers made;
  const double sigma = 0.1;
  stage set;
  open_sky(&set);
  hl_scene_volume *slab = stage_add_grid(&set, (size_t[3]){60, 60, 8}, (double[3]){2, 2, 1},
                                         (vec3){-60, -60, -4}, NULL);
  stage_set_opacity(&set, slab, 1 - exp(-sigma), 1);
  stage_set_color(&set, slab, 0.1, 0.9, 0.3);
  slab->attenuation_color[1] = 0.5;
  slab->attenuation_color[2] = 0;
  set.scene.sky.color[0] = 0.3;
  set.scene.sky.strength = 3;
  for (int i = 0; i < 4; i++) {
    slab->receives_shadow = i < 2;
    render_layers(&set, i % 2 == 1 ? 100 : 0, &made);
    for (int c = 0; c < 3; c++) {
      double expected = i < 2 ? shadow_in_slab(8 * sigma, slab->attenuation_color[c]) : 1;
      assert_near(made.shadow[3 * MIDDLE + c], expected, 0.025);
    }
  }
  stage_close(&set);
}

/* ---- the sum ---- */

/* A ball of haze, or a ball with a surface, stands above a plate that absorbs green light alone. */
static void add_scene(stage *set, hl_shading shading) {
  enum { N = 14 };
  static const hl_opacity_point opacity[] = {{0, 0}, {0.3, 0}, {0.6, 0.8}};
  static float voxels[N * N * N];
  for (int i = 0; i < N * N * N; i++) {
    double x = i % N - 6.5, y = i / N % N - 6.5, z = i / N / N - 6.5;
    voxels[i] = (float)fmin(fmax(0.5 + (5 - sqrt(x * x + y * y + z * z)) / 3, 0), 1);
  }
  hl_scene_volume *ball = stage_add_grid(set, (size_t[3]){N, N, N}, (double[3]){1, 1, 1}, (vec3){-7, -7, -7},
                                         voxels);
  ball->transfer_function.opacity = opacity;
  ball->transfer_function.opacity_count = 3;
  stage_set_color(set, ball, 0.9, 0.5, 0.3);
  ball->shading = shading;
  ball->material.emission = 0.2;
  hl_scene_volume *plate = stage_add_box(set, (vec3){-9, -9, -9}, (vec3){9, 9, -8});
  stage_set_opacity(set, plate, 0.7, 1);
  plate->attenuation_color[0] = plate->attenuation_color[2] = 0;
  stage_look(set, (vec3){30, -60, 40}, (vec3){0, 0, -2}, (vec3){0, 0, 1});
}

/* The sum of the layers has the sky's light once, less what is hidden of it. The sum is tested under an even
 * sky and a gradient, for media and surfaces, on the sheets and the reference, and with another light that
 * has a sweep of its own. */
static void test_sum_is_the_picture(void **state) {
  (void)state;
  static sky_layers made;
  for (int i = 0; i < 5; i++) {
    stage set;
    open_sky(&set);
    add_scene(&set, i % 2 == 0 ? HL_SHADING_PHONG : HL_SHADING_NONE);
    set.scene.sky.type = i < 2 ? HL_SKY_UNIFORM : HL_SKY_GRADIENT;
    set.scene.ambient[1] = 0.1;
    stage_add_directional(&set, (vec3){i == 2 ? 1 : -1, 0.5, -1});
    if (i == 3) set.scene.camera.height = 90; /* a pixel is the mean of several */
    render_layers(&set, i == 4 ? 40 : 0, &made);
    double brightest = 0, darkest = 1;
    for (int p = 0; p < PIXELS; p++)
      for (int c = 0; c < 3; c++) {
        double sum = (double)made.ambient[3 * p + c] + (double)made.emission[3 * p + c] +
                     (double)made.sky[3 * p + c] + (double)made.light[3 * p + c];
        assert_near(sum, made.pixels[4 * p + c], 2e-6);
        brightest = fmax(brightest, made.sky[3 * p + c]);
        if (made.pixels[4 * p + 3] > 0.5f) darkest = fmin(darkest, made.shadow[3 * p + c]);
      }
    assert_true(brightest > 0.2 && darkest < 0.8);
    stage_close(&set);
  }
}

/* The light of white matter is its light under an unhidden sky, times the layer of the sky's shadow. */
static void test_shadow_is_a_factor(void **state) {
  (void)state;
  static sky_layers hidden, open;
  stage set;
  open_sky(&set);
  set.scene.sky.type = HL_SKY_GRADIENT;
  add_scene(&set, HL_SHADING_PHONG);
  for (size_t v = 0; v < 2; v++) stage_set_color(&set, &set.volumes[v], 1, 1, 1);
  for (int i = 0; i < 2; i++) {
    for (size_t v = 0; v < 2; v++) set.volumes[v].receives_shadow = 1;
    render_layers(&set, i == 1 ? 40 : 0, &hidden);
    for (size_t v = 0; v < 2; v++) set.volumes[v].receives_shadow = 0;
    render_layers(&set, i == 1 ? 40 : 0, &open);
    for (int k = 0; k < PIXELS * 3; k++)
      if (hidden.shadow[k] < 1) assert_near(hidden.sky[k], open.sky[k] * hidden.shadow[k], 2e-6);
  }
  stage_close(&set);
}

/* In a scene without a sky the sky's layers are zeros, as in pixels that show nothing. */
static void test_no_sky(void **state) {
  (void)state;
  static sky_layers made;
  stage set;
  open_sky(&set);
  set.scene.sky.type = HL_SKY_NONE;
  add_scene(&set, HL_SHADING_PHONG);
  for (int i = 0; i < 2; i++) {
    render_layers(&set, i == 1 ? 40 : 0, &made);
    for (int k = 0; k < PIXELS * 3; k++) assert_true(made.sky[k] == 0 && made.shadow[k] == 0);
  }
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_shadow_in_slab),
      cmocka_unit_test(test_sum_is_the_picture),
      cmocka_unit_test(test_shadow_is_a_factor),
      cmocka_unit_test(test_no_sky),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
