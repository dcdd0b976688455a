/* analytic/sheets_strips.c - the strips of a picture that several renderers make are the picture, bit for
 * bit: with every method of shadows, several sweeps, hidden matter, oversampling and surfaces. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "reference_stage.h"

enum { WIDTH = 36, HEIGHT = 83, ROW_FLOATS = WIDTH * 4, FLOATS = HEIGHT * ROW_FLOATS };

static void render_part(stage *set, int part, int parts, float *pixels) {
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  assert_int_equal(hl_scene_create(set->context, &set->scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_create(set->context, &renderer, NULL), HL_OK);
  assert_int_equal(hl_renderer_share(renderer, part, parts, NULL), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, scene, pixels, ROW_FLOATS, NULL, NULL), HL_OK);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
}

/* A strip is in the picture of its part, and nothing else is. */
static void assert_strips(const float *whole, const float *shared, int part, int parts, const char *what) {
  static const float nothing[ROW_FLOATS];
  for (int row = 0; row < HEIGHT; row++) {
    const float *expected = row / HL_STRIP_ROWS % parts == part ? whole + row * ROW_FLOATS : nothing;
    if (memcmp(shared + row * ROW_FLOATS, expected, sizeof nothing) != 0)
      fail_msg("%s, part %d of %d: row %d differs", what, part, parts, row);
  }
}

static void assert_shared(stage *set, const char *what) {
  static float whole[FLOATS], shared[FLOATS];
  static const int numbers[] = {1, 2, 3, 7};
  set->scene.width = WIDTH;
  set->scene.height = HEIGHT;
  stage_render_sheets(set, whole);
  float sum = 0;
  for (int i = 0; i < FLOATS; i++) sum += whole[i];
  assert_true(sum > 100);
  for (size_t n = 0; n < sizeof numbers / sizeof *numbers; n++)
    for (int part = 0; part < numbers[n]; part++) {
      render_part(set, part, numbers[n], shared);
      assert_strips(whole, shared, part, numbers[n], what);
    }
}

static void add_noise(stage *set, double opacity) {
  static float voxels[30 * 28 * 33];
  const size_t n[3] = {30, 28, 33};
  const double spacing[3] = {0.7, 0.7, 0.7};
  for (size_t v = 0; v < sizeof voxels / sizeof *voxels; v++)
    voxels[v] = stage_noise((double)(v % n[0]) * 0.5, (double)(v / n[0] % n[1]) * 0.6,
                            (double)(v / n[0] / n[1]) * 0.4);
  hl_scene_volume *made = stage_add_grid(set, n, spacing, (vec3){-10, -10, -11}, voxels);
  made->shading = HL_SHADING_PHONG;
  stage_set_opacity(set, made, opacity, 6);
  stage_look(set, (vec3){31, 17, 23}, (vec3){0, 0, 0}, (vec3){0, 0, 1});
}

static void soften(stage *set, hl_soft_method method) {
  set->scene.render.shadows = HL_SHADOWS_SOFT;
  set->scene.render.soft_method = method;
}

static void draw_hard(stage *set) { set->scene.render.shadows = HL_SHADOWS_HARD; }
static void draw_paper(stage *set) { soften(set, HL_SOFT_PAPER); }
static void draw_cascade(stage *set) { soften(set, HL_SOFT_CASCADE); }
static void draw_sublights(stage *set) { soften(set, HL_SOFT_SUBLIGHTS); }
static void draw_maximum(stage *set) { set->scene.render.compositing = HL_COMPOSITING_MAXIMUM; }
static void draw_sky(stage *set) {
  set->scene.sky.type = HL_SKY_UNIFORM;
  for (int c = 0; c < 3; c++) set->scene.sky.color[c] = 0.7;
}
static void draw_isosurface(stage *set) {
  static const hl_isosurface surface = {.value = 0.6, .opacity = 0.8, .color = {0.9, 0.5, 0.3}};
  set->volumes[0].iso = &surface;
  set->volumes[0].iso_count = 1;
}
/* Light from behind: sheets go back to front, and a search finds what opaque matter hides. */
static void draw_hidden(stage *set) {
  stage_set_opacity(set, &set->volumes[0], 0.95, 1);
  stage_add_directional(set, (vec3){31, 17, 23});
}
/* Voxels smaller than pixels: each pixel is a mean of several. */
static void draw_small(stage *set) { stage_look(set, (vec3){93, 51, 69}, (vec3){0, 0, 0}, (vec3){0, 0, 1}); }

typedef struct way {
  const char *name;
  void (*draw)(stage *set);
} way;

static void test_ways(void **state) {
  (void)state;
  static const way ways[] = {
      {"hard", draw_hard},           {"paper", draw_paper},           {"cascade", draw_cascade},
      {"sublights", draw_sublights}, {"maximum", draw_maximum},       {"sky", draw_sky},
      {"hidden", draw_hidden},       {"isosurface", draw_isosurface}, {"small pixels", draw_small}};
  for (size_t n = 0; n < sizeof ways / sizeof *ways; n++) {
    stage set;
    stage_open(&set);
    add_noise(&set, 0.4);
    stage_add_directional(&set, (vec3){-1, 0.5, -1})->angular_diameter_deg = 10;
    stage_add_point(&set, (vec3){14, 25, 30})->radius = 3;
    ways[n].draw(&set);
    assert_shared(&set, ways[n].name);
    stage_close(&set);
  }
}

static void test_refused(void **state) {
  (void)state;
  static float pixels[FLOATS], ambient[FLOATS];
  static const int wrong[][2] = {{0, 0}, {-1, 3}, {3, 3}, {0, -2}};
  stage set;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  stage_open(&set);
  add_noise(&set, 0.4);
  set.scene.width = WIDTH;
  set.scene.height = HEIGHT;
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, NULL), HL_OK);
  assert_int_equal(hl_renderer_create(set.context, &renderer, NULL), HL_OK);
  for (size_t n = 0; n < sizeof wrong / sizeof *wrong; n++)
    assert_int_equal(hl_renderer_share(renderer, wrong[n][0], wrong[n][1], &error), HL_ERROR_ARGUMENT);
  assert_string_equal(error.message, "hl_renderer_share: part 0 of -2: give 0 to parts - 1 of at least 1");
  assert_int_equal(hl_renderer_share(NULL, 0, 1, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_renderer_share(renderer, 1, 2, &error), HL_OK);
  hl_layers layers = {.struct_size = sizeof layers, .ambient = ambient};
  assert_int_equal(hl_renderer_render_layers(renderer, scene, pixels, ROW_FLOATS, &layers, NULL, &error),
                   HL_ERROR_UNSUPPORTED);
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_ways), cmocka_unit_test(test_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
