/* analytic/sheets_faces.c - faces of a box that light grazes: the picture against the closed form. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { VOXELS = 32, SIDE = 72 };

static const double OPACITY = 0.95, HALF = VOXELS / 2.0, INSIDE = 7;

/* Of even matter under a face, the eye sees what is left after s / g of the light's way for each s / c of its
 * own: with extinction x, int x exp(-x s) exp(-x s c / g) ds = 1 / (1 + c / g), c and g the eye's and the
 * light's cosines to the face's normal (derived). */
static double brightness(vec3 eye, vec3 light) { return 1 / (1 + fabs(eye.z) / fabs(light.z)); }

/* The light's elevation above the face is in degrees; its diameter, 0 for hard shadows, too. */
typedef struct face_case {
  double elevation, diameter, spacing, most_mean, most;
} face_case;

static const face_case CASES[] = {
    {8, 0, 0.5, 0.002, 0.1}, {8, 0, 1, 0.002, 0.1}, {20, 0, 0.5, 0.002, 0.1}, {8, 3, 0.5, 0.002, 0.1}};

static void assert_even(const face_case *c, vec3 eye) {
  static float pixels[SIDE * SIDE * 4];
  stage set;
  stage_open(&set);
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 40;
  set.scene.render.sheet_spacing = c->spacing;
  stage_look(&set, eye, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  hl_scene_volume *box = stage_add_grid(&set, (size_t[3]){VOXELS, VOXELS, VOXELS}, (double[3]){1, 1, 1},
                                        (vec3){-HALF, -HALF, -HALF}, NULL);
  stage_set_opacity(&set, box, OPACITY, 1);
  double angle = c->elevation * 3.14159265358979 / 180;
  vec3 light = {cos(angle) * 0.96, cos(angle) * -0.28, -sin(angle)};
  stage_add_directional(&set, light)->angular_diameter_deg = c->diameter;
  set.scene.render.shadows = c->diameter > 0 ? HL_SHADOWS_SOFT : HL_SHADOWS_HARD;
  stage_render_sheets(&set, pixels);
  double sum = 0, greatest = 0;
  int count = 0;
  for (int p = 0; p < SIDE * SIDE; p++) {
    vec3 origin, way;
    stage_eye_ray(&set, p % SIDE, p / SIDE, &origin, &way);
    vec3 at = vec3_add(origin, vec3_scale(way, (HALF - origin.z) / way.z));
    if (fabs(at.x) > INSIDE || fabs(at.y) > INSIDE) continue;
    double error = fabs((double)pixels[4 * p] - brightness(way, light));
    sum += error;
    greatest = fmax(greatest, error);
    count++;
  }
  print_message("# light at %g degrees, diameter %g, spacing %g: mean error %.4f, greatest %.4f\n",
                c->elevation, c->diameter, c->spacing, sum / count, greatest);
  stage_close(&set);
  assert_true(count > 100);
  assert_true(sum / count < c->most_mean);
  assert_true(greatest < c->most);
}

static const vec3 EYES[] = {{20, 30, 60}, {-45, 25, 35}};

static void test_even_under_grazing_light(void **state) {
  (void)state;
  for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
    for (size_t e = 0; e < sizeof EYES / sizeof *EYES; e++) assert_even(&CASES[i], EYES[e]);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_even_under_grazing_light)};
  return cmocka_run_group_tests_name("sheets_faces", tests, NULL, NULL);
}
