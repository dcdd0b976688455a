/* analytic/numbers_places.c - pictures of tiny, huge, far-away and mirrored scenes, and of scenes with
 * far-away eyes and lamps. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "compare_scenes.h"
#include "moved_stage.h"

enum { WIDTH = 30, HEIGHT = 26, FLOATS = WIDTH * HEIGHT * 4 };

static double vertices[64][3];

/* Opens a scene at a small size. The scene's index chooses one of the kinds of shadows in turn. */
static void open_scene(stage *set, const scenario *from, size_t index) {
  stage_open(set);
  from->make(set);
  set->scene.width = WIDTH;
  set->scene.height = HEIGHT;
  set->scene.render.sheet_spacing = 1;
  set->scene.render.threads = 1;
  set->scene.render.light_samples = 2;
  set->scene.render.shadows = index % 4 == 0 ? HL_SHADOWS_HARD : HL_SHADOWS_SOFT;
  set->scene.render.soft_method = (hl_soft_method)((index + 3) % 4 % 3);
}

static void flip_columns(float *pixels) {
  for (int row = 0; row < HEIGHT; row++)
    for (int left = 0; left < WIDTH / 2; left++) {
      float kept[4], *a = pixels + 4 * (row * WIDTH + left),
                     *b = pixels + 4 * (row * WIDTH + WIDTH - 1 - left);
      memcpy(kept, a, sizeof kept);
      memcpy(a, b, sizeof kept);
      memcpy(b, kept, sizeof kept);
    }
}

typedef struct difference {
  double mean, greatest;
} difference;

static difference compare(const float *a, const float *b) {
  difference d = {0, 0};
  for (int i = 0; i < FLOATS; i++) {
    double off = fabs((double)a[i] - (double)b[i]);
    d.mean += off / FLOATS;
    d.greatest = off <= d.greatest ? d.greatest : off; /* a NaN counts as the greatest number */
  }
  return d;
}

static void assert_close(const float *expected, const float *pixels, double mean, double greatest,
                         const char *what) {
  difference d = compare(expected, pixels);
  if (!(d.mean <= mean && d.greatest <= greatest))
    fail_msg("%s: differs by %.3g, at most %.3g", what, d.mean, d.greatest);
}

typedef struct move_case {
  const char *name;
  motion by;
  int by_transform;
  double mean, greatest; /* the allowed differences; 0: the pictures must have the same bytes */
} move_case;

/* Moves each scene in each way. Motions by powers of two are exact; other motions round positions. A light
 * that shines exactly across the view may then get another slicing direction, whose picture is as good.
 */
static void check_moves(const move_case *cases, size_t case_count, bool mirrored) {
  static float expected[FLOATS], pixels[FLOATS];
  size_t scenes;
  const scenario *all = compare_scenarios(&scenes);
  for (size_t i = 0; i < scenes; i++) {
    stage set;
    open_scene(&set, &all[i], i);
    stage_render_sheets(&set, expected);
    /* A clip box and cuts follow the volume's transform. A transform cannot mirror a volume. */
    bool clipped = set.volumes[0].clipped || set.volumes[0].cut_count > 0;
    stage_close(&set);
    for (size_t c = 0; c < case_count && !(mirrored && clipped); c++) {
      char what[100];
      snprintf(what, sizeof what, "%s, %s", all[i].name, cases[c].name);
      open_scene(&set, &all[i], i);
      stage_move(&set, &cases[c].by, cases[c].by_transform, vertices);
      stage_render_sheets(&set, pixels);
      stage_close(&set);
      if (mirrored) flip_columns(pixels);
      assert_close(expected, pixels, cases[c].mean, cases[c].greatest, what);
    }
  }
}

static void test_scales(void **state) {
  (void)state;
  const move_case cases[] = {{"2^30", motion_of_scale(0x1p30), 0, 0, 0},
                             {"2^-30", motion_of_scale(0x1p-30), 1, 0, 0},
                             {"1e9", motion_of_scale(1e9), 1, 2e-4, 5e-3},
                             {"1e-9", motion_of_scale(1e-9), 0, 2e-4, 1e-2}};
  check_moves(cases, sizeof cases / sizeof *cases, false);
}

/* Coordinates of 1e7 are rounded to 2e-9. */
static void test_far_origins(void **state) {
  (void)state;
  const move_case cases[] = {{"1e7 away", motion_of_shift(1e7, -1e7, 1e7), 0, 1e-6, 1e-4}};
  check_moves(cases, 1, false);
}

/* A left-handed grid is the mirror image of a right-handed one. Buffers and sheets then lie on the mirror's
 * other side, so that positions are the same to a pixel. */
static void test_mirror(void **state) {
  (void)state;
  const move_case cases[] = {
      {"mirrored", motion_of_mirror((vec3){1 / 3.0, 2 / 3.0, -2 / 3.0}), 0, 2e-3, 0.08}};
  check_moves(cases, 1, true);
}

static const scenario *scene_named(const char *name) {
  size_t count;
  const scenario *all = compare_scenarios(&count);
  for (size_t i = 0; i < count; i++)
    if (strcmp(all[i].name, name) == 0) return &all[i];
  fail_msg("no scene %s", name);
  return NULL;
}

/* From far away, a perspective picture is the orthographic one. The directions of the perspective camera's
 * rays differ by angles of size / distance.
 */
static void test_far_eyes(void **state) {
  (void)state;
  static float expected[FLOATS], pixels[FLOATS];
  static const char *const names[] = {"balls", "clipped", "smoke"};
  for (size_t n = 0; n < sizeof names / sizeof *names; n++)
    for (double distance = 1e5; distance <= 1e9; distance *= 1e2) {
      stage set;
      open_scene(&set, scene_named(names[n]), 1);
      stage_render_sheets(&set, expected);
      hl_camera *camera = &set.scene.camera;
      vec3 target = vec3_of(camera->target),
           back = vec3_normalise(vec3_subtract(vec3_of(camera->position), target));
      stage_look(&set, vec3_add(target, vec3_scale(back, distance)), target, vec3_of(camera->up));
      stage_render_sheets(&set, pixels);
      assert_close(expected, pixels, 1e-5, 2e-3, "an orthographic camera from afar");
      camera->type = HL_CAMERA_PERSPECTIVE;
      camera->fovy_deg = 2 * atan(camera->height / 2 / distance) * 180 / HL_PI;
      if (camera->fovy_deg >= 1e-6) { /* the smallest positive number */
        stage_render_sheets(&set, pixels);
        assert_close(expected, pixels, 1e-3, 2e-2, "a perspective camera from afar");
      }
      stage_close(&set);
    }
}

/* The light of a lamp that is far away is the same as parallel light. */
static void test_far_lamps(void **state) {
  (void)state;
  static float expected[FLOATS], pixels[FLOATS];
  static const char *const names[] = {"balls", "balls-medium", "smoke"};
  for (size_t n = 0; n < sizeof names / sizeof *names; n++)
    for (double distance = 1e5; distance <= 1e11; distance *= 1e3)
      for (int soft = 0; soft < 2; soft++) {
        stage set;
        open_scene(&set, scene_named(names[n]), soft ? 1 : 0);
        hl_light *light = &set.lights[0];
        light->angular_diameter_deg = soft ? 10 : 0;
        stage_render_sheets(&set, expected);
        vec3 position = vec3_scale(vec3_normalise(vec3_of(light->direction)), -distance);
        light->type = HL_LIGHT_POINT;
        light->radius = soft ? tan(5 * HL_PI / 180) * distance : 0;
        light->position[0] = position.x;
        light->position[1] = position.y;
        light->position[2] = position.z;
        stage_render_sheets(&set, pixels);
        assert_close(expected, pixels, 2e-4, 5e-2,
                     "a lamp from afar"); /* the pixels of the buffers lie in other places */
        stage_close(&set);
      }
}

/* Numbers in which floats cannot tell voxels apart are refused, and the message names the numbers. */
static void test_beyond_reach(void **state) {
  (void)state;
  stage set;
  open_scene(&set, scene_named("balls"), 0);
  set.scene.camera.position[0] = 1e13;
  stage_refused(&set,
                "/camera/position: reaches 1e+13 from the volumes, whose smallest voxel edge is 1: use at "
                "most 1e12 times "
                "that, or a directional light or orthographic camera");
  set.scene.camera.position[0] = 40;
  set.lights[0].type = HL_LIGHT_POINT;
  set.lights[0].position[2] = 1e14;
  stage_refused(&set,
                "/lights/0/position: reaches 1e+14 from the volumes, whose smallest voxel edge is 1: use at "
                "most 1e12 times "
                "that, or a directional light or orthographic camera");
  set.lights[0].position[2] = 40;
  set.lights[0].intensity = 1e30;
  stage_refused(
      &set,
      "/lights/0/intensity: makes the light's color 1e+30: use an intensity with which it is at most 1e20");
  set.lights[0].intensity = 1;
  set.volumes[0].scale = 1e-20;
  stage_refused(&set,
                "/volumes/0/transform: makes the edges of voxels 1e-20 long: give a scale with which they "
                "are from 1e-15 to 1e15");
  stage_close(&set);
}

/* If the sizes of voxels differ very much, there are more sheets than can be told apart. */
static void test_too_many_sheets(void **state) {
  (void)state;
  static float pixels[16 * 16 * 4];
  stage set;
  hl_scene *scene = NULL;
  hl_renderer *renderer = NULL;
  hl_error error = {0};
  stage_open(&set);
  stage_add_grid(&set, (size_t[3]){3, 3, 3}, (double[3]){1e-9, 1, 1}, (vec3){0, 0, 0}, NULL);
  assert_int_equal(hl_scene_create(set.context, &set.scene, &scene, &error), HL_OK);
  assert_int_equal(hl_renderer_create(set.context, &renderer, &error), HL_OK);
  assert_int_equal(hl_renderer_render(renderer, scene, pixels, 64, NULL, &error), HL_ERROR_UNSUPPORTED);
  assert_string_equal(error.message,
                      "/render/sheet_spacing: makes more than 100000 sheets of the volumes, whose smallest "
                      "voxel edge is small "
                      "beside their size: raise it, or correct the spacing of voxels (--spacing)");
  hl_renderer_destroy(renderer);
  hl_scene_release(scene);
  stage_close(&set);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_scales),          cmocka_unit_test(test_far_origins),
      cmocka_unit_test(test_mirror),          cmocka_unit_test(test_far_eyes),
      cmocka_unit_test(test_far_lamps),       cmocka_unit_test(test_beyond_reach),
      cmocka_unit_test(test_too_many_sheets),
  };
  return cmocka_run_group_tests_name("numbers_places", tests, NULL, NULL);
}
