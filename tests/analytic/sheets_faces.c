/* analytic/sheets_faces.c - faces of a box that light grazes, and the normals of clipped faces, against
 * closed forms. Balls with a corner or a half cut away show light that leaves matter through a face. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { VOXELS = 32, SIDE = 72, RADIUS = 13 };

static const double OPACITY = 0.95, HALF = VOXELS / 2.0, INSIDE = 7;

/* Returns the light that the eye sees from even matter under a face. A point at the depth s lies s / c behind
 * the face along the eye's ray and s / g along the light's ray, where c and g are the cosines of the eye's
 * and the light's angles to the face's normal. With the extinction x and the distance t = s / c, the light is
 * the integral of x exp(-x t) exp(-x t c / g) dt = 1 / (1 + c / g) (derived). */
static double brightness(vec3 eye, vec3 light) { return 1 / (1 + fabs(eye.z) / fabs(light.z)); }

/* A light on a face. elevation: of the light above the face, in degrees. diameter: of the light, in degrees;
 * 0: hard shadows. */
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

/* ---- normals where clipping cuts a noisy ball ---- */

static float noisy_ball[VOXELS * VOXELS * VOXELS];

/* The value is 1 within the radius 11 and falls to 0 over 4 voxels, with noise of 2 % to either side. */
static void make_noisy_ball(void) {
  uint32_t random = 1;
  for (int n = 0; n < VOXELS * VOXELS * VOXELS; n++) {
    double x = n % VOXELS + 0.5 - HALF, y = n / VOXELS % VOXELS + 0.5 - HALF,
           z = n / (VOXELS * VOXELS) + 0.5 - HALF, radius = sqrt(x * x + y * y + z * z);
    random = random * 1664525 + 1013904223;
    double noise = 0.04 * ((random >> 8) / 16777216.0 - 0.5);
    noisy_ball[n] = (float)fmax(fmin((13 - radius) / 4, 1) * (1 + noise), 0);
  }
}

/* Adds the part of the ball that lies from low to high along z. */
static void add_part(stage *set, double low, double high) {
  static const hl_opacity_point opacity[] = {{0.3, 0}, {0.6, 0.98}};
  hl_scene_volume *part = stage_add_grid(set, (size_t[3]){VOXELS, VOXELS, VOXELS}, (double[3]){1, 1, 1},
                                         (vec3){-HALF, -HALF, -HALF}, noisy_ball);
  part->transfer_function.opacity = opacity;
  part->transfer_function.opacity_count = 2;
  part->shading = HL_SHADING_PHONG;
  part->material = (hl_material){.diffuse = 1, .shininess = 1};
  part->clipped = 1;
  for (int axis = 0; axis < 3; axis++) {
    part->clip_min[axis] = axis == 2 ? low : -HALF;
    part->clip_max[axis] = axis == 2 ? high : HALF;
  }
}

static void open_cut_ball(stage *set, vec3 light) {
  make_noisy_ball();
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 30;
  set->scene.render.sheet_spacing = 0.5;
  set->scene.render.shadows = HL_SHADOWS_OFF;
  stage_add_directional(set, light);
  stage_look(set, (vec3){20, -30, 60}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
}

/* The face of the cut is as bright as the cosine of the light's angle to it, whatever the noise is. */
static void test_normal_of_a_cut(void **state) {
  (void)state;
  static float pixels[SIDE * SIDE * 4];
  const vec3 light = {0.5, 0.3, -0.8};
  stage set;
  open_cut_ball(&set, light);
  add_part(&set, -HALF, 0.3);
  for (int reference = 0; reference < 2; reference++) {
    double greatest = 0, sum = 0;
    int count = 0;
    stage_render_by(&set, reference, pixels);
    for (int p = 0; p < SIDE * SIDE; p++) {
      vec3 origin, way;
      stage_eye_ray(&set, p % SIDE, p / SIDE, &origin, &way);
      vec3 at = vec3_add(origin, vec3_scale(way, (0.3 - origin.z) / way.z));
      if (at.x * at.x + at.y * at.y > INSIDE * INSIDE) continue;
      double error = fabs((double)pixels[4 * p] - 0.8 / vec3_length(light));
      sum += error, greatest = fmax(greatest, error), count++;
    }
    print_message("# %s: mean error %.4f, greatest %.4f\n", reference ? "reference" : "sheets", sum / count,
                  greatest);
    assert_true(count > 100);
    assert_true(sum / count < 0.002);
    assert_true(greatest < 0.005);
  }
  stage_close(&set);
}

/* Seen from behind, the cut does not show: the picture with the face's normals is the same as the picture
 * with the data's gradients. */
static void test_cut_behind(void **state) {
  (void)state;
  static float pixels[2][SIDE * SIDE * 4];
  for (int reference = 0; reference < 2; reference++) {
    for (int own = 0; own < 2; own++) {
      stage set;
      open_cut_ball(&set, (vec3){0.5, 0.3, 0.8});
      stage_look(&set, (vec3){20, -30, -60}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
      add_part(&set, -HALF, 0.3);
      if (own) set.volumes[0].cut_shading = HL_CUT_SHADING_GRADIENT;
      stage_render_by(&set, reference, pixels[own]);
      stage_close(&set);
    }
    double greatest = 0;
    for (int f = 0; f < SIDE * SIDE * 4; f++)
      greatest = fmax(greatest, fabs((double)pixels[0][f] - (double)pixels[1][f]));
    print_message("# %s: seen from behind %.6f\n", reference ? "reference" : "sheets", greatest);
    assert_true(greatest < 1e-4);
  }
}

/* If another part of the matter touches the cut, the cut does not show. */
static void test_joined_parts(void **state) {
  (void)state;
  static float pixels[2][SIDE * SIDE * 4];
  for (int parts = 0; parts < 2; parts++) {
    stage set;
    open_cut_ball(&set, (vec3){0.9, 0.3, -0.4});
    stage_look(&set, (vec3){-60, -30, 10}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
    add_part(&set, -HALF, parts ? 0.3 : HALF);
    if (parts) add_part(&set, 0.3, HALF);
    stage_render_sheets(&set, pixels[parts]);
    stage_close(&set);
  }
  double greatest = 0;
  for (int f = 0; f < SIDE * SIDE * 4; f++)
    greatest = fmax(greatest, fabs((double)pixels[0][f] - (double)pixels[1][f]));
  print_message("# two parts against the whole: %.4f\n", greatest);
  assert_true(greatest < 0.005);
}

/* ---- light that leaves matter through a face ---- */

/* Opens a scene of an opaque ball around the origin, or of a layer below the height RADIUS, with a cut and a
 * light. The edge of the matter is two voxels wide. */
static void open_cut_matter(stage *set, int layer, const hl_cut *cut, vec3 light) {
  static float voxels[VOXELS * VOXELS * VOXELS];
  static const hl_opacity_point opacity[] = {{0, 0}, {1, 0.999}};
  for (int n = 0; n < VOXELS * VOXELS * VOXELS; n++) {
    double x = n % VOXELS + 0.5 - HALF, y = n / VOXELS % VOXELS + 0.5 - HALF,
           z = n / (VOXELS * VOXELS) + 0.5 - HALF;
    voxels[n] = (float)fmin(fmax((RADIUS + 1 - (layer ? z : sqrt(x * x + y * y + z * z))) / 2, 0), 1);
  }
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.render.sheet_spacing = 0.5;
  hl_scene_volume *ball = stage_add_grid(set, (size_t[3]){VOXELS, VOXELS, VOXELS}, (double[3]){1, 1, 1},
                                         (vec3){-HALF, -HALF, -HALF}, voxels);
  ball->transfer_function.opacity = opacity;
  ball->transfer_function.opacity_count = 2;
  ball->shading = HL_SHADING_PHONG;
  ball->material = (hl_material){.diffuse = 1, .shininess = 1};
  ball->cuts = cut;
  ball->cut_count = cut != NULL;
  stage_add_directional(set, light);
}

/* A corner of the ball is cut away, from five voxels below its surface on. For the light, the corner's floor
 * lies behind five voxels of opaque matter. The function returns the greatest light on this floor, which
 * should be dark up to the wall. sublights: whether the light is 4 degrees wide, and its shadows are made by
 * sub-lights. */
static double light_in_corner(bool sublights) {
  static float pixels[SIDE * SIDE * 4];
  static const hl_cut corner = {
      .type = HL_CUT_BOX, .min = {-RADIUS + 5, 0, 0}, .max = {40, 40, 40}, .keep = HL_CUT_KEEP_OUTSIDE};
  stage set;
  open_cut_matter(&set, 0, &corner, (vec3){1, 0.15, -0.5});
  if (sublights) {
    set.lights[0].angular_diameter_deg = 4;
    set.scene.render.shadows = HL_SHADOWS_SOFT;
    set.scene.render.soft_method = HL_SOFT_SUBLIGHTS;
    set.scene.render.light_samples = 4;
  }
  set.scene.camera.height = 10;
  stage_look(&set, (vec3){60, 48, 54}, (vec3){-RADIUS + 5, 0, 0}, (vec3){0, 0, 1});
  stage_render_sheets(&set, pixels);
  double greatest = 0;
  int count = 0;
  for (int p = 0; p < SIDE * SIDE; p++) {
    vec3 origin, way;
    stage_eye_ray(&set, p % SIDE, p / SIDE, &origin, &way);
    const vec3 at = vec3_add(origin, vec3_scale(way, -origin.z / way.z));
    const double from_wall = at.x + RADIUS - 5;
    if (from_wall < 0.15 || from_wall > 3 || at.y < 1 || at.y > 4) continue;
    greatest = fmax(greatest, (double)pixels[4 * p]);
    count++;
  }
  stage_close(&set);
  assert_true(count > 100);
  return greatest;
}

static void test_inner_corner(void **state) {
  (void)state;
  const double hard = light_in_corner(false), sublights = light_in_corner(true);
  print_message("# inner corner: greatest light %.4f, with sub-lights %.4f\n", hard, sublights);
  assert_true(hard < 0.01);
  assert_true(sublights < 0.02);
}

/* Beside a cut through which light leaves, the ball's own surface is as bright as without the cut. The light
 * grazes the surface at 8 degrees. */
static void test_rim(void **state) {
  (void)state;
  static float pixels[2][SIDE * SIDE * 4];
  static const hl_cut half = {.type = HL_CUT_PLANE, .normal = {1, 0, 0}};
  double greatest = 0;
  int count = 0;
  for (int whole = 0; whole < 2; whole++) {
    stage set;
    open_cut_matter(&set, 0, whole ? NULL : &half, (vec3){1, 0.1, -0.15});
    set.scene.camera.height = 10;
    stage_look(&set, (vec3){-20, 0, 60}, (vec3){-2, 0, RADIUS}, (vec3){0, 1, 0});
    stage_render_sheets(&set, pixels[whole]);
    for (int p = 0; p < SIDE * SIDE && whole; p++) {
      vec3 origin, way;
      stage_eye_ray(&set, p % SIDE, p / SIDE, &origin, &way);
      const vec3 at = vec3_add(origin, vec3_scale(way, (RADIUS - origin.z) / way.z));
      if (at.x < -3 || at.x > -1 || fabs(at.y) > 2) continue;
      greatest = fmax(greatest, fabs((double)pixels[0][4 * p] - (double)pixels[1][4 * p]));
      count++;
    }
    stage_close(&set);
  }
  print_message("# rim: greatest difference %.4f\n", greatest);
  assert_true(count > 100);
  assert_true(greatest < 0.02);
}

/* A layer, up to two voxels thick, hangs above a floor. The sheets are parallel to the layer's cut. At some
 * heights of the cut, a sheet lies in the cut, and the light leaves the layer at the end of a slab. The floor
 * gets the light that the layer lets through. */
static void test_cut_at_a_sheet(void **state) {
  (void)state;
  static float pixels[SIDE * SIDE * 4];
  double greatest = 0;
  for (int hollow = 0; hollow < 2; hollow++)
    for (int step = 0; step < 8; step++) {
      const double face = RADIUS - 2 + step / 16.0;
      const hl_cut cuts[] = {
          {.type = HL_CUT_PLANE, .point = {0, 0, face}, .normal = {0, 0, -1}},
          {.type = HL_CUT_BOX, .min = {-40, -40, -40}, .max = {40, 40, face}, .keep = HL_CUT_KEEP_OUTSIDE}};
      stage set;
      open_cut_matter(&set, 1, &cuts[hollow], (vec3){0, 0.5, -1});
      hl_scene_volume *floor = stage_add_grid(&set, (size_t[3]){VOXELS, VOXELS, 6}, (double[3]){1, 1, 1},
                                              (vec3){-HALF, -HALF, -HALF - 6}, NULL);
      stage_set_opacity(&set, floor, 0.999, 1);
      floor->shading = HL_SHADING_PHONG;
      floor->material = (hl_material){.diffuse = 1, .shininess = 1};
      set.scene.camera.height = 3;
      stage_look(&set, (vec3){0, 12 + 30, 60 - HALF}, (vec3){0, 12, -HALF}, (vec3){0, 0, 1});
      stage_render_sheets(&set, pixels);
      stage_close(&set);
      for (int p = 0; p < SIDE * SIDE; p++) greatest = fmax(greatest, (double)pixels[4 * p]);
    }
  print_message("# below a cut at a sheet: greatest light %.4f\n", greatest);
  assert_true(greatest < 0.02);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_even_under_grazing_light),
                                     cmocka_unit_test(test_normal_of_a_cut),
                                     cmocka_unit_test(test_cut_behind),
                                     cmocka_unit_test(test_joined_parts),
                                     cmocka_unit_test(test_inner_corner),
                                     cmocka_unit_test(test_rim),
                                     cmocka_unit_test(test_cut_at_a_sheet)};
  return cmocka_run_group_tests_name("sheets_faces", tests, NULL, NULL);
}
