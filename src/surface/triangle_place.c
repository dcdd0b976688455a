/* surface/triangle_place.c - brings the triangles of a mesh, with their vertices and normals, to frame space
 * (triangle.h). */
#include <string.h>

#include "surface/triangle.h"

size_t hl_triangle_count(const hl_mesh_description *mesh) { return mesh->triangle_count; }

void hl_triangle_lay_out(surfaces *made, hl_layout *layout) {
  const uint32_t count = made->first[PRIMITIVE_triangle + 1] - made->first[PRIMITIVE_triangle];
  made->positions = hl_layout_take(layout, made->vertex_count, sizeof *made->positions);
  made->normals = hl_layout_take(layout, made->vertex_count, sizeof *made->normals);
  made->edge_normals = hl_layout_take(layout, made->edge_normal_count, sizeof *made->edge_normals);
  made->triangles = hl_layout_take(layout, count, sizeof *made->triangles);
}

/* Adds a triangle's cross product to the normals of its corners. The length of the cross product is twice the
 * triangle's area, so large faces count more. */
static void add_face_normals(surfaces *made, const surface_mesh *mesh) {
  const hl_mesh_description *d = &mesh->mesh->description;
  float(*const positions)[3] = made->positions + mesh->first_vertex;
  float(*const normals)[3] = made->normals + mesh->first_vertex;
  for (size_t t = 0; t < d->triangle_count; t++) {
    const uint32_t *corner = d->triangles[t];
    vec3 a = hl_surface_vector(positions[corner[0]]);
    vec3 cross = vec3_cross(vec3_subtract(hl_surface_vector(positions[corner[1]]), a),
                            vec3_subtract(hl_surface_vector(positions[corner[2]]), a));
    for (int i = 0; i < 3; i++)
      vec3_store(normals[corner[i]], vec3_add(hl_surface_vector(normals[corner[i]]), cross));
  }
}

/* The data by which the vertices and triangles of a mesh are brought to frame space. A task of the pool
 * handles A_TASK vertices or triangles. */
enum { A_TASK = 1 << 15 };
typedef struct placing {
  surfaces *made;
  const surface_mesh *mesh;
} placing;

static size_t task_count(size_t items) { return (items + A_TASK - 1) / A_TASK; }
static size_t task_end(size_t task, size_t items) {
  return (task + 1) * A_TASK < items ? (task + 1) * A_TASK : items;
}

static void place_vertices(void *data, size_t task, int worker) {
  (void)worker;
  const placing *placing = data;
  const hl_mesh_description *d = &placing->mesh->mesh->description;
  const affine3 placement = placing->mesh->placement;
  for (size_t v = task * A_TASK; v < task_end(task, d->vertex_count); v++) {
    size_t to = placing->mesh->first_vertex + v;
    float *normal = placing->made->normals[to];
    vec3_store(placing->made->positions[to], affine3_apply(placement, hl_surface_vector(d->positions[v])));
    memset(normal, 0, 3 * sizeof *normal);
    if (d->normals != NULL)
      vec3_store(normal, mat3_apply(placement.linear, hl_surface_vector(d->normals[v])));
  }
}

static void place_triangles(void *data, size_t task, int worker) {
  (void)worker;
  const placing *placing = data;
  const surface_mesh *mesh = placing->mesh;
  const uint32_t(*triangles)[3] = mesh->mesh->description.triangles;
  for (size_t t = task * A_TASK; t < task_end(task, mesh->primitives[PRIMITIVE_triangle].count); t++)
    for (int i = 0; i < 3; i++)
      placing->made->triangles[mesh->primitives[PRIMITIVE_triangle].first + t][i] =
          (uint32_t)mesh->first_vertex + triangles[t][i];
}

static void make_units(void *data, size_t task, int worker) {
  (void)worker;
  const placing *placing = data;
  for (size_t v = task * A_TASK; v < task_end(task, placing->mesh->mesh->description.vertex_count); v++) {
    float *normal = placing->made->normals[placing->mesh->first_vertex + v];
    vec3 unit = vec3_normalise(hl_surface_vector(normal));
    if (!(vec3_length(unit) < 2)) unit = (vec3){0, 0, 0}; /* a normal that is not a number becomes 0 */
    vec3_store(normal, unit);
  }
}

static void place_edge_normals(surfaces *made, const surface_mesh *mesh) {
  for (size_t n = 0; n < mesh->mesh->edge_normal_count; n++)
    vec3_store(
        made->edge_normals[mesh->first_edge_normal + n],
        vec3_normalise(mat3_apply(mesh->placement.linear, hl_surface_vector(mesh->mesh->edge_normals[n]))));
}

void hl_triangle_place(hl_pool *pool, surfaces *made, const surface_mesh *mesh) {
  const hl_mesh_description *d = &mesh->mesh->description;
  placing placing = {made, mesh};
  place_edge_normals(made, mesh);
  hl_pool_run(pool, task_count(d->vertex_count), place_vertices, &placing);
  hl_pool_run(pool, task_count(d->triangle_count), place_triangles, &placing);
  if (d->normals == NULL)
    add_face_normals(made, mesh); /* this runs in one thread, so that the terms of each vertex's sum always
                                   * have the same order */
  hl_pool_run(pool, task_count(d->vertex_count), make_units, &placing);
}
