/* analytic/reference_picture.c - the reference's pictures of curved matter: shading, independence of threads,
 * refusals. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { EDGE = 20, SIDE = 24, PIXEL_FLOATS = SIDE * SIDE * 4 };

static double worst_difference(const float *a, const float *b) {
  double worst = 0;
  for (int i = 0; i < PIXEL_FLOATS; i++) worst = fmax(worst, fabs((double)a[i] - b[i]));
  return worst;
}

static const hl_opacity_point RISING[2] = {{0.35, 0}, {0.8, 0.9}};
static const hl_color_point COLORS[2] = {{0.3, {0.9, 0.3, 0.1}}, {0.8, {0.2, 0.7, 1}}};

/* Adds a lump of noise around the origin with "phong" shading. */
static void stage_lump(stage *set) {
  static float voxels[EDGE * EDGE * EDGE];
  float *out = voxels;
  for (int k = 0; k < EDGE; k++)
    for (int j = 0; j < EDGE; j++)
      for (int i = 0; i < EDGE; i++) *out++ = stage_noise(0.3 * i, 0.3 * j, 0.3 * k);
  double half = EDGE / 2.0;
  stage_open(set);
  hl_scene_volume *lump = stage_add_grid(set, (size_t[3]){EDGE, EDGE, EDGE}, (double[3]){1, 1, 1},
                                         (vec3){-half, -half, -half}, voxels);
  lump->transfer_function.opacity = RISING;
  lump->transfer_function.opacity_count = 2;
  lump->transfer_function.color = COLORS;
  lump->transfer_function.color_count = 2;
  lump->shading = HL_SHADING_PHONG;
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 24;
}

/* An opaque ramp, seen from its transparent side, has one colour and one known normal, so that equations (3)
 * and (4) give its light.
 */
static void test_phong_of_a_ramp(void **state) {
  (void)state;
  float voxels[8 * 8 * 8], pixels[16 * 16 * 4], *out = voxels;
  /* the values fall along z, so that the normal is +z */
  for (int n = 0; n < 8 * 8 * 8; n++) *out++ = (float)(8 - n / 64);
  stage set;
  stage_open(&set);
  hl_scene_volume *ramp = stage_add_grid(&set, (size_t[3]){8, 8, 8}, (double[3]){1, 1, 1}, (vec3){-4, -4, -4},
                                         voxels);
  stage_set_opacity(&set, ramp, 0.9999, 0.01);
  stage_set_color(&set, ramp, 0.8, 0.4, 0.2);
  ramp->shading = HL_SHADING_PHONG;
  /* the clip box leaves out the ramp's first cell, where the repeated border bends the ramp */
  ramp->clipped = 1;
  for (int a = 0; a < 3; a++) {
    ramp->clip_min[a] = -100;
    ramp->clip_max[a] = a == 2 ? 2 : 100;
    set.scene.ambient[a] = 0.1 * (a + 1);
  }
  ramp->material = (hl_material){.ambient = 0.9, .diffuse = 0.6, .specular = 0.5, .shininess = 7};
  set.scene.render.shadows = HL_SHADOWS_OFF;
  hl_light *light = stage_add_directional(&set, (vec3){-0.3, -0.2, -1});
  light->intensity = 1.5;
  stage_add_directional(&set, (vec3){0, 0.5, 1}); /* this light comes from behind and adds nothing */
  stage_render(&set, NULL, pixels);
  vec3 towards = vec3_normalise((vec3){0.3, 0.2, 1});
  /* N = E = +z, so that E.R = 2 (N.L) N.E - E.L = N.L */
  double cosine = towards.z, gloss = 0.5 * 1.5 * pow(cosine, 7);
  const double own[3] = {0.8, 0.4, 0.2};
  for (int c = 0; c < 3; c++) {
    double expected = own[c] * (0.9 * 0.1 * (c + 1) + 0.6 * 1.5 * cosine) + gloss;
    assert_near(pixels[4 * (8 * 16 + 8) + c], expected, 1e-4);
  }
  stage_close(&set);
}

/* A trench of negative values is lit from outside, as a ridge of positive values is. */
static void test_negative_lobes(void **state) {
  (void)state;
  static float voxels[2][EDGE * EDGE * EDGE];
  static float pixels[2][PIXEL_FLOATS];
  const hl_opacity_point opacity[2][2] = {{{0.2, 0}, {0.6, 0.9}}, {{-0.6, 0.9}, {-0.2, 0}}};
  for (int n = 0; n < EDGE * EDGE * EDGE; n++) {
    double x = n % EDGE - 9.5, y = n / EDGE % EDGE - 9.5, z = n / (EDGE * EDGE) - 9.5;
    voxels[0][n] = (float)fmax(1 - sqrt(x * x + y * y + z * z) / 8, 0);
    voxels[1][n] = -voxels[0][n];
  }
  for (int sign = 0; sign < 2; sign++) {
    stage set;
    stage_lump(&set);
    hl_volume_release(set.volumes[0].volume);
    set.scene.volume_count = 0;
    hl_scene_volume *ball = stage_add_grid(&set, (size_t[3]){EDGE, EDGE, EDGE}, (double[3]){1, 1, 1},
                                           (vec3){-10, -10, -10}, voxels[sign]);
    ball->shading = HL_SHADING_PHONG;
    ball->transfer_function.opacity = opacity[sign];
    ball->transfer_function.opacity_count = 2;
    stage_add_directional(&set, (vec3){-1, -1, -1});
    stage_render(&set, NULL, pixels[sign]);
    stage_close(&set);
  }
  assert_true(pixels[0][4 * (8 * SIDE + 15)] > 0.3);
  assert_near(worst_difference(pixels[0], pixels[1]), 0, 1e-6);
}

static void test_lights_add(void **state) {
  (void)state;
  static float both[PIXEL_FLOATS], one[PIXEL_FLOATS], other[PIXEL_FLOATS];
  stage set;
  stage_lump(&set);
  stage_add_directional(&set, (vec3){-1, -0.4, -0.3});
  stage_add_point(&set, (vec3){-20, 15, 18})->color[1] = 0.3;
  stage_render(&set, NULL, both);
  set.lights[1].intensity = 0;
  stage_render(&set, NULL, one);
  set.lights[1].intensity = 1;
  set.lights[0].intensity = 0;
  stage_render(&set, NULL, other);
  double brightest = 0;
  for (int i = 0; i < PIXEL_FLOATS; i++) {
    if (i % 4 == 3) continue;
    assert_near(both[i], one[i] + other[i], 1e-6);
    brightest = fmax(brightest, fmin(one[i], other[i]));
  }
  assert_true(brightest > 0.1);
  stage_close(&set);
}

static void turn(mat3 rotation, double v[3]) {
  vec3 turned = mat3_apply(rotation, vec3_of(v));
  v[0] = turned.x;
  v[1] = turned.y;
  v[2] = turned.z;
}

static void test_turning_everything(void **state) {
  (void)state;
  static float before[PIXEL_FLOATS], after[PIXEL_FLOATS];
  const vec3 axis = {2 / 3.0, -1 / 3.0, 2 / 3.0};
  stage set;
  stage_lump(&set);
  set.scene.camera.type = HL_CAMERA_PERSPECTIVE;
  stage_look(&set, (vec3){21, 30, 17}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  stage_add_directional(&set, (vec3){-1, -0.4, -0.3});
  stage_add_point(&set, (vec3){-2, 1, 14});
  stage_render(&set, NULL, before);
  mat3 rotation = mat3_rotation(axis, 77 * HL_PI / 180);
  memcpy(set.volumes[0].rotate_axis, &axis, sizeof axis);
  set.volumes[0].rotate_angle_deg = 77;
  turn(rotation, set.scene.camera.position);
  turn(rotation, set.scene.camera.up);
  turn(rotation, set.lights[0].direction);
  turn(rotation, set.lights[1].position);
  stage_render(&set, NULL, after);
  assert_true(before[4 * (12 * SIDE + 12) + 3] > 0.5);
  assert_near(worst_difference(before, after), 0, 1e-6);
  stage_close(&set);
}

/* A picture with half of the ray march's step is nearer to the limit of small steps. The picture with the
 * default step is within a thousandth of the limit. */
static void test_convergence(void **state) {
  (void)state;
  static float pixels[3][PIXEL_FLOATS];
  const double steps[3] = {0.5, 0.25, 0.125};
  stage set;
  stage_lump(&set);
  stage_add_directional(&set, (vec3){-1, -0.4, -0.3});
  for (int i = 0; i < 3; i++) {
    hl_reference_options options;
    hl_reference_options_defaults(&options);
    options.step = steps[i];
    stage_render(&set, &options, pixels[i]);
  }
  double coarse = worst_difference(pixels[0], pixels[2]), fine = worst_difference(pixels[1], pixels[2]);
  assert_true(fine < 0.002 && fine < 0.6 * coarse);
  stage_close(&set);
}

static void test_empty_transfer_function(void **state) {
  (void)state;
  static float pixels[PIXEL_FLOATS], zero[PIXEL_FLOATS];
  stage set;
  stage_lump(&set);
  stage_add_directional(&set, (vec3){0, 0, -1});
  stage_set_opacity(&set, &set.volumes[0], 0, 1);
  memset(pixels, 1, sizeof pixels);
  stage_render(&set, NULL, pixels);
  assert_memory_equal(pixels, zero, sizeof zero);
  set.volumes[0].transfer_function.opacity_count = 0;
  memset(pixels, 1, sizeof pixels);
  stage_render(&set, NULL, pixels);
  assert_memory_equal(pixels, zero, sizeof zero);
  stage_close(&set);
}

static void test_threads_give_the_same_bytes(void **state) {
  (void)state;
  static float one[PIXEL_FLOATS], many[PIXEL_FLOATS];
  stage set;
  stage_lump(&set);
  set.scene.render.shadows = HL_SHADOWS_SOFT;
  stage_add_point(&set, (vec3){0, 9, 22})->radius = 3;
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 5;
  options.threads = 1;
  stage_render(&set, &options, one);
  for (int threads = 2; threads <= 7; threads += 5) {
    options.threads = threads;
    stage_render(&set, &options, many);
    assert_memory_equal(one, many, sizeof one);
  }
  stage_close(&set);
}

static int say_stop(void *calls) { return ++*(int *)calls > 3; }

static void test_cancel(void **state) {
  (void)state;
  static float pixels[PIXEL_FLOATS];
  stage set;
  stage_lump(&set);
  int calls = 0;
  hl_context_options context_options;
  hl_context_options_defaults(&context_options);
  context_options.user_data = &calls;
  context_options.cancelled = say_stop;
  hl_context *impatient = NULL;
  hl_scene *scene = NULL;
  hl_error error;
  assert_int_equal(hl_context_create(&context_options, &impatient, &error), HL_OK);
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, &error), HL_OK);
  assert_int_equal(hl_reference_render(impatient, scene, NULL, pixels, 4 * SIDE, &error), HL_ERROR_CANCELLED);
  assert_true(calls == 4 && hl_context_memory_held(impatient) == 0);
  hl_scene_release(scene);
  hl_context_destroy(impatient);
  stage_close(&set);
}

static void test_impossible_options(void **state) {
  (void)state;
  static float pixels[PIXEL_FLOATS];
  stage set;
  stage_lump(&set);
  hl_scene *scene = NULL;
  hl_error error;
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, &error), HL_OK);
  for (int i = 0; i < 5; i++) {
    hl_reference_options options;
    hl_reference_options_defaults(&options);
    if (i == 0) options.struct_size = 0;
    if (i == 1) options.step = NAN;
    if (i == 2) options.light_points = 0;
    if (i == 3) options.threads = -1;
    size_t row_stride = 4 * SIDE - (i == 4);
    assert_int_equal(hl_reference_render(set.context, scene, &options, pixels, row_stride, &error),
                     HL_ERROR_ARGUMENT);
    assert_true(error.message[0] != 0);
  }
  hl_scene_release(scene);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_phong_of_a_ramp),
      cmocka_unit_test(test_negative_lobes),
      cmocka_unit_test(test_lights_add),
      cmocka_unit_test(test_turning_everything),
      cmocka_unit_test(test_convergence),
      cmocka_unit_test(test_empty_transfer_function),
      cmocka_unit_test(test_threads_give_the_same_bytes),
      cmocka_unit_test(test_cancel),
      cmocka_unit_test(test_impossible_options),
  };
  return cmocka_run_group_tests_name("reference_picture", tests, NULL, NULL);
}
