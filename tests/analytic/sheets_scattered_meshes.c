/* analytic/sheets_scattered_meshes.c - meshes absorb scattered light and the light of a sky. Pictures are
 * compared with closed forms, with the reference, and between numbers of threads. */
#include <stdlib.h>
#include <string.h>

#include "../asserts.h"
#include "reference_stage.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE };

/* Opens a scene of a block of haze, 24 x 24 x 24, that scatters most of the light that it meets, seen from
 * above. The picture's width is 20. */
static hl_scene_volume *open_stage(stage *set, double opacity) {
  stage_open(set);
  set->scene.width = set->scene.height = SIDE;
  set->scene.camera.height = 20;
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){24, 24, 24}, (double[3]){1, 1, 1},
                                           (vec3){-12, -12, -12}, NULL);
  stage_set_opacity(set, volume, opacity, 1);
  volume->shading = HL_SHADING_NONE;
  for (int c = 0; c < 3; c++) volume->albedo[c] = 0.95;
  volume->multiple_scattering = 1;
  stage_look(set, (vec3){0, 0, 60}, (vec3){0, 0, 0}, (vec3){0, 1, 0});
  return volume;
}

/* Walls are meshes that do not show in the picture. */
typedef struct walls {
  hl_scene_mesh meshes[2];
} walls;

static void add_wall(stage *set, walls *walls, hl_mesh *mesh, double opacity) {
  hl_scene_mesh *made = &walls->meshes[set->scene.mesh_count];
  hl_scene_mesh_defaults(made);
  made->mesh = mesh;
  made->opacity = opacity;
  made->visible = 0;
  set->scene.meshes = walls->meshes;
  set->scene.mesh_count++;
}

static void close_stage(stage *set) {
  for (size_t m = 0; m < set->scene.mesh_count; m++) hl_mesh_release(set->scene.meshes[m].mesh);
  stage_close(set);
}

/* Returns the mean of a rectangle of pixels from `low` up to `high`, which is excluded. */
static double mean_of(const float *pixels, const int low[2], const int high[2]) {
  double sum = 0;
  for (int y = low[1]; y < high[1]; y++)
    for (int x = low[0]; x < high[0]; x++) sum += (double)pixels[4 * (y * SIDE + x)];
  return sum / ((high[0] - low[0]) * (high[1] - low[1]));
}

static const int LEFT[2][2] = {{0, 0}, {SIDE / 2 - 1, SIDE}}, RIGHT[2][2] = {{SIDE / 2 + 1, 0}, {SIDE, SIDE}},
                 ALL[2][2] = {{0, 0}, {SIDE, SIDE}};

/* An opaque wall divides the haze in the middle. Light from the left leaves the right half dark. A wall that
 * absorbs nothing changes nothing. */
static void test_haze_behind_a_wall(void **state) {
  (void)state;
  static float pixels[3][4 * PIXELS];
  const double opacity[3] = {1, 0.5, 0};
  double right[3], left[3];
  for (int k = 0; k < 3; k++) {
    stage set;
    walls walls;
    (void)open_stage(&set, 0.06);
    (void)stage_add_directional(&set, (vec3){1, 0, 0});
    add_wall(&set, &walls, stage_make_quad(&set, (vec3){0, 0, 0}, (vec3){0, 20, 0}, (vec3){0, 0, 20}),
             opacity[k]);
    stage_render_sheets(&set, pixels[k]);
    right[k] = mean_of(pixels[k], RIGHT[0], RIGHT[1]);
    left[k] = mean_of(pixels[k], LEFT[0], LEFT[1]);
    close_stage(&set);
  }
  assert_true(right[2] > 0.1);
  assert_near(right[0], 0, 0.002 * right[2]);
  assert_true(right[1] > 0.3 * right[2] && right[1] < 0.6 * right[2]);
  assert_true(left[0] > 0.5 * left[2] && left[0] < left[1] && left[1] < left[2]);
}

/* A wall stands between haze and light, so that the haze is dark. With a pane in the wall's place, the haze
 * gets the fraction of light that the pane lets pass, because all light passes the pane once. */
static void test_wall_before_haze(void **state) {
  (void)state;
  static float pixels[4 * PIXELS];
  const double opacity[3] = {0, 0.4, 1};
  double all[3];
  for (int k = 0; k < 3; k++) {
    stage set;
    walls walls;
    (void)open_stage(&set, 0.06);
    (void)stage_add_directional(&set, (vec3){1, 0, 0});
    add_wall(&set, &walls, stage_make_quad(&set, (vec3){-30, 0, 0}, (vec3){0, 40, 0}, (vec3){0, 0, 40}),
             opacity[k]);
    stage_render_sheets(&set, pixels);
    all[k] = mean_of(pixels, ALL[0], ALL[1]);
    close_stage(&set);
  }
  assert_true(all[0] > 0.1);
  assert_near(all[1] / all[0], 0.6, 0.003);
  assert_near(all[2], 0, 1e-4);
}

/* A third of a wide light is hidden. The haze gets two thirds of the light, for once and for repeatedly
 * scattered light. If the light were taken for a point, the haze would get all of the light. */
static void test_part_of_a_wide_light(void **state) {
  (void)state;
  static float pixels[4 * PIXELS];
  double all[2];
  for (int k = 0; k < 2; k++) {
    stage set;
    walls walls;
    (void)open_stage(&set, 0.06);
    hl_light *light = stage_add_point(&set, (vec3){0, 0, 80});
    light->type = HL_LIGHT_RECT;
    light->edge1[0] = light->edge2[1] = 12;
    set.scene.render.shadows = HL_SHADOWS_SOFT;
    add_wall(&set, &walls, stage_make_quad(&set, (vec3){-6.75, 0, 70}, (vec3){5, 0, 0}, (vec3){0, 12, 0}), k);
    stage_render_sheets(&set, pixels);
    all[k] = mean_of(pixels, ALL[0], ALL[1]);
    close_stage(&set);
  }
  assert_true(all[0] > 0.1);
  /* the tolerance is a third of the light of one of the nine points that stand for the light */
  assert_near(all[1] / all[0], 2.0 / 3, 1.0 / 27);
}

/* Thin haze that keeps all light gets its light from the grid of scattered light alone. Haze above a wide
 * wall is lit by half of the sky, and haze above a pane of the opacity 0.4 by 0.8 of the sky. */
static void test_sky_behind_walls(void **state) {
  (void)state;
  static float pixels[4 * PIXELS];
  const double opacity[3] = {0, 1, 0.4}, expected[3] = {1, 0.5, 0.8};
  double open = 0;
  for (int k = 0; k < 3; k++) {
    stage set;
    walls walls;
    (void)open_stage(&set, 1e-3);
    for (int c = 0; c < 3; c++) set.volumes[0].albedo[c] = 1;
    set.scene.sky.type = HL_SKY_UNIFORM;
    add_wall(&set, &walls, stage_make_quad(&set, (vec3){0, 0, -13}, (vec3){400, 0, 0}, (vec3){0, 400, 0}),
             opacity[k]);
    stage_render_sheets(&set, pixels);
    double found = mean_of(pixels, ALL[0], ALL[1]);
    if (k == 0) open = found;
    assert_near(found / open, expected[k], 0.02);
    close_stage(&set);
  }
}

/* Adds a wall in a part of the haze, and a pane through all of the haze. */
static void add_reference_scene(stage *set, walls *walls) {
  (void)open_stage(set, 0.06);
  (void)stage_add_directional(set, (vec3){1, 0.2, -0.3});
  add_wall(set, walls, stage_make_quad(set, (vec3){2, 3, 0}, (vec3){0, 8, 0}, (vec3){0, 0, 20}), 1);
  add_wall(set, walls, stage_make_quad(set, (vec3){0, 0, -5}, (vec3){20, 0, 0}, (vec3){0, 20, 0}), 0.5);
}

/* The mean of each half of the picture differs from the reference's mean by less than the sum of 6 percent
 * and four of the reference's standard errors. */
static void test_against_the_reference(void **state) {
  (void)state;
  static float pixels[4 * PIXELS], exact[4 * PIXELS], errors[3 * PIXELS];
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.paths = 48;
  options.step = 1;
  options.error = errors;
  stage set;
  walls walls;
  add_reference_scene(&set, &walls);
  stage_render_sheets(&set, pixels);
  stage_render(&set, &options, exact);
  double square = 0;
  for (int i = 0; i < PIXELS; i++) square += (double)errors[3 * i] * (double)errors[3 * i];
  for (int half = 0; half < 2; half++) {
    const int(*part)[2] = half == 0 ? LEFT : RIGHT;
    double truth = mean_of(exact, part[0], part[1]), found = mean_of(pixels, part[0], part[1]);
    assert_true(truth > 0.05);
    assert_near(found, truth, 0.06 * truth + 4 * sqrt(square) / (PIXELS / 2.0));
  }
  close_stage(&set);
}

/* The picture has the same bytes with any number of threads, and by a renderer that has rendered another wall
 * before. */
static void test_same_bytes(void **state) {
  (void)state;
  static float first[4 * PIXELS], other[4 * PIXELS];
  stage set;
  walls walls;
  hl_renderer *renderer = NULL;
  add_reference_scene(&set, &walls);
  set.scene.sky.type = HL_SKY_GRADIENT;
  set.volumes[0].anisotropy = 0.5;
  set.scene.render.threads = 1;
  stage_render_sheets(&set, first);
  set.scene.render.threads = 3;
  stage_render_sheets(&set, other);
  assert_memory_equal(first, other, sizeof first);
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  walls.meshes[0].opacity = 0.25;
  stage_render_with(&set, renderer, other);
  assert_memory_not_equal(first, other, sizeof first);
  walls.meshes[0].opacity = 1;
  stage_render_with(&set, renderer, other);
  assert_memory_equal(first, other, sizeof first);
  hl_renderer_destroy(renderer);
  close_stage(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_haze_behind_a_wall),    cmocka_unit_test(test_wall_before_haze),
      cmocka_unit_test(test_part_of_a_wide_light),  cmocka_unit_test(test_sky_behind_walls),
      cmocka_unit_test(test_against_the_reference), cmocka_unit_test(test_same_bytes),
  };
  return cmocka_run_group_tests_name("sheets_scattered_meshes", tests, NULL, NULL);
}
