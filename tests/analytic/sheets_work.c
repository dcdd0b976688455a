/* analytic/sheets_work.c - hardly any work is done for empty, hidden or unseen matter. Work is counted as
 * pixels that are reconstructed, which does not depend on the machine. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { SIDE = 64, FLOATS = SIDE * SIDE * 4, BALL = 24 };

static const hl_opacity_point EDGE[] = {{0, 0}, {0.45, 0}, {0.55, 0.9}, {1, 0.9}};

/* Adds a ball in the middle of a cube of air, whose middle is at `middle`. */
static hl_scene_volume *add_ball(stage *set, size_t n, vec3 middle) {
  float *voxels = malloc(n * n * n * sizeof *voxels);
  assert_non_null(voxels);
  double centre = (double)(n - 1) / 2, half = (double)n / 2;
  for (size_t i = 0; i < n * n * n; i++) {
    double x = (double)(i % n) - centre, y = (double)(i / n % n) - centre, z = (double)(i / n / n) - centre;
    double value = 0.5 + (BALL / 2 - 3 - sqrt(x * x + y * y + z * z)) / 4;
    voxels[i] = (float)fmin(fmax(value, 0), 1);
  }
  set->type = HL_VOXEL_U8;
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){n, n, n}, (double[3]){1, 1, 1},
                                           vec3_subtract(middle, (vec3){half, half, half}), voxels);
  free(voxels);
  volume->transfer_function.opacity = EDGE;
  volume->transfer_function.opacity_count = sizeof EDGE / sizeof *EDGE;
  return volume;
}

static void open_scene(stage *set, hl_shadows shadows) {
  stage_open(set);
  set->scene.render.shadows = shadows;
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 32;
  stage_look(set, (vec3){60, -50, 40}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
  stage_add_directional(set, (vec3){-1, 0.3, -1})->angular_diameter_deg = 6;
}

static void assert_at_most(uint64_t more, uint64_t base, double factor, const char *what) {
  if ((double)more > factor * (double)base)
    fail_msg("%s: %llu pixels instead of %llu", what, (unsigned long long)more, (unsigned long long)base);
}

static const hl_shadows SHADOWS[] = {HL_SHADOWS_OFF, HL_SHADOWS_HARD, HL_SHADOWS_SOFT};

/* If air makes a volume eight times as large, the work stays the same. Pixels of soft shadow buffers lie
 * elsewhere in the larger volume, so that their work may differ by some per cent. */
static void test_empty_space(void **state) {
  (void)state;
  static float near[FLOATS], far[FLOATS];
  for (int s = 0; s < 3; s++) {
    hl_render_statistics of[2];
    for (int wide = 0; wide < 2; wide++) {
      stage set;
      open_scene(&set, SHADOWS[s]);
      add_ball(&set, wide ? 2 * BALL : BALL, (vec3){0, 0, 0});
      of[wide] = stage_render_counted(&set, wide ? far : near);
      stage_close(&set);
    }
    assert_true(of[0].pixels_filled_image > 10000 && (s == 0 || of[0].pixels_filled_light > 10000));
    assert_at_most(of[1].pixels_filled_image, of[0].pixels_filled_image, 1.05, "image, among air");
    assert_at_most(of[1].pixels_filled_light, of[0].pixels_filled_light, 1.05, "light, among air");
  }
}

/* The shadow of a second ball beside the picture does not reach the picture. The picture is the same, and no
 * more pixels are reconstructed than sheets in other places need. */
static void test_out_of_sight(void **state) {
  (void)state;
  static float alone[FLOATS], beside[FLOATS];
  /* the tolerance for hard shadows, whose buffer's pixels lie elsewhere */
  static const double limit[] = {0, 0.006};
  for (int s = 0; s < 2; s++) {
    hl_render_statistics of[2];
    for (int other = 0; other < 2; other++) {
      stage set;
      open_scene(&set, SHADOWS[s]);
      add_ball(&set, BALL, (vec3){0, 0, 0});
      if (other) add_ball(&set, BALL, (vec3){-50, -60, 0});
      of[other] = stage_render_counted(&set, other ? beside : alone);
      stage_close(&set);
    }
    assert_at_most(of[1].pixels_filled_image, of[0].pixels_filled_image, 1.02, "image, beside");
    assert_at_most(of[1].pixels_filled_light, of[0].pixels_filled_light, 1.02, "light, beside");
    double sum = 0;
    for (int i = 0; i < FLOATS; i++) sum += (double)(alone[i] - beside[i]) * (double)(alone[i] - beside[i]);
    if (!(sqrt(sum / FLOATS) <= limit[s])) fail_msg("pictures differ by %g", sqrt(sum / FLOATS));
  }
}

/* A ball stands close behind another ball. The eye's rays are opaque before they reach the hidden ball. */
static void test_hidden(void **state) {
  (void)state;
  static float pixels[FLOATS];
  hl_render_statistics of[2];
  for (int hidden = 0; hidden < 2; hidden++) {
    stage set;
    open_scene(&set, HL_SHADOWS_OFF);
    vec3 away = vec3_scale(vec3_normalise((vec3){-60, 50, -40}), BALL);
    hl_scene_volume *front = add_ball(&set, BALL, (vec3){0, 0, 0});
    stage_set_opacity(&set, front, 0.99, 1);
    if (hidden) add_ball(&set, BALL, away);
    of[hidden] = stage_render_counted(&set, pixels);
    stage_close(&set);
  }
  assert_at_most(of[1].pixels_filled_image, of[0].pixels_filled_image, 1.05, "image, behind");
}

/* A volume full of matter that neither shows nor casts a shadow changes no byte and needs no work. */
static void test_not_taking_part(void **state) {
  (void)state;
  static float alone[FLOATS], beside[FLOATS];
  for (int s = 0; s < 3; s++) {
    hl_render_statistics of[2];
    for (int other = 0; other < 2; other++) {
      stage set;
      open_scene(&set, SHADOWS[s]);
      add_ball(&set, BALL, (vec3){0, 0, 0});
      if (other) {
        hl_scene_volume *full = add_ball(&set, BALL, (vec3){0, 0, 0});
        stage_set_opacity(&set, full, 0.9, 1);
        full->visible = full->casts_shadow = 0;
      }
      of[other] = stage_render_counted(&set, other ? beside : alone);
      stage_close(&set);
    }
    assert_true(of[0].pixels_filled_image > 10000);
    assert_true(of[1].pixels_filled_image == of[0].pixels_filled_image);
    assert_true(of[1].pixels_filled_light == of[0].pixels_filled_light);
    assert_int_equal(of[1].sheets, of[0].sheets);
    assert_memory_equal(alone, beside, sizeof alone);
  }
}

enum { LARGE = 256 }; /* the picture is large enough that some of its tiles are searched for hidden matter */

/* Light comes from behind, so that sheets go from back to front for the eye, and a search finds hidden matter
 * beforehand. The hidden ball casts its shadow on the ball in front. */
static void test_hidden_from_light_behind(void **state) {
  (void)state;
  float *pixels = malloc((size_t)LARGE * LARGE * 4 * sizeof *pixels);
  assert_non_null(pixels);
  hl_render_statistics of[3]; /* without shadows; with shadows; with one more ball */
  for (int i = 0; i < 3; i++) {
    stage set;
    open_scene(&set, i == 0 ? HL_SHADOWS_OFF : HL_SHADOWS_HARD);
    set.scene.width = set.scene.height = LARGE;
    set.scene.camera.height = 20;
    vec3 away = vec3_scale(vec3_normalise((vec3){-60, 50, -40}), BALL);
    double *direction = set.lights[0].direction;
    direction[0] = 60, direction[1] = -35, direction[2] = 45;
    stage_set_opacity(&set, add_ball(&set, BALL, (vec3){0, 0, 0}), 0.99, 1);
    if (i == 2) stage_set_opacity(&set, add_ball(&set, BALL, away), 0.99, 1);
    of[i] = stage_render_counted(&set, pixels);
    stage_close(&set);
  }
  free(pixels);
  assert_at_most(of[1].samples_shaded, of[0].samples_shaded, 1.2, "shaded, back to front");
  assert_at_most(of[2].samples_shaded, of[1].samples_shaded, 1.05, "shaded, another behind");
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_empty_space),
      cmocka_unit_test(test_out_of_sight),
      cmocka_unit_test(test_hidden),
      cmocka_unit_test(test_not_taking_part),
      cmocka_unit_test(test_hidden_from_light_behind),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
