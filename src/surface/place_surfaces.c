/* surface/place_surfaces.c - see place_surfaces.h. */
#include "surface/place_surfaces.h"

#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "scene/geometry/placement.h"
#include "surface/clusters.h"
#include "surface/late/surface_seams.h"
#include "surface/primitive.h"

/* ---- memory ---- */

static surface_mesh describe(const hl_scene_mesh *mesh, size_t first_vertex, size_t first_edge_normal) {
  const hl_mesh_description *d = &mesh->mesh->description;
  return (surface_mesh){.mesh = mesh->mesh,
                        .placement = hl_scene_mesh_to_world(mesh),
                        .scale = mesh->scale,
                        .colors = d->colors,
                        .face_colors = d->face_colors,
                        .sphere_colors = d->sphere_colors,
                        .edges = (const uint32_t(*)[3])mesh->mesh->edges,
                        .first_vertex = first_vertex,
                        .first_edge_normal = first_edge_normal};
}

/* Gives numbers to the primitives, kind by kind. If the array of meshes is allocated already, stores the
 * numbers of each mesh's primitives in it. */
static uint64_t number_primitives(const hl_scene_description *scene, surfaces *made) {
  uint64_t primitives = 0;
  for (int k = 0; k < PRIMITIVE_KINDS; k++) {
    made->first[k] = (uint32_t)primitives;
    for (size_t m = 0; m < scene->mesh_count; m++) {
      const size_t own = hl_primitive_kinds[k]->count(&scene->meshes[m].mesh->description);
      if (made->meshes != NULL)
        made->meshes[m].primitives[k] = (primitive_range){(uint32_t)primitives, (uint32_t)own};
      primitives += own;
    }
  }
  made->first[PRIMITIVE_KINDS] = (uint32_t)primitives;
  return primitives;
}

/* Counts vertices and primitives. If the array of meshes is allocated already, also describes the meshes in
 * it. */
static hl_status count_primitives(const hl_scene_description *scene, surfaces *made, hl_error *error) {
  made->vertex_count = made->edge_normal_count = 0;
  for (size_t m = 0; m < scene->mesh_count; m++) {
    const hl_mesh *mesh = scene->meshes[m].mesh;
    if (made->meshes != NULL)
      made->meshes[m] = describe(&scene->meshes[m], made->vertex_count, made->edge_normal_count);
    made->vertex_count += mesh->description.vertex_count;
    made->edge_normal_count += mesh->edge_normal_count;
  }
  if (number_primitives(scene, made) > UINT32_MAX || made->vertex_count > UINT32_MAX)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "/meshes: have more than 2^32 vertices, or triangles and spheres, together");
  return HL_OK;
}

/* Lays out the arrays of all meshes in one block of memory. made->meshes is the first array of the block. */
static void lay_out(size_t meshes, surfaces *made, hl_layout *layout) {
  made->meshes = hl_layout_take(layout, meshes, sizeof *made->meshes);
  for (int k = 0; k < PRIMITIVE_KINDS; k++) hl_primitive_kinds[k]->lay_out(made, layout);
}

hl_status hl_surfaces_count_memory(const hl_scene_description *scene, hl_layout *layout, hl_error *error) {
  surfaces planned = {0};
  hl_status status = count_primitives(scene, &planned, error);
  if (status != HL_OK) return status;
  lay_out(scene->mesh_count, &planned, layout);
  hl_clusters_count(scene, layout);
  hl_surface_seams_count(planned.first[PRIMITIVE_triangle + 1], layout);
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
    hl_mesh_retain(made->meshes[m].mesh);
    for (int k = 0; k < PRIMITIVE_KINDS; k++) hl_primitive_kinds[k]->place(pool, made, &made->meshes[m]);
  }
  /* A cancelled pool leaves corners unwritten, and the clusters follow corners to vertices. */
  if (status == HL_OK) status = hl_pool_check(pool, "rendering", error);
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

/* Finds the scene's cuts, and the meshes that the cuts may cut. */
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
