/* analytic/sheets_parts.c - a volume that is divided into parts looks like the whole volume. Parts are boxes
 * that share faces, copies that overlap, and boxes within boxes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { BALL = 44, SIDE = 80, PIXELS = SIDE * SIDE };

/* The greatest allowed difference between the pictures of the parts and of the whole, as a fraction of full
 * brightness. One pixel of a thousand may differ by more. */
static const double GREATEST = 0.005;

typedef enum layout { WHOLE, EIGHTHS, SLICES, OVERLAP, NESTED } layout;

typedef struct setting {
  const char *name;
  hl_light_type light;
  double size; /* the light's angular diameter in degrees, or the light's radius */
  hl_soft_method method;
  bool behind; /* light from behind the ball */
} setting;

static const setting SETTINGS[] = {
    {"directional, hard", HL_LIGHT_DIRECTIONAL, 0, HL_SOFT_CASCADE, false},
    {"point, hard", HL_LIGHT_POINT, 0, HL_SOFT_CASCADE, false},
    {"from behind, hard", HL_LIGHT_DIRECTIONAL, 0, HL_SOFT_CASCADE, true},
    {"directional, cascade", HL_LIGHT_DIRECTIONAL, 10, HL_SOFT_CASCADE, false},
    {"directional, paper", HL_LIGHT_DIRECTIONAL, 10, HL_SOFT_PAPER, false},
    {"directional, sub-lights", HL_LIGHT_DIRECTIONAL, 10, HL_SOFT_SUBLIGHTS, false},
    {"rect, cascade", HL_LIGHT_RECT, 8, HL_SOFT_CASCADE, false},
};
enum { SETTINGS_COUNT = sizeof SETTINGS / sizeof *SETTINGS };

/* Makes a ball whose edge is four voxels wide, or waves that fill their grid. The matter of all parts
 * together reaches the outermost faces of the whole, so that sheets and shadow buffers lie in the same
 * places. */
static float *make_voxels(layout layout) {
  float *voxels = malloc((size_t)BALL * BALL * BALL * sizeof *voxels);
  assert_non_null(voxels);
  for (int i = 0; i < BALL * BALL * BALL; i++) {
    vec3 p = {i % BALL - 21.5, i / BALL % BALL - 21.5, i / BALL / BALL - 21.5};
    voxels[i] = (float)fmin(fmax((19 - vec3_length(p)) / 4, 0), 1);
    if (layout != EIGHTHS) voxels[i] = 0.2f + stage_noise(p.x / 8, p.y / 8, p.z / 8);
  }
  return voxels;
}

static const hl_opacity_point OPAQUE_BALL[] = {{0, 0}, {1, 0.9}};

static void clip(hl_scene_volume *volume, const double low[3], const double high[3]) {
  volume->clipped = true;
  for (int a = 0; a < 3; a++) {
    volume->clip_min[a] = low[a];
    volume->clip_max[a] = high[a];
  }
}

static hl_scene_volume *add_ball(stage *set, const float *voxels, double opacity) {
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){BALL, BALL, BALL}, (double[3]){1, 1, 1},
                                           (vec3){-22, -22, -22}, voxels);
  stage_set_opacity(set, volume, opacity, 1);
  if (opacity < 0.5) return volume;
  volume->transfer_function.opacity = OPAQUE_BALL;
  volume->transfer_function.opacity_count = 2;
  return volume;
}

/* Adds thin matter in slices, as two copies of half the density, or with a hole that holds a box. The light
 * that passes is 1 - o to the power of the density. */
static void add_thin(stage *set, const float *voxels, layout layout) {
  static const double FACES[5] = {-22, -9, 3, 15, 22};
  if (layout == OVERLAP)
    for (int i = 0; i < 2; i++) stage_set_opacity(set, add_ball(set, voxels, 0.1), 1 - sqrt(1 - 0.1), 1);
  if (layout == SLICES)
    for (int i = 0; i < 4; i++)
      clip(add_ball(set, voxels, 0.1), (double[3]){FACES[i], -22, -22}, (double[3]){FACES[i + 1], 22, 22});
  if (layout != NESTED) return;
  for (int axis = 0; axis < 3; axis++)
    for (int side = -1; side <= 1; side += 2) {
      double low[3], high[3];
      for (int a = 0; a < 3; a++) {
        low[a] = a < axis ? -8 : a > axis ? -22 : side < 0 ? -22 : 7;
        high[a] = a < axis ? 7 : a > axis ? 22 : side < 0 ? -8 : 22;
      }
      clip(add_ball(set, voxels, 0.1), low, high);
    }
  clip(add_ball(set, voxels, 0.1), (double[3]){-8, -8, -8}, (double[3]){7, 7, 7});
}

static void add_parts(stage *set, const float *voxels, layout layout, double opacity) {
  if (layout == WHOLE) (void)add_ball(set, voxels, opacity);
  else if (layout != EIGHTHS) add_thin(set, voxels, layout);
  for (int part = 0; part < 8 && layout == EIGHTHS; part++) {
    double low[3], high[3];
    for (int a = 0; a < 3; a++) {
      low[a] = part >> a & 1 ? 0.55 : -22;
      high[a] = part >> a & 1 ? 22 : 0.55;
    }
    clip(add_ball(set, voxels, opacity), low, high);
  }
}

static void add_light(stage *set, const setting *s) {
  vec3 direction = s->behind ? (vec3){0.3, -0.2, 0.9} : (vec3){0.6, -0.7, -0.4};
  hl_light *light = stage_add_directional(set, direction);
  light->type = s->light;
  for (int a = 0; a < 3; a++) light->position[a] = -100 * light->direction[a];
  light->angular_diameter_deg = s->light == HL_LIGHT_DIRECTIONAL ? s->size : 0;
  light->radius = s->light == HL_LIGHT_POINT ? s->size : 0;
  light->edge1[0] = light->edge2[2] = s->size;
  set->scene.render.shadows = s->size > 0 ? HL_SHADOWS_SOFT : HL_SHADOWS_HARD;
  set->scene.render.soft_method = s->method;
  set->scene.render.light_samples = s->method == HL_SOFT_SUBLIGHTS ? 2 : 1;
}

static void show(const float *voxels, layout layout, double opacity, const setting *s, double spacing,
                 float *pixels) {
  stage set;
  stage_open(&set);
  set.scene.width = set.scene.height = SIDE;
  set.scene.camera.height = 78;
  set.scene.render.sheet_spacing = spacing;
  stage_look(&set, (vec3){50, 60, 110}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  add_parts(&set, voxels, layout, opacity);
  add_light(&set, s);
  stage_render_sheets(&set, pixels);
  stage_close(&set);
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void assert_like_whole(layout layout, double opacity) {
  static float whole[PIXELS * 4], parts[PIXELS * 4];
  static double difference[PIXELS];
  float *voxels = make_voxels(layout);
  for (int i = 0; i < 2 * SETTINGS_COUNT; i++) {
    const setting *s = &SETTINGS[i / 2];
    double spacing = i % 2 == 0 ? 0.5 : 1, brightest = 0;
    show(voxels, WHOLE, opacity, s, spacing, whole);
    show(voxels, layout, opacity, s, spacing, parts);
    for (int p = 0; p < PIXELS; p++) {
      brightest = fmax(brightest, whole[4 * p]);
      difference[p] = fabs((double)whole[4 * p] - parts[4 * p]);
    }
    qsort(difference, PIXELS, sizeof *difference, by_size);
    double found = difference[PIXELS - 1 - PIXELS / 1000];
    if (brightest < 0.05 || found > GREATEST)
      fail_msg("%s, spacing %g: parts differ from the whole by %.5f, which has %.3f", s->name, spacing, found,
               brightest);
  }
  free(voxels);
}

static void test_eighths(void **state) {
  (void)state;
  assert_like_whole(EIGHTHS, 0.9);
  assert_like_whole(EIGHTHS, 0.1);
}

static void test_slices(void **state) {
  (void)state;
  assert_like_whole(SLICES, 0.1);
}

static void test_copies(void **state) {
  (void)state;
  assert_like_whole(OVERLAP, 0.1);
}

static void test_box_in_a_hole(void **state) {
  (void)state;
  assert_like_whole(NESTED, 0.1);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_eighths),
      cmocka_unit_test(test_slices),
      cmocka_unit_test(test_copies),
      cmocka_unit_test(test_box_in_a_hole),
  };
  return cmocka_run_group_tests_name("sheets_parts", tests, NULL, NULL);
}
