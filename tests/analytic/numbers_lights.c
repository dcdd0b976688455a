/* analytic/numbers_lights.c - pictures under lights without extent, in unusual places, and of unusual
 * strength. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { SIDE = 14, FLOATS = SIDE * SIDE * 4, GRID = 9 };

/* Haze around a denser middle. The voxel (4, 4, 4) lies at the origin. */
static void open_haze(stage *set) {
  static float voxels[GRID * GRID * GRID];
  for (int i = 0; i < GRID * GRID * GRID; i++)
    voxels[i] = 0.2f + 0.8f * stage_noise(0.9 * (i % GRID), 0.8 * (i / GRID % GRID), 0.7 * (i / GRID / GRID));
  stage_open(set);
  hl_scene_volume *volume = stage_add_grid(set, (size_t[3]){GRID, GRID, GRID}, (double[3]){1, 1, 1},
                                           (vec3){-4.5, -4.5, -4.5}, voxels);
  static const hl_opacity_point opacity[] = {{0.2, 0}, {1, 0.4}};
  volume->transfer_function.opacity = opacity;
  volume->transfer_function.opacity_count = 2;
  set->scene.width = set->scene.height = SIDE;
  set->scene.render.threads = 1;
  set->scene.render.sheet_spacing = 0.5;
  set->scene.render.light_samples = 2;
  set->scene.camera.type = HL_CAMERA_PERSPECTIVE;
  set->scene.camera.fovy_deg = 40;
  stage_look(set, (vec3){12, -14, 9}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
}

static void set_vector(double to[3], double x, double y, double z) {
  to[0] = x;
  to[1] = y;
  to[2] = z;
}

/* ---- no extent ---- */

static void make_directional(hl_light *light, double extent) { light->angular_diameter_deg = 4 * extent; }
static void make_sphere(hl_light *light, double extent) {
  light->type = HL_LIGHT_POINT;
  light->radius = extent;
}
static void make_spot(hl_light *light, double extent) {
  light->type = HL_LIGHT_SPOT;
  light->radius = extent;
}
static void make_disk(hl_light *light, double extent) {
  light->type = HL_LIGHT_DISK;
  light->radius = extent;
}
static void make_rect(hl_light *light, double extent) {
  light->type = HL_LIGHT_RECT;
  set_vector(light->edge1, extent, 0, 0);
  set_vector(light->edge2, 0, extent, 0);
}

typedef void make_light(hl_light *light, double extent);
static make_light *const MAKERS[] = {make_directional, make_sphere, make_spot, make_disk, make_rect};
enum { MAKER_COUNT = sizeof MAKERS / sizeof *MAKERS };

static void render_light(make_light *make, double extent, hl_shadows shadows, hl_soft_method method,
                         float *pixels) {
  stage set;
  open_haze(&set);
  set.scene.render.shadows = shadows;
  set.scene.render.soft_method = method;
  hl_light *light = stage_add_point(&set, (vec3){9, -3, 14});
  light->type = HL_LIGHT_DIRECTIONAL;
  set_vector(light->direction, -9, 3, -14);
  light->opening_angle_deg = 35;
  make(light, extent);
  stage_render_sheets(&set, pixels);
  stage_close(&set);
}

/* The soft shadows of a light without extent have the bytes of its hard shadows. The soft shadows of a light
 * of tiny extent are nearly the same as its hard shadows. */
static void test_no_extent(void **state) {
  (void)state;
  static float expected[FLOATS], pixels[FLOATS];
  for (int m = 0; m < MAKER_COUNT; m++) {
    render_light(MAKERS[m], 0, HL_SHADOWS_HARD, HL_SOFT_CASCADE, expected);
    for (int method = 0; method < 3; method++) {
      render_light(MAKERS[m], 0, HL_SHADOWS_SOFT, (hl_soft_method)method, pixels);
      assert_memory_equal(expected, pixels, sizeof expected);
      for (double extent = 1e-300; extent < 1e-2; extent *= 1e149) {
        render_light(MAKERS[m], extent, HL_SHADOWS_SOFT, (hl_soft_method)method, pixels);
        /* the buffers of soft shadows lie in other places, and are coarser */
        for (int i = 0; i < FLOATS; i++)
          if (!(fabsf(pixels[i] - expected[i]) < 2e-2f))
            fail_msg("light %d, method %d, extent %g: %g instead of %g", m, method, extent, (double)pixels[i],
                     (double)expected[i]);
      }
    }
  }
}

/* ---- odd places ---- */

static void assert_near_reference(stage *set, double mean, const char *what) {
  static float exact[FLOATS], pixels[FLOATS];
  hl_reference_options options;
  hl_reference_options_defaults(&options);
  options.light_points = 36;
  options.threads = 1;
  stage_render(set, &options, exact);
  stage_render_sheets(set, pixels);
  double sum = 0, light = 0;
  for (int i = 0; i < FLOATS; i++) {
    if (!isfinite(pixels[i])) fail_msg("%s: a pixel is not finite", what);
    sum += fabs((double)pixels[i] - (double)exact[i]) / FLOATS;
    light += (double)exact[i] / FLOATS;
  }
  if (!(sum <= mean)) fail_msg("%s: differs from the reference by %.3g, at most %.3g", what, sum, mean);
  assert_true(light > 0.05);
}

/* The lamp stands at the eye, on the centre of the middle voxel, between voxels, and on the box's face and
 * corner. */
static void test_lamps_in_odd_places(void **state) {
  (void)state;
  static const vec3 places[] = {{12, -14, 9}, {0, 0, 0}, {1.5, -2.5, 0.5}, {4.5, 0, 0}, {4.5, 4.5, 4.5}};
  for (size_t p = 0; p < sizeof places / sizeof *places; p++)
    for (int soft = 0; soft < 2; soft++) {
      stage set;
      char what[60];
      open_haze(&set);
      set.scene.render.shadows = soft ? HL_SHADOWS_SOFT : HL_SHADOWS_HARD;
      stage_add_point(&set, places[p])->radius = soft ? 1 : 0;
      snprintf(what, sizeof what, "%s lamp at %g %g %g", soft ? "soft" : "hard", places[p].x, places[p].y,
               places[p].z);
      bool border = p == 4; /* the lamp's sectors meet at the border of the box */
      assert_near_reference(&set, soft ? 2e-2 : border ? 8e-3 : 2e-3, what);
      stage_close(&set);
    }
}

/* Lights shine along the line through the eye and the target in either direction, or in the plane of the
 * picture. */
static void test_aligned_lights(void **state) {
  (void)state;
  static const vec3 ways[] = {{-12, 14, -9}, {12, -14, 9}, {14, 12, 0}};
  for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
    stage set;
    open_haze(&set);
    stage_add_directional(&set, ways[w]);
    assert_near_reference(&set, 5e-3, "a light along or across the view");
    stage_close(&set);
  }
}

/* ---- odd strength ---- */

static void render_strength(double intensity, hl_falloff falloff, float *pixels) {
  stage set;
  open_haze(&set);
  hl_light *light = stage_add_point(&set, (vec3){9, -3, 14});
  light->intensity = intensity;
  light->falloff = falloff;
  stage_render_sheets(&set, pixels);
  stage_close(&set);
}

static void test_strengths(void **state) {
  (void)state;
  static float unit[FLOATS], pixels[FLOATS];
  for (int falloff = 0; falloff < 2; falloff++) {
    render_strength(1, (hl_falloff)falloff, unit);
    for (double intensity = 1e-20; intensity <= 1e20; intensity *= 1e20) {
      render_strength(intensity, (hl_falloff)falloff, pixels);
      for (int i = 0; i < FLOATS; i++) {
        double expected = (double)unit[i] * (i % 4 == 3 ? 1 : intensity);
        if (!(fabs((double)pixels[i] - expected) <= 1e-5 * expected + 1e-38))
          fail_msg("intensity %g: %g instead of %g", intensity, (double)pixels[i], expected);
      }
    }
    render_strength(0, (hl_falloff)falloff, pixels);
    for (int i = 0; i < FLOATS; i++) assert_true(pixels[i] == (i % 4 == 3 ? unit[i] : 0));
  }
}

/* A lamp stands within the data, and its light falls with the square of the distance. All pixels are finite,
 * although light near the lamp is as bright as floats allow. */
static void test_falloff_at_the_lamp(void **state) {
  (void)state;
  static float pixels[FLOATS];
  static const vec3 places[] = {{0, 0, 0}, {0.3, -0.2, 0.1}, {12, -14, 9}};
  for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
    stage set;
    open_haze(&set);
    hl_light *light = stage_add_point(&set, places[p]);
    light->falloff = HL_FALLOFF_INVERSE_SQUARE;
    light->intensity = 1e20;
    set.volumes[0].material.diffuse = set.volumes[0].material.specular = 1000;
    set.volumes[0].shading = HL_SHADING_PHONG;
    stage_render_sheets(&set, pixels);
    for (int i = 0; i < FLOATS; i++) assert_true(isfinite(pixels[i]) && pixels[i] >= 0);
    stage_close(&set);
  }
}

/* ---- refused ---- */

static void test_refused(void **state) {
  (void)state;
  stage set;
  open_haze(&set);
  hl_light *light = stage_add_point(&set, (vec3){9, -3, 14});
  light->intensity = -1;
  stage_refused(&set, "/lights/0/intensity: -1 is negative: give a factor, 0 or more");
  light->intensity = NAN;
  stage_refused(&set, "/lights/0/intensity: nan is not a number: give a factor, 0 or more");
  light->intensity = INFINITY;
  stage_refused(&set, "/lights/0/intensity: inf is out of range: give a factor, 0 or more");
  light->intensity = 1e30;
  stage_refused(
      &set,
      "/lights/0/intensity: makes the light's color 1e+30: use an intensity with which it is at most 1e20");
  light->intensity = 1;
  light->color[1] = -0.5;
  stage_refused(&set, "/lights/0/color/1: -0.5 is negative: give linear RGB, none below 0");
  light->color[1] = 1;
  light->radius = -1;
  stage_refused(&set, "/lights/0/radius: -1 is negative: give a length in world units, 0 for a point");
  light->radius = 0;
  light->position[2] = NAN;
  stage_refused(&set, "/lights/0/position/2: nan is not a number: give a coordinate between -1e15 and 1e15");
  light->type = HL_LIGHT_DIRECTIONAL;
  set_vector(light->direction, 0, 0, 0);
  stage_refused(&set, "/lights/0/direction: has no length: give the direction as three numbers, not all 0");
  static const double line[3][3] = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  light->type = HL_LIGHT_POLYGON;
  light->vertices = line;
  light->vertex_count = 3;
  stage_refused(&set,
                "/lights/0/vertices: span no area: move one off the line, or use a rect light with an edge "
                "of no length");
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_no_extent),           cmocka_unit_test(test_lamps_in_odd_places),
      cmocka_unit_test(test_aligned_lights),      cmocka_unit_test(test_strengths),
      cmocka_unit_test(test_falloff_at_the_lamp), cmocka_unit_test(test_refused),
  };
  return cmocka_run_group_tests_name("numbers_lights", tests, NULL, NULL);
}
