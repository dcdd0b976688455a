/* analytic/numbers_camera.c - pictures from eyes in unusual places, at extreme angles and in extreme sizes.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "reference_stage.h"

static const vec3 LOW = {-3, -2, -4}, HIGH = {5, 2, 3};
static const double OPACITY = 0.2;

/* Opens a scene of a homogeneous box. Alpha along every ray is 1 - (1 - OPACITY)^chord. */
static void open_box(stage *set, int width, int height) {
  stage_open(set);
  set->scene.render.threads = 1;
  hl_scene_volume *box = stage_add_grid(set, (size_t[3]){8, 4, 7}, (double[3]){1, 1, 1}, LOW, NULL);
  stage_set_opacity(set, box, OPACITY, 1);
  set->scene.width = width;
  set->scene.height = height;
}

/* Compares every pixel's alpha with the closed form. tolerance: the allowed difference of alpha. */
static void assert_chords(stage *set, double tolerance, const char *what) {
  int width = set->scene.width, height = set->scene.height, seen = 0;
  float *pixels = malloc((size_t)width * (size_t)height * 4 * sizeof *pixels);
  assert_non_null(pixels);
  stage_render_sheets(set, pixels);
  for (int y = 0; y < height; y++)
    for (int x = 0; x < width; x++) {
      vec3 origin, direction;
      stage_eye_ray(set, x, y, &origin, &direction);
      double expected = 1 - pow(1 - OPACITY, stage_chord(LOW, HIGH, origin, direction));
      double alpha = (double)pixels[4 * ((size_t)y * (size_t)width + (size_t)x) + 3];
      if (!(fabs(alpha - expected) <= tolerance))
        fail_msg("%s: pixel %d,%d has alpha %.9g, should have %.9g", what, x, y, alpha, expected);
      seen += expected > 0;
    }
  free(pixels);
  if (seen == 0) fail_msg("%s: shows nothing", what);
}

static void open_perspective(stage *set, vec3 eye, vec3 target, double fovy_deg) {
  open_box(set, 18, 14);
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = fovy_deg;
  stage_look(set, eye, target, (vec3){0.1, 0.2, 1});
}

/* The eye is inside the box, on a voxel's centre, on a face, on an edge, and on a corner. */
static void test_eyes_in_the_volume(void **state) {
  (void)state;
  static const vec3 eyes[] = {{0.2, -0.3, 0.4}, {0.5, 0.5, 0.5}, {1, 0, -0.5}, {-3, 0, 0},
                              {5, 0.3, 1},      {-3, -2, 0},     {5, 2, 3}};
  for (size_t e = 0; e < sizeof eyes / sizeof *eyes; e++)
    for (int target = 0; target < 3; target++)
      for (int lit = 0; lit <= (target == 0 && e % 3 == 0);
           lit++) { /* shadow buffers are large if the eye is within the volume */
        stage set;
        char what[80];
        const vec3 targets[] = {{0.9, 0.4, -0.5}, {-7, 1, 2}, {20, -9, 3}};
        open_perspective(&set, eyes[e], targets[target], 60);
        if (lit) stage_add_directional(&set, (vec3){-1, 0.4, -2});
        snprintf(what, sizeof what, "eye %zu, target %d, %s", e, target, lit ? "lit" : "unlit");
        bool outwards = (e == 3 || e == 5) ? target == 1 : e == 4 ? target == 2 : e == 6 && target == 2;
        if (!outwards) assert_chords(&set, 2e-4, what);
        stage_close(&set);
      }
}

static void test_fields_of_view(void **state) {
  (void)state;
  static const double angles[] = {1e-6, 1e-3, 1, 40, 100};
  for (size_t a = 0; a < sizeof angles / sizeof *angles; a++) {
    stage set;
    char what[60];
    open_perspective(&set, (vec3){1.2, -7, 1}, (vec3){1.3, 0, 0.4}, angles[a]);
    snprintf(what, sizeof what, "%g degrees", angles[a]);
    assert_chords(&set, 2e-4, what);
    stage_close(&set);
  }
}

static hl_status render_status(stage *set, hl_error *error) {
  static float pixels[18 * 14 * 4];
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_scene_create(set->context, &set->scene, &scene, error), HL_OK);
  assert_int_equal(hl_renderer_create(set->context, &renderer, error), HL_OK);
  hl_status status = hl_renderer_render(renderer, scene, pixels, 4 * 18, NULL, error);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  return status;
}

/* A wide view is drawn right if there are sheets that all of the view's rays cross, and is refused
 * otherwise. */
static void test_wide_views(void **state) {
  (void)state;
  static const double angles[] = {120, 150, 170, 179.999};
  static const vec3 lights[] = {{0, 0, 0}, {-1, 0.4, -2}, {0, -1, 0.1}};
  int refused = 0;
  for (size_t a = 0; a < sizeof angles / sizeof *angles; a++)
    for (size_t l = 0; l < sizeof lights / sizeof *lights; l++) {
      stage set;
      char what[60];
      hl_error error = {0};
      open_perspective(&set, (vec3){1.2, 0.3, 0.2}, (vec3){1.3, 4, 0.4}, angles[a]);
      if (l > 0) stage_add_directional(&set, lights[l]);
      snprintf(what, sizeof what, "%g degrees, light %zu", angles[a], l);
      hl_status status = render_status(&set, &error);
      if (status == HL_OK) assert_chords(&set, 2e-4, what);
      else
        assert_non_null(
            strstr(error.message, "/camera/fovy_deg: no sheets are crossed by every ray of so wide a view"));
      if (angles[a] <= 120 && status != HL_OK) fail_msg("%s: %s", what, error.message);
      refused += status == HL_ERROR_UNSUPPORTED;
      stage_close(&set);
    }
  /* The refused views have a field of view of 179.999 degrees, or are wide with light from the side. */
  assert_in_range(refused, 3, 8);
}

static void test_eyes_far_and_near(void **state) {
  (void)state;
  for (double distance = 1e-6; distance < 1e7; distance *= 100) {
    stage set;
    char what[60];
    open_perspective(&set, (vec3){1 + distance, 0, 0}, (vec3){1, 0, 0}, distance > 10 ? 600 / distance : 60);
    snprintf(what, sizeof what, "from %g", distance);
    assert_chords(&set, 2e-4, what);
    stage_close(&set);
  }
}

/* The eye looks away from the volume, so that the volume lies behind it. */
static void test_nothing_ahead(void **state) {
  (void)state;
  static float pixels[18 * 14 * 4];
  static const vec3 eyes[] = {{20, 0, 0}, {5.001, 0, 0}, {0, 1e9, 0}};
  for (size_t e = 0; e < sizeof eyes / sizeof *eyes; e++) {
    stage set;
    open_perspective(&set, eyes[e], vec3_add(eyes[e], eyes[e]), 60);
    stage_add_directional(&set, (vec3){-1, 0.4, -2})->angular_diameter_deg = 5;
    stage_render_sheets(&set, pixels);
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++) assert_true(pixels[i] == 0);
    stage_close(&set);
  }
}

/* If the camera's up is parallel to the line of sight, z replaces it, or y if the line of sight is along z.
 * The reference replaces the useless direction in the same way. */
static void test_useless_up(void **state) {
  (void)state;
  static float plain[18 * 14 * 4], useless[18 * 14 * 4], exact[18 * 14 * 4];
  static const vec3 backs[] = {{3, 9, 2}, {0, 0, 12}, {1, 0.5, 12}, {4, 1, 11}};
  for (size_t b = 0; b < sizeof backs / sizeof *backs; b++) {
    stage set;
    vec3 forward = vec3_normalise(vec3_scale(backs[b], -1));
    open_perspective(&set, backs[b], (vec3){0, 0, 0}, 60);
    set.scene.render.threads = 1;
    stage_look(&set, backs[b], (vec3){0, 0, 0}, fabs(forward.z) < 0.999 ? (vec3){0, 0, 1} : (vec3){0, 1, 0});
    stage_render_sheets(&set, plain);
    for (int sign = -1; sign <= 1; sign += 2) {
      stage_look(&set, backs[b], (vec3){0, 0, 0}, vec3_scale(backs[b], sign * 7));
      stage_render_sheets(&set, useless);
      assert_memory_equal(plain, useless, sizeof plain);
      stage_render(&set, NULL, exact);
      for (size_t i = 0; i < sizeof exact / sizeof *exact; i++)
        assert_true(fabsf(exact[i] - useless[i]) < 1e-3f);
    }
    stage_close(&set);
  }
}

static void test_sizes(void **state) {
  (void)state;
  static const int sizes[][2] = {{1, 300}, {16384, 4}, {32768, 1}};
  for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
    stage set;
    char what[60];
    open_box(&set, sizes[s][0], sizes[s][1]);
    set.scene.camera.height = sizes[s][0] < sizes[s][1] ? 12 : 12.0 * sizes[s][1] / sizes[s][0];
    stage_look(&set, (vec3){9, -8, 7}, (vec3){1, 0, 0}, (vec3){0, 0, 1});
    snprintf(what, sizeof what, "%d x %d", sizes[s][0], sizes[s][1]);
    assert_chords(&set, 2e-4, what);
    stage_close(&set);
  }
}

/* The floats of a picture of 16384 x 16384 pixels take 4.3 GB. Under a limit of 1 GB the picture is refused
 * before anything is rendered. */
static void test_large_picture_under_a_limit(void **state) {
  (void)state;
  stage set;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  hl_context_options options;
  float pixel[4];
  hl_context_options_defaults(&options);
  options.memory_limit = (uint64_t)1 << 30;
  stage_open_with(&set, &options);
  stage_add_box(&set, LOW, HIGH);
  /* The picture's size is no multiple of a tile's size, so that the picture is not made in the caller's
   * pixels. */
  set.scene.width = set.scene.height = 16380;
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, &error), HL_OK);
  assert_int_equal(hl_renderer_create(set.context, &renderer, &error), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, scene, pixel, 4 * 16380, NULL, &error), HL_ERROR_MEMORY);
  assert_non_null(strstr(error.message, "the picture"));
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  stage_close(&set);
}

static void test_refused(void **state) {
  (void)state;
  stage set;
  open_perspective(&set, (vec3){9, -8, 7}, (vec3){9, -8, 7}, 60);
  stage_refused(&set,
                "/camera/target: is where the eye is: move the target or the position, so that there is a "
                "line of sight");
  stage_look(&set, (vec3){9, -8, 7}, (vec3){0, 0, 0}, (vec3){0, 0, 0});
  stage_refused(&set, "/camera/up: has no length: give the direction as three numbers, not all 0");
  stage_look(&set, (vec3){9, -8, NAN}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  stage_refused(&set, "/camera/position/2: nan is not a number: give a coordinate between -1e15 and 1e15");
  stage_look(&set, (vec3){9, -8, 7}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  set.scene.camera.fovy_deg = 0;
  stage_refused(&set, "/camera/fovy_deg: 0 is out of range: give an angle in degrees, above 0 and below 180");
  set.scene.camera.fovy_deg = 180;
  stage_refused(&set,
                "/camera/fovy_deg: 180 is out of range: give an angle in degrees, above 0 and below 180");
  set.scene.camera.fovy_deg = -30;
  stage_refused(&set,
                "/camera/fovy_deg: -30 is out of range: give an angle in degrees, above 0 and below 180");
  set.scene.camera.type = HL_CAMERA_ORTHOGRAPHIC;
  set.scene.camera.height = 0;
  stage_refused(&set, "/camera/height: 0 is not above 0: give the picture's height in world units, above 0");
  set.scene.camera.height = 10;
  set.scene.width = 0;
  stage_refused(&set, "/image/width: 0 is out of range: give a number of pixels from 1 to 32768");
  set.scene.width = 32;
  set.scene.height = -3;
  stage_refused(&set, "/image/height: -3 is out of range: give a number of pixels from 1 to 32768");
  set.scene.height = 32769;
  stage_refused(&set, "/image/height: 32769 is out of range: give a number of pixels from 1 to 32768");
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_eyes_in_the_volume),
      cmocka_unit_test(test_fields_of_view),
      cmocka_unit_test(test_wide_views),
      cmocka_unit_test(test_eyes_far_and_near),
      cmocka_unit_test(test_nothing_ahead),
      cmocka_unit_test(test_useless_up),
      cmocka_unit_test(test_sizes),
      cmocka_unit_test(test_large_picture_under_a_limit),
      cmocka_unit_test(test_refused),
  };
  return cmocka_run_group_tests_name("numbers_camera", tests, NULL, NULL);
}
