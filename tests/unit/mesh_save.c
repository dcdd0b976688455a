/* unit/mesh_save.c - surfaces of volumes as meshes, and meshes that are written and read again. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <halflight/halflight.h>

#include "small_volume.h"

enum { N = 24 };

/* A ball of the radius 8, whose values fall by 1 for each unit outwards, in voxels with edges of 1, 2 and
 * 0.5. */
static hl_volume *make_ball(hl_context *context) {
  static float values[N * N * N];
  for (int v = 0; v < N * N * N; v++) {
    const double x = v % N - 11.5, y = v / N % N - 11.5, z = v / N / N - 11.5;
    values[v] = (float)(8 - sqrt(x * x + y * y + z * z));
  }
  hl_volume_description d = describe_voxels(N, N, N, HL_VOXEL_F32, values);
  for (int a = 0; a < 3; a++) d.axis[a][a] = a == 0 ? 1 : a == 1 ? 2 : 0.5;
  d.origin[0] = 100;
  return create_volume(context, &d);
}

/* The surface lies on the ellipsoid into which the voxels' edges stretch the ball, and its normals point
 * outwards. The field is the ball's, smoothed by the B-spline (derived: r + 1 / (3 r) = 8). */
static void surfaces_lie_in_the_world(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_volume *ball = make_ball(context);
  hl_mesh *mesh = NULL;
  const double radius = (8 + sqrt(64 - 4.0 / 3)) / 2;
  assert_int_equal(hl_mesh_of_isosurface(context, ball, 0, &mesh, NULL), HL_OK);
  const hl_mesh_description *d = hl_mesh_describe(mesh);
  assert_true(d->triangle_count > 500 && d->normals != NULL);
  for (size_t v = 0; v < d->vertex_count; v++) {
    const double x = d->positions[v][0] - 111.5, y = d->positions[v][1] / 2 - 11.5,
                 z = 2 * d->positions[v][2] - 11.5;
    assert_near(sqrt(x * x + y * y + z * z), radius, 0.02);
    assert_true(x * d->normals[v][0] + y / 2 * d->normals[v][1] + 2 * z * d->normals[v][2] > 0);
  }
  hl_mesh_release(mesh);
  hl_volume_release(ball);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

/* Spheres have no triangles, and so have no area and enclose nothing. */
static void spheres_alone_measure_nothing(void **state) {
  (void)state;
  static const float spheres[1][4] = {{0, 0, 0, 1}};
  hl_context *context = make_context();
  hl_mesh_description description;
  hl_mesh *mesh = NULL;
  double area = 1, volume = 1;
  hl_mesh_description_defaults(&description);
  description.spheres = spheres;
  description.sphere_count = 1;
  assert_int_equal(hl_mesh_create(context, &description, &mesh, NULL), HL_OK);
  assert_int_equal(hl_mesh_measure(context, mesh, &area, &volume, NULL), HL_OK);
  assert_true(area == 0 && isnan(volume));
  hl_mesh_release(mesh);
  hl_context_destroy(context);
}

static void meshes_come_back(void **state) {
  (void)state;
  static const float positions[4][3] = {{0, 0, 0}, {1, 0, 0.1f}, {0, 1, -3e-7f}, {0, 0, 2e9f}},
                     colors[4][4] = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 1, 0.6f}, {0, 0, 0, 1}},
                     spheres[1][4] = {{0, 0, 0, 1}};
  static const uint32_t triangles[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  static const char *const names[] = {"mesh_save.ply", "mesh_save.stl", "mesh_save.obj"};
  hl_context *context = make_context();
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.positions = positions, d.colors = colors, d.vertex_count = 4;
  d.triangles = triangles, d.triangle_count = 4, d.spheres = spheres, d.sphere_count = 1;
  hl_mesh *mesh = NULL;
  assert_int_equal(hl_mesh_create(context, &d, &mesh, NULL), HL_OK);
  for (int n = 0; n < 3; n++) {
    hl_mesh *read = NULL;
    assert_int_equal(hl_mesh_save(context, mesh, names[n], NULL), HL_OK);
    assert_int_equal(hl_mesh_load(context, names[n], &read, NULL), HL_OK);
    const hl_mesh_description *back = hl_mesh_describe(read);
    assert_int_equal(back->triangle_count, 4);
    assert_int_equal(back->sphere_count, 0);
    for (size_t t = 0; t < 4; t++)
      for (int corner = 0; corner < 3; corner++)
        assert_memory_equal(back->positions[back->triangles[t][corner]], positions[triangles[t][corner]],
                            sizeof *positions);
    assert_int_equal(back->colors != NULL, n == 0);
    for (size_t v = 0; n == 0 && v < 4; v++)
      for (int c = 0; c < 4; c++) assert_near(back->colors[v][c], colors[v][c], 0.002);
    hl_mesh_release(read);
    remove(names[n]);
  }
  hl_mesh_release(mesh);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

static void wrong_calls_are_refused(void **state) {
  (void)state;
  hl_context *context = make_context();
  hl_volume *ball = make_ball(context);
  hl_mesh *mesh = NULL;
  hl_error error = {0};
  assert_int_equal(hl_mesh_of_isosurface(context, ball, NAN, &mesh, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_mesh_of_isosurface(context, NULL, 0, &mesh, &error), HL_ERROR_ARGUMENT);
  assert_int_equal(hl_mesh_of_isosurface(context, ball, 9, &mesh, &error), HL_ERROR_INPUT);
  assert_null(mesh);
  assert_non_null(strstr(error.message, "nowhere does the volume have the value 9"));
  assert_int_equal(hl_mesh_of_isosurface(context, ball, 0, &mesh, &error), HL_OK);
  assert_int_equal(hl_mesh_save(context, mesh, "mesh_save.gltf", &error), HL_ERROR_UNSUPPORTED);
  assert_string_equal(error.message,
                      "mesh_save.gltf: no mesh is written under this name: give .ply, .stl or .obj");
  assert_int_equal(hl_mesh_save(context, mesh, "no/such/folder.ply", &error), HL_ERROR_IO);
  assert_int_equal(hl_mesh_save(context, NULL, "a.ply", &error), HL_ERROR_ARGUMENT);
  hl_mesh_release(mesh);
  mesh = NULL;
  assert_int_equal(hl_context_limit_memory(context, hl_context_memory_held(context) + 100000, NULL, NULL),
                   HL_OK);
  assert_int_equal(hl_mesh_of_isosurface(context, ball, 0, &mesh, &error), HL_ERROR_MEMORY);
  assert_null(mesh);
  hl_volume_release(ball);
  assert_int_equal(hl_context_memory_held(context), 0);
  hl_context_destroy(context);
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(surfaces_lie_in_the_world), cmocka_unit_test(spheres_alone_measure_nothing),
      cmocka_unit_test(meshes_come_back), cmocka_unit_test(wrong_calls_are_refused)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
