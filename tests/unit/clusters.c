/* unit/clusters.c - clusters of triangles. Each triangle is in one cluster, the boxes and cones of clusters
 * contain their triangles, and clusters that are said to face away from a view do. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "../asserts.h"
#include "core/context.h"
#include "surface/clusters.h"

enum { ACROSS = 96, ALONG = 40, VERTICES = ACROSS * ALONG, TRIANGLES = 2 * VERTICES, SPHERES = 100 };

static const double PI = 3.14159265358979323846;

/* A closed ring of radius 3 and thickness 1, with its triangles in random order, and spheres along it. */
typedef struct ring {
  hl_context *context;
  hl_pool *pool;
  float positions[VERTICES][3], spheres[SPHERES][4];
  uint32_t triangles[TRIANGLES][3];
  surface_mesh mesh;
  surfaces all;
} ring;

static void place_ring(ring *r) {
  for (int i = 0; i < ACROSS; i++)
    for (int k = 0; k < ALONG; k++) {
      double u = 2 * PI * i / ACROSS, v = 2 * PI * k / ALONG, out = 3 + cos(v);
      float *at = r->positions[i * ALONG + k];
      at[0] = (float)(out * cos(u)), at[1] = (float)(out * sin(u)), at[2] = (float)sin(v);
      uint32_t a = (uint32_t)(i * ALONG + k), b = (uint32_t)((i + 1) % ACROSS * ALONG + k),
               c = (uint32_t)((i + 1) % ACROSS * ALONG + (k + 1) % ALONG),
               d = (uint32_t)(i * ALONG + (k + 1) % ALONG);
      memcpy(r->triangles[2 * a], (uint32_t[3]){a, b, c}, sizeof r->triangles[0]);
      memcpy(r->triangles[2 * a + 1], (uint32_t[3]){a, c, d}, sizeof r->triangles[0]);
    }
  uint32_t seed = 1;
  for (uint32_t t = TRIANGLES - 1; t > 0; t--) {
    seed = seed * 1664525u + 1013904223u;
    uint32_t other = (seed >> 8) % (t + 1), swapped[3];
    memcpy(swapped, r->triangles[t], sizeof swapped);
    memcpy(r->triangles[t], r->triangles[other], sizeof swapped);
    memcpy(r->triangles[other], swapped, sizeof swapped);
  }
  for (int n = 0; n < SPHERES; n++) {
    memcpy(r->spheres[n], r->positions[n * 37], sizeof r->positions[0]);
    r->spheres[n][3] = 0.1f;
  }
}

static int set_up(void **state) {
  ring *r = calloc(1, sizeof *r);
  assert_non_null(r);
  assert_int_equal(hl_context_create(NULL, &r->context, NULL), HL_OK);
  assert_int_equal(hl_pool_create(r->context, 2, &r->pool, NULL), HL_OK);
  place_ring(r);
  r->mesh = (surface_mesh){.primitives = {{0, TRIANGLES}, {TRIANGLES, SPHERES}}};
  r->all = (surfaces){.meshes = &r->mesh,
                      .mesh_count = 1,
                      .positions = r->positions,
                      .triangles = r->triangles,
                      .spheres = r->spheres,
                      .vertex_count = VERTICES,
                      .first = {0, TRIANGLES, TRIANGLES + SPHERES}};
  assert_int_equal(hl_clusters_create(r->context, r->pool, &r->all, NULL), HL_OK);
  *state = r;
  return 0;
}

static int tear_down(void **state) {
  ring *r = *state;
  hl_clusters_release(r->context, &r->all);
  hl_pool_destroy(r->pool);
  hl_context_destroy(r->context);
  free(r);
  return 0;
}

static void test_each_once(void **state) {
  const ring *r = *state;
  const surfaces *all = &r->all;
  bool found[TRIANGLES + SPHERES] = {false};
  uint32_t next = 0;
  for (size_t c = 0; c < all->cluster_count; c++) {
    assert_int_equal(all->clusters[c].first, next);
    next += all->clusters[c].count;
    for (uint32_t i = all->clusters[c].first; i < next; i++) {
      assert_false(found[all->order[i]]);
      found[all->order[i]] = true;
      assert_true((all->order[i] < TRIANGLES) == (all->clusters[c].first < TRIANGLES));
    }
  }
  assert_int_equal(next, TRIANGLES + SPHERES);
}

static void check_within(const surface_cluster *cluster, const float at[3], float radius) {
  for (int axis = 0; axis < 3; axis++)
    assert_true(cluster->low[axis] <= at[axis] - radius && cluster->high[axis] >= at[axis] + radius);
}

/* The corners are copies of the triangles', within the box; the normals lie within the cone. */
static void check_triangle(const surfaces *all, size_t c, uint32_t t) {
  const surface_cluster *cluster = &all->clusters[c];
  const cluster_shape shape = hl_cluster_shape(all, cluster);
  const uint32_t *vertex = all->triangles[all->order[cluster->first + t]];
  vec3 normal = {shape.normals[0][t], shape.normals[1][t], shape.normals[2][t]};
  assert_true(vec3_dot(vec3_normalise(normal), hl_surface_vector(cluster->axis)) >=
              (double)cluster->cosine - 1e-6);
  for (int i = 0; i < 3; i++) {
    check_within(cluster, all->positions[vertex[i]], 0);
    for (size_t axis = 0; axis < 3; axis++)
      assert_float_equal(shape.positions[axis * shape.vertices + shape.corners[i][t]],
                         all->positions[vertex[i]][axis], 0);
  }
}

/* Boxes contain their triangles and are small. A square of 64 triangles of the area 0.0155 would be a unit
 * wide, and some clusters have two or three pieces. The box of the whole ring has a diagonal of 11.5. */
static void test_boxes(void **state) {
  const ring *r = *state;
  const surfaces *all = &r->all;
  double sum = 0, triangles = 0;
  for (size_t c = 0; c < all->cluster_count; c++) {
    const surface_cluster *cluster = &all->clusters[c];
    for (uint32_t i = 0; i < cluster->count; i++) {
      uint32_t primitive = all->order[cluster->first + i];
      if (primitive < TRIANGLES) check_triangle(all, c, i);
      else check_within(cluster, r->spheres[primitive - TRIANGLES], r->spheres[primitive - TRIANGLES][3]);
    }
    if (cluster->first >= TRIANGLES) continue;
    sum += vec3_length(vec3_subtract(hl_surface_vector(cluster->high), hl_surface_vector(cluster->low)));
    triangles++;
  }
  assert_true(sum / triangles < 3);
}

static void check_facing(const surfaces *all, const view *view, double least) {
  size_t away = 0, clusters = 0;
  for (size_t c = 0; c < all->cluster_count && all->clusters[c].first < TRIANGLES; c++) {
    clusters++;
    if (!hl_cluster_faces_away(&all->clusters[c], view)) continue;
    away++;
    for (uint32_t i = 0; i < all->clusters[c].count; i++) {
      const uint32_t *vertex = all->triangles[all->order[all->clusters[c].first + i]];
      vec3 at[3];
      for (int k = 0; k < 3; k++) at[k] = hl_surface_vector(all->positions[vertex[k]]);
      vec3 normal = vec3_cross(vec3_subtract(at[1], at[0]), vec3_subtract(at[2], at[0]));
      vec3 way = view->perspective ? vec3_subtract(at[0], view->origin) : view->direction;
      assert_true(vec3_dot(normal, way) > 0);
    }
  }
  assert_true((double)away > least * (double)clusters);
}

static void test_facing(void **state) {
  const ring *r = *state;
  for (int i = 0; i < 8; i++) {
    vec3 way = vec3_normalise((vec3){cos(i), sin(i), 0.3 * i - 1});
    const view parallel = {.direction = way}, near = {.perspective = true, .origin = vec3_scale(way, -6)};
    check_facing(&r->all, &parallel, 0.05);
    check_facing(&r->all, &near, 0.03);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_each_once), cmocka_unit_test(test_boxes),
                                     cmocka_unit_test(test_facing)};
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
