/* tests/unit/mesh_scene.c - meshes that a scene's text holds itself: arrays, spheres, lines, floors; they
 * read back as they were written. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

#include "mesh/mesh.h"
#include "scene/scene.h"

static hl_scene *read(hl_context *context, const char *text, const char *told) {
  hl_scene *scene = NULL;
  hl_error error = {0};
  hl_status status = hl_scene_from_json(context, text, strlen(text), NULL, "text", &scene, &error);
  if (told == NULL && status != HL_OK) fail_msg("%s", error.message);
  if (told != NULL && (status != HL_ERROR_INPUT || strstr(error.message, told) == NULL))
    fail_msg("'%s' instead of '%s'", error.message, told);
  return scene;
}

#define SCENE(meshes) "{\"halflight\": 1, \"meshes\": [" meshes "]}"
#define SQUARE \
  "\"vertices\": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], \"triangles\": [[0, 1, 2], [0, 2, 3]]"

static const char *const scenes[] = {
    SCENE("{" SQUARE ", \"colors\": [[1, 0, 0], [0, 1, 0, 0.5], [0, 0, 1], [0.1, 0.2, 0.3]]}"),
    SCENE("{" SQUARE ", \"face_colors\": [[1, 0, 0], [0, 0.1, 1]], \"attenuation_color\": [0, 1, 1]}"),
    SCENE("{" SQUARE ", \"normals\": [[0, 0, 1], [0, 0, 1], [0, 1, 1], [1, 0, 1]]}, {\"floor\": true}"),
    SCENE("{\"spheres\": [[0, 0, 0, 1], [3, 0, 0, 0.1]], \"sphere_colors\": [[1, 0, 0], [0, 1, 0]]}"),
    SCENE("{\"floor\": 5}, {\"spheres\": [[0, 0, 0], [3, 0, 0, 0.1]], \"radius\": 0.5}"),
    SCENE("{\"lines\": [[[0, 0, 0], [3, 0, 0]], [[1, 1, 1], [1, 1, 2], [2, 2, 2]]], \"radius\": 0.25, "
          "\"line_colors\": [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1], [0, 0, 0]]}")};

static void test_written_and_read(void **state) {
  (void)state;
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (size_t n = 0; n < sizeof scenes / sizeof *scenes; n++) {
    char *first = NULL, *second = NULL;
    hl_scene *scene = read(context, scenes[n], NULL);
    assert_int_equal(hl_scene_to_json(context, scene, &first, NULL), HL_OK);
    hl_scene *again = read(context, first, NULL);
    assert_int_equal(hl_scene_to_json(context, again, &second, NULL), HL_OK);
    assert_string_equal(first, second);
    hl_text_release(context, first);
    hl_text_release(context, second);
    hl_scene_release(scene);
    hl_scene_release(again);
  }
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void test_refused(void **state) {
  (void)state;
  static const struct {
    const char *text, *told;
  } cases[] = {
      {SCENE("{}"), "/meshes/0/file: is missing"},
      {SCENE("{\"file\": \"a.ply\", \"spheres\": []}"), "/meshes/0/file: is one of several sources"},
      {SCENE("{\"spheres\": [[0, 0, 0]]}"),
       "/meshes/0/spheres/0: has 3 numbers: give x, y, z and a radius, or one \"radius\" beside them all"},
      {SCENE("{\"spheres\": [[0, 0, 0]], \"radius\": 0}"),
       "/meshes/0/radius: 0 is not above 0: give a length in world units"},
      {SCENE("{\"spheres\": [[0, 0, 0, 1]], \"sphere_colors\": []}"), "/meshes/0/sphere_colors: has 0 rows"},
      {SCENE("{\"spheres\": [[0, 0, 0, -1]]}"), "no sphere and no line"},
      {SCENE("{\"vertices\": [[0, 0, 0]], \"triangles\": [[0, 1, 2]]}"),
       "/meshes/0/triangles/0: names vertex 1"},
      {SCENE("{\"vertices\": [[0, 0, 0]]}"), "/meshes/0/triangles"},
      {SCENE("{\"lines\": [[[0, 0, 0]]], \"radius\": 1}"), "/meshes/0/lines/0"},
      {SCENE("{\"floor\": 0.5}"), "/meshes/0/floor: is 0.5"},
      {SCENE("{\"floor\": true}"), "nothing but a floor"},
      {"{\"halflight\": 1, \"meshes\": []}", "/volumes: is missing"}};
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++)
    assert_null(read(context, cases[n].text, cases[n].told));
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* A floor touches what stands on it, is as wide as was asked, and is not framed. */
static void test_floor(void **state) {
  (void)state;
  static const char with[] = SCENE("{\"spheres\": [[1, 2, 3, 2]]}, {\"floor\": 4}"),
                    without[] = SCENE("{\"spheres\": [[1, 2, 3, 2]]}");
  hl_context *context = NULL;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_scene *scene = read(context, with, NULL), *bare = read(context, without, NULL);
  const hl_scene_description *d = hl_scene_describe(scene);
  double low[3], high[3];
  assert_int_equal(d->mesh_count, 2);
  assert_int_equal(hl_mesh_get_box(d->meshes[1].mesh, low, high), HL_OK);
  const double expected[2][3] = {{1 - 8, 2 - 8, 1}, {1 + 8, 2 + 8, 1}};
  for (int axis = 0; axis < 3; axis++) {
    assert_true(fabs(low[axis] - expected[0][axis]) < 1e-5);
    assert_true(fabs(high[axis] - expected[1][axis]) < 1e-5);
  }
  assert_memory_equal(&d->camera, &hl_scene_describe(bare)->camera, sizeof d->camera);
  hl_scene_release(scene);
  hl_scene_release(bare);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_written_and_read), cmocka_unit_test(test_refused),
                                     cmocka_unit_test(test_floor)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
