/* analytic/sheets_faces.c - faces of a box that light grazes: each slab's light against the closed form. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { VOXELS = 32, SIDE = 72 };

static const double OPACITY = 0.9, HALF = VOXELS / 2.0, INSIDE = 7;

/* Of even matter under a face, the eye sees what is left after s / sin of light's angle for each s / cos of its own: with extinction x,
 * int x exp(-x s) exp(-x s c / g) ds = 1 / (1 + c / g), c and g the eye's and the light's cosines to the face's normal (derived). */
static double brightness(vec3 eye, vec3 light) { return 1 / (1 + fabs(eye.z) / fabs(light.z)); }

typedef struct errors { double sum, greatest; int count; } errors;

static errors errors_of_face(const stage *set, const float *pixels, vec3 light) {
  errors found = {0, 0, 0};
  for (int p = 0; p < SIDE * SIDE; p++) {
    vec3 origin, way;
    stage_eye_ray(set, p % SIDE, p / SIDE, &origin, &way);
    vec3 at = vec3_add(origin, vec3_scale(way, (HALF - origin.z) / way.z));
    if (fabs(at.x) > INSIDE || fabs(at.y) > INSIDE) continue;
    double error = fabs((double)pixels[4 * p] - brightness(way, light));
    found.sum += error;
    found.greatest = fmax(found.greatest, error);
    found.count++;
  }
  return found;
}

static void assert_even(vec3 eye, vec3 towards, double spacing) {
  static float pixels[SIDE * SIDE * 4];
  stage set;
  stage_open(&set);
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 40;
  set.scene.render.sheet_spacing = spacing;
  stage_look(&set, eye, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  hl_scene_volume *box = stage_add_grid(&set, (size_t[3]){VOXELS, VOXELS, VOXELS}, (double[3]){1, 1, 1}, (vec3){-HALF, -HALF, -HALF}, NULL);
  stage_set_opacity(&set, box, OPACITY, 1);
  vec3 light = vec3_normalise(vec3_scale(towards, -1));
  (void)stage_add_directional(&set, light);
  stage_render_sheets(&set, pixels);
  errors found = errors_of_face(&set, pixels, light);
  print_message("# light %.3f of 1 over the face, spacing %g: mean error %.4f, greatest %.4f\n", -light.z, spacing,
                found.sum / found.count, found.greatest);
  stage_close(&set);
  assert_true(found.count > 100);
  assert_true(found.sum / found.count < 0.005);
  assert_true(found.greatest < 0.02);
}

static const vec3 EYES[] = {{20, 30, 60}, {-45, 25, 35}};
static const vec3 LIGHTS[] = {{-1, 0.1, 0.09}, {-1, 0.4, 0.2}, {-1, 0.5, 0.4}, {1, 0.3, 0.25}, {-0.3, 1, 0.4}};

static void test_hard(void **state) {
  (void)state;
  for (size_t e = 0; e < sizeof EYES / sizeof *EYES; e++)
    for (size_t l = 0; l < sizeof LIGHTS / sizeof *LIGHTS; l++)
      for (int i = 0; i < 2; i++) assert_even(EYES[e], LIGHTS[l], i == 0 ? 0.5 : 0.25);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_hard)};
  return cmocka_run_group_tests_name("sheets_faces", tests, NULL, NULL);
}
