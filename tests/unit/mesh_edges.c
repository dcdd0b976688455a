/* unit/mesh_edges.c - the normals that corners of meshes without normals get at edges. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <halflight/halflight.h>

#include "../asserts.h"
#include "core/vector.h"
#include "mesh/mesh.h"

enum { SIDES = 24, RINGS = 12, BLADES = 300 };

typedef struct set_up {
  hl_context *context;
  float positions[SIDES * (RINGS + 1) + 2][3];
  uint32_t triangles[2 * SIDES * (RINGS + 2)][3];
  size_t vertices, count;
} set_up;

static void add_vertex(set_up *s, double x, double y, double z) {
  float *p = s->positions[s->vertices++];
  p[0] = (float)x, p[1] = (float)y, p[2] = (float)z;
}

static void add_triangle(set_up *s, size_t a, size_t b, size_t c) {
  uint32_t *t = s->triangles[s->count++];
  t[0] = (uint32_t)a, t[1] = (uint32_t)b, t[2] = (uint32_t)c;
}

static hl_mesh *create(set_up *s) {
  hl_mesh *mesh = NULL;
  hl_mesh_description d;
  hl_mesh_description_defaults(&d);
  d.positions = (const float(*)[3])s->positions, d.vertex_count = s->vertices;
  d.triangles = (const uint32_t(*)[3])s->triangles, d.triangle_count = s->count;
  assert_int_equal(hl_context_create(NULL, &s->context, NULL), HL_OK);
  assert_int_equal(hl_mesh_create(s->context, &d, &mesh, NULL), HL_OK);
  return mesh;
}

static void end(set_up *s, hl_mesh *mesh) {
  hl_mesh_release(mesh);
  assert_int_equal(hl_context_memory_held(s->context), 0);
  hl_context_destroy(s->context);
}

static vec3 vector(const float v[3]) { return (vec3){v[0], v[1], v[2]}; }

static vec3 flat_normal(const set_up *s, size_t triangle) {
  const uint32_t *t = s->triangles[triangle];
  vec3 a = vector(s->positions[t[0]]);
  return vec3_normalise(
      vec3_cross(vec3_subtract(vector(s->positions[t[1]]), a), vec3_subtract(vector(s->positions[t[2]]), a)));
}

static vec3 edge_normal(const hl_mesh *mesh, size_t triangle, int corner) {
  assert_non_null(mesh->edges);
  assert_true(mesh->edges[triangle][corner] < mesh->edge_normal_count);
  return vector(mesh->edge_normals[mesh->edges[triangle][corner]]);
}

/* All corners of a box have the normals of their faces, however long the box is. */
static void test_long_box(void **state) {
  (void)state;
  static const uint32_t box[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                      {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  static set_up s;
  s = (set_up){0};
  for (int i = 0; i < 8; i++) add_vertex(&s, i & 1 ? 90 : 0, i & 2 ? 4 : 0, i & 4 ? 1 : 0);
  for (int t = 0; t < 12; t++) add_triangle(&s, box[t][0], box[t][1], box[t][2]);
  hl_mesh *mesh = create(&s);
  for (size_t t = 0; t < 12; t++)
    for (int i = 0; i < 3; i++) assert_near(vec3_dot(edge_normal(mesh, t, i), flat_normal(&s, t)), 1, 1e-6);
  end(&s, mesh);
}

/* The wall of a can is round up to its rims, and its ends are flat. The middles of the ends are no edges. */
static void test_can(void **state) {
  (void)state;
  static set_up s;
  s = (set_up){0};
  for (int n = 0; n < 2 * SIDES; n++)
    add_vertex(&s, cos(2 * HL_PI * n / SIDES), sin(2 * HL_PI * n / SIDES), n < SIDES ? 0 : 5);
  add_vertex(&s, 0, 0, 0);
  add_vertex(&s, 0, 0, 5);
  for (size_t n = 0; n < SIDES; n++) {
    size_t next = (n + 1) % SIDES;
    add_triangle(&s, n, next, SIDES + next);
    add_triangle(&s, n, SIDES + next, SIDES + n);
    add_triangle(&s, 2 * SIDES, next, n);
    add_triangle(&s, 2 * SIDES + 1, SIDES + n, SIDES + next);
  }
  hl_mesh *mesh = create(&s);
  for (size_t t = 0; t < s.count; t++)
    for (int i = 0; i < 3; i++) {
      if (s.triangles[t][i] >= 2 * SIDES) {
        assert_true(mesh->edges[t][i] == HL_NO_EDGE);
        continue;
      }
      vec3 normal = edge_normal(mesh, t, i), at = vector(s.positions[s.triangles[t][i]]);
      if (t % 4 >= 2) assert_near(vec3_dot(normal, flat_normal(&s, t)), 1, 1e-6);
      else assert_near(normal.z, 0, 1e-6);
      if (t % 4 < 2) assert_true(normal.x * at.x + normal.y * at.y > cos(HL_PI / SIDES));
    }
  end(&s, mesh);
}

/* A ball is round everywhere. A vertex at which very many triangles meet keeps one normal. */
static void test_no_edges(void **state) {
  (void)state;
  static set_up s;
  s = (set_up){0};
  for (int ring = 0; ring <= RINGS; ring++)
    for (int n = 0; n < SIDES; n++)
      add_vertex(&s, sin(HL_PI * ring / RINGS) * cos(2 * HL_PI * n / SIDES),
                 sin(HL_PI * ring / RINGS) * sin(2 * HL_PI * n / SIDES), cos(HL_PI * ring / RINGS));
  for (size_t n = 0; n < SIDES * RINGS; n++) {
    size_t next = n / SIDES * SIDES + (n + 1) % SIDES;
    if (n >= SIDES) add_triangle(&s, n, n + SIDES, next);
    if (n < SIDES * (RINGS - 1)) add_triangle(&s, next, n + SIDES, next + SIDES);
  }
  hl_mesh *mesh = create(&s);
  assert_null(mesh->edges);
  end(&s, mesh);
  s = (set_up){0};
  add_vertex(&s, 0, 0, 9);
  for (int n = 0; n < BLADES; n++)
    add_vertex(&s, cos(2 * HL_PI * n / BLADES), sin(2 * HL_PI * n / BLADES), 0);
  for (size_t n = 0; n < BLADES; n++) add_triangle(&s, 0, 1 + n, 1 + (n + 1) % BLADES);
  mesh = create(&s);
  assert_int_equal(mesh->edge_normal_count, 0);
  for (size_t t = 0; t < BLADES; t++) assert_true(mesh->edges[t][0] == HL_NO_EDGE);
  end(&s, mesh);
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_long_box), cmocka_unit_test(test_can),
                                     cmocka_unit_test(test_no_edges)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
