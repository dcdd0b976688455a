/* surface/place_surfaces.c - see place_surfaces.h. */
#include "surface/place_surfaces.h"

#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "scene/geometry/placement.h"
#include "surface/clusters.h"
#include "surface/late/surface_seams.h"

/* Adds to each corner's normal the triangle's cross product. Its length is twice the triangle's area, so
 * large faces count more. */
static void add_face_normals(surfaces *made, const surface_mesh *mesh) {
  for (uint32_t t = mesh->first_triangle; t < mesh->first_triangle + mesh->triangle_count; t++) {
    const uint32_t *corner = made->triangles[t];
    vec3 a = hl_surface_vector(made->positions[corner[0]]);
    vec3 cross = vec3_cross(vec3_subtract(hl_surface_vector(made->positions[corner[1]]), a),
                            vec3_subtract(hl_surface_vector(made->positions[corner[2]]), a));
    for (int i = 0; i < 3; i++)
      vec3_store(made->normals[corner[i]], vec3_add(hl_surface_vector(made->normals[corner[i]]), cross));
  }
}

static void place_spheres(surfaces *made, const surface_mesh *mesh) {
  const hl_mesh_description *d = &mesh->mesh->description;
  for (size_t n = 0; n < d->sphere_count; n++) {
    float *sphere = made->spheres[mesh->first_sphere + n];
    vec3_store(sphere, affine3_apply(mesh->placement, hl_surface_vector(d->spheres[n])));
    sphere[3] = (float)(d->spheres[n][3] * mesh->scale);
  }
}

/* A mesh that is being placed. A task places A_TASK vertices or triangles. */
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
  for (size_t t = task * A_TASK; t < task_end(task, mesh->triangle_count); t++)
    for (int i = 0; i < 3; i++)
      placing->made->triangles[mesh->first_triangle + t][i] = (uint32_t)mesh->first_vertex + triangles[t][i];
}

static void make_units(void *data, size_t task, int worker) {
  (void)worker;
  const placing *placing = data;
  for (size_t v = task * A_TASK; v < task_end(task, placing->mesh->mesh->description.vertex_count); v++) {
    float *normal = placing->made->normals[placing->mesh->first_vertex + v];
    vec3 unit = vec3_normalise(hl_surface_vector(normal));
    if (!(vec3_length(unit) < 2)) unit = (vec3){0, 0, 0}; /* the normal is not a number */
    vec3_store(normal, unit);
  }
}

static void place_edge_normals(surfaces *made, const surface_mesh *mesh) {
  for (size_t n = 0; n < mesh->mesh->edge_normal_count; n++)
    vec3_store(
        made->edge_normals[mesh->first_edge_normal + n],
        vec3_normalise(mat3_apply(mesh->placement.linear, hl_surface_vector(mesh->mesh->edge_normals[n]))));
}

static void place_mesh(hl_pool *pool, surfaces *made, const surface_mesh *mesh) {
  const hl_mesh_description *d = &mesh->mesh->description;
  placing placing = {made, mesh};
  place_spheres(made, mesh);
  place_edge_normals(made, mesh);
  hl_pool_run(pool, task_count(d->vertex_count), place_vertices, &placing);
  hl_pool_run(pool, task_count(d->triangle_count), place_triangles, &placing);
  if (d->normals == NULL)
    add_face_normals(made, mesh); /* this runs in one thread, so that each vertex's sum has one order */
  hl_pool_run(pool, task_count(d->vertex_count), make_units, &placing);
}

/* ---- memory ---- */

/* Counts the primitives. If the array of meshes is allocated already, the meshes are described, too. */
static hl_status count_primitives(const hl_scene_description *scene, surfaces *made, hl_error *error) {
  uint64_t vertices = 0, triangles = 0, spheres = 0, edge_normals = 0;
  for (size_t m = 0; m < scene->mesh_count; m++) {
    const hl_mesh_description *d = &scene->meshes[m].mesh->description;
    if (made->meshes != NULL)
      made->meshes[m] = (surface_mesh){.placement = hl_scene_mesh_to_world(&scene->meshes[m]),
                                       .scale = scene->meshes[m].scale,
                                       .colors = d->colors,
                                       .face_colors = d->face_colors,
                                       .sphere_colors = d->sphere_colors,
                                       .edges = (const uint32_t(*)[3])scene->meshes[m].mesh->edges,
                                       .first_vertex = vertices,
                                       .first_edge_normal = edge_normals,
                                       .first_triangle = (uint32_t)triangles,
                                       .triangle_count = (uint32_t)d->triangle_count,
                                       .first_sphere = (uint32_t)spheres,
                                       .sphere_count = (uint32_t)d->sphere_count};
    vertices += d->vertex_count;
    edge_normals += scene->meshes[m].mesh->edge_normal_count;
    triangles += d->triangle_count;
    spheres += d->sphere_count;
    if (vertices > UINT32_MAX || triangles + spheres > UINT32_MAX)
      return hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "/meshes: have more than 2^32 vertices, or triangles and spheres, together");
  }
  made->vertex_count = vertices;
  made->edge_normal_count = edge_normals;
  made->triangle_count = (uint32_t)triangles;
  made->sphere_count = (uint32_t)spheres;
  return HL_OK;
}

/* The meshes begin the block. */
static void lay_out(size_t meshes, surfaces *made, hl_layout *layout) {
  made->meshes = hl_layout_take(layout, meshes, sizeof *made->meshes);
  made->positions = hl_layout_take(layout, made->vertex_count, sizeof *made->positions);
  made->normals = hl_layout_take(layout, made->vertex_count, sizeof *made->normals);
  made->edge_normals = hl_layout_take(layout, made->edge_normal_count, sizeof *made->edge_normals);
  made->triangles = hl_layout_take(layout, made->triangle_count, sizeof *made->triangles);
  made->spheres = hl_layout_take(layout, made->sphere_count, sizeof *made->spheres);
}

hl_status hl_surfaces_count_memory(const hl_scene_description *scene, hl_layout *layout, hl_error *error) {
  surfaces planned = {0};
  hl_status status = count_primitives(scene, &planned, error);
  if (status != HL_OK) return status;
  lay_out(scene->mesh_count, &planned, layout);
  hl_clusters_count(scene, layout);
  hl_surface_seams_count(planned.triangle_count, layout);
  return HL_OK;
}

/* ---- all meshes ---- */

static hl_status allocate(hl_context *context, const hl_scene_description *scene, surfaces *made,
                          hl_error *error) {
  hl_layout layout = {0};
  *made = (surfaces){0};
  hl_status status = count_primitives(scene, made, error);
  if (status != HL_OK) return status;
  while (hl_layout_pass(&layout, context)) lay_out(scene->mesh_count, made, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the meshes");
  made->mesh_count = scene->mesh_count;
  return count_primitives(scene, made, error);
}

static hl_status create(hl_context *context, hl_pool *pool, const hl_scene_description *scene, surfaces *made,
                        hl_error *error) {
  hl_status status = allocate(context, scene, made, error);
  for (size_t m = 0; status == HL_OK && m < made->mesh_count; m++) {
    made->meshes[m].mesh = scene->meshes[m].mesh;
    hl_mesh_retain(made->meshes[m].mesh);
    place_mesh(pool, made, &made->meshes[m]);
  }
  if (status == HL_OK) status = hl_clusters_create(context, pool, made, error);
  if (status == HL_OK) status = hl_surface_seams_create(context, made, error);
  if (status == HL_OK) status = hl_pool_check(pool, "rendering", error);
  if (status != HL_OK) hl_surfaces_release(context, made);
  return status;
}

bool hl_surfaces_current(const surfaces *kept, const hl_scene_description *scene) {
  if (kept->mesh_count != scene->mesh_count) return false;
  for (size_t m = 0; m < kept->mesh_count; m++) {
    affine3 placement = hl_scene_mesh_to_world(&scene->meshes[m]);
    if (kept->meshes[m].mesh != scene->meshes[m].mesh ||
        memcmp(&kept->meshes[m].placement, &placement, sizeof placement) != 0)
      return false;
  }
  return true;
}

/* Finds the scene's cuts, and the meshes of which they may remove parts. */
static hl_status update_cuts(hl_context *context, const hl_scene_description *scene, surfaces *kept,
                             hl_error *error) {
  hl_release(context, kept->cuts);
  kept->cut_count = 0;
  kept->cuts = hl_allocate(context, scene->cut_count, sizeof *kept->cuts);
  if (kept->cuts == NULL) return hl_fail_memory(error, scene->cut_count * sizeof *kept->cuts, "cuts");
  for (size_t i = 0; i < scene->cut_count; i++)
    kept->cuts[kept->cut_count++] = hl_cut_shape_in_world(&scene->cuts[i]);
  for (size_t m = 0; m < kept->mesh_count; m++) {
    vec3 corner[8];
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    hl_surface_corners(&kept->meshes[m], 0, corner);
    for (int i = 0; i < 8; i++) vec3_bound(corner[i], low, high);
    kept->meshes[m].is_cut = scene->meshes[m].cut && !scene->meshes[m].mesh->is_cut && kept->cut_count > 0 &&
                             !hl_cuts_leave_box(kept->cuts, kept->cut_count, low, high);
  }
  return HL_OK;
}

hl_status hl_surfaces_update(hl_context *context, hl_pool *pool, const hl_scene_description *scene,
                             surfaces *kept, hl_error *error) {
  hl_status status = HL_OK;
  if (!hl_surfaces_current(kept, scene)) {
    hl_surfaces_release(context, kept);
    if (scene->mesh_count > 0) status = create(context, pool, scene, kept, error);
  }
  for (size_t m = 0; m < kept->mesh_count; m++) kept->meshes[m].look = hl_surface_look(&scene->meshes[m]);
  return status == HL_OK && kept->mesh_count > 0 ? update_cuts(context, scene, kept, error) : status;
}

void hl_surfaces_release(hl_context *context, surfaces *kept) {
  for (size_t m = 0; m < kept->mesh_count; m++) hl_mesh_release(kept->meshes[m].mesh);
  hl_release(context, kept->meshes);
  hl_clusters_release(context, kept);
  hl_surface_seams_release(context, kept);
  hl_release(context, kept->cuts);
  *kept = (surfaces){0};
}
