/* tests/unit/mesh_scene.c - meshes within a scene's text: arrays, spheres, lines, floors. They read back as
 * they were written. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <string.h>

#include <cmocka.h>

#include <halflight/compose.h>

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

/* A floor touches the objects that stand on it and has the size that was asked for. The camera does not take
 * it into view. */
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

/* The height of the floor below a mesh. */
static double floor_below(hl_context *context, const hl_mesh_description *d) {
  static const double up[3] = {0, 0, 1};
  hl_mesh *mesh = NULL, *made = NULL;
  double low[3], high[3];
  hl_scene_mesh shown;
  hl_scene_description scene;
  assert_int_equal(hl_mesh_create(context, d, &mesh, NULL), HL_OK);
  hl_scene_mesh_defaults(&shown);
  hl_scene_description_defaults(&scene);
  shown.mesh = mesh;
  scene.meshes = &shown, scene.mesh_count = 1;
  assert_int_equal(hl_scene_make_floor(context, &scene, up, 3, &made, NULL), HL_OK);
  assert_int_equal(hl_mesh_get_box(made, low, high), HL_OK);
  hl_mesh_release(mesh);
  hl_mesh_release(made);
  return high[2];
}

/* A floor touches the lowest corner of a mesh, be it the blunt pole of a ball or one of very many corners. */
static void test_floor_touches(void **state) {
  (void)state;
  enum { RING = 24, MANY = 40000 };
  static float positions[MANY + 2][3];
  static uint32_t triangles[MANY][3];
  hl_context *context = NULL;
  hl_mesh_description d;
  assert_int_equal(hl_context_create(NULL, &context, NULL), HL_OK);
  hl_mesh_description_defaults(&d);
  d.positions = (const float(*)[3])positions;
  d.triangles = (const uint32_t(*)[3])triangles;
  for (uint32_t n = 0; n < RING; n++) {
    positions[n][0] = (float)(1.04 * cos(2 * HL_PI * n / RING));
    positions[n][1] = (float)(1.04 * sin(2 * HL_PI * n / RING));
    positions[n][2] = -7.93f;
    for (uint32_t end = 0; end < 2; end++)
      memcpy(triangles[2 * n + end], ((uint32_t[3]){n, (n + 1) % RING, RING + end}), 12);
  }
  positions[RING][2] = -8, positions[RING + 1][2] = 8;
  d.vertex_count = RING + 2, d.triangle_count = 2 * RING;
  assert_true(fabs(floor_below(context, &d) + 8) < 1e-5);
  for (uint32_t n = 0; n < MANY; n++) {
    positions[n][0] = (float)(n % 200), positions[n][1] = (float)(n / 200), positions[n][2] = 0;
    memcpy(triangles[n], ((uint32_t[3]){n, (n + 1) % MANY, (n + 200) % MANY}), 12);
  }
  positions[MANY][2] = -9;
  triangles[MANY / 2 + 1][1] = MANY;
  d.vertex_count = MANY + 1, d.triangle_count = MANY;
  assert_true(fabs(floor_below(context, &d) + 9) < 1e-5);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_written_and_read), cmocka_unit_test(test_refused),
                                     cmocka_unit_test(test_floor), cmocka_unit_test(test_floor_touches)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
