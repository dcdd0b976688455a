/* isosurface/isosurface.c - makes an isosurface (isosurface.h) in these steps: the cells of a lattice are cut
 * into triangles; edges of triangles are halved where the surface bends; the triangles are cut at the
 * volume's box and at cuts; caps are added at the faces of the box and of cuts; vertices may get colours; all
 * triangles are moved to the world. */
#include "isosurface/isosurface.h"

#include <string.h>

#include "core/memory.h"
#include "isosurface/caps.h"
#include "isosurface/clip.h"
#include "isosurface/triangles.h"

/* Maps the grid's index space to the world of the volume's file, scaled by axis_scale. */
static affine3 placement_of(const hl_scene_volume *volume, const grid *grid) {
  affine3 placement = volume->volume->index_to_world;
  placement.offset = vec3_subtract(placement.offset, mat3_apply(placement.linear, vec3_of(grid->shift)));
  vec3 *row = placement.linear.row;
  for (int a = 0; a < 3; a++) row[a] = vec3_scale(row[a], volume->axis_scale[a]);
  placement.offset = (vec3){placement.offset.x * volume->axis_scale[0],
                            placement.offset.y * volume->axis_scale[1],
                            placement.offset.z * volume->axis_scale[2]};
  return placement;
}

typedef struct move_job {
  affine3 placement;
  mat3 normals; /* the inverse transpose of the placement */
  iso_triangles *made;
} move_job;

enum { RUN_VERTICES = 4096 };

static void move_vertices(void *data, size_t index, int worker) {
  (void)worker;
  const move_job *job = data;
  iso_triangles *made = job->made;
  for (size_t v = index * RUN_VERTICES; v < (index + 1) * RUN_VERTICES && v < made->vertex_count; v++) {
    float *p = made->positions[v], *n = made->normals[v];
    vec3_store(p, affine3_apply(job->placement, (vec3){p[0], p[1], p[2]}));
    vec3_store(n, vec3_normalise(mat3_apply(job->normals, (vec3){n[0], n[1], n[2]})));
  }
}

/* Moves the triangles to the world. If the map mirrors, it also reverses the order of each triangle's
 * corners. */
static hl_status place(hl_pool *pool, const hl_scene_volume *volume, const grid *grid, iso_triangles *made,
                       hl_error *error) {
  move_job job = {.placement = placement_of(volume, grid), .made = made};
  mat3 inverse, m = job.placement.linear;
  if (!mat3_invert(m, &inverse)) return HL_OK; /* such a map was refused when the scene was checked */
  job.normals = mat3_transpose(inverse);
  const size_t runs = (made->vertex_count + RUN_VERTICES - 1) / RUN_VERTICES;
  hl_status status = hl_lattice_run(pool, runs, move_vertices, &job, error);
  if (status != HL_OK || vec3_dot(m.row[0], vec3_cross(m.row[1], m.row[2])) > 0) return status;
  for (size_t t = 0; t < made->triangle_count; t++) {
    uint32_t *corner = made->triangles[t], kept = corner[0];
    corner[0] = corner[1], corner[1] = kept;
  }
  return HL_OK;
}

/* Makes the mesh. colors: owned by the mesh, also after a failure. */
static hl_status mesh_of(hl_context *context, iso_triangles *made, float (*colors)[4], hl_mesh **mesh,
                         hl_error *error) {
  mesh_parts parts = {.context = context,
                      .path = "an isosurface",
                      .positions = made->positions,
                      .normals = made->normals,
                      .colors = colors,
                      .triangles = made->triangles,
                      .vertex_count = made->vertex_count,
                      .triangle_count = made->triangle_count};
  *made = (iso_triangles){0};
  hl_status status = hl_mesh_of_parts(&parts, mesh, error);
  hl_mesh_parts_release(&parts);
  return status;
}

hl_status hl_isosurface_create(hl_pool *pool, const hl_scene_volume *volume, const grid *grid,
                               const kernel *kernel, double value, const iso_coloring *coloring,
                               hl_mesh **mesh, hl_error *error) {
  hl_context *context = volume->volume->context;
  lattice lattice;
  iso_triangles made = {0};
  *mesh = NULL;
  hl_status status = hl_lattice_create(context, pool, grid, kernel, value, &lattice, error);
  if (status == HL_OK) status = hl_iso_extract(pool, &lattice, &made, error);
  if (status == HL_OK) status = hl_iso_refine(pool, &lattice, &made, error);
  if (status == HL_OK) status = hl_iso_clip_box(context, &made, grid->box_low, grid->box_high, error);
  if (status == HL_OK) status = hl_iso_cut(context, &made, grid->cuts, grid->cut_count, error);
  if (status == HL_OK) status = hl_iso_cap(pool, &lattice, &made, error);
  hl_lattice_release(&lattice);
  if (status == HL_OK && made.triangle_count > 0) {
    float(*colors)[4] = NULL;
    if (coloring != NULL) status = hl_iso_color_vertices(pool, volume, grid, coloring, &made, &colors, error);
    if (status == HL_OK) status = place(pool, volume, grid, &made, error);
    if (status != HL_OK) hl_release(context, colors);
    if (status == HL_OK) status = mesh_of(context, &made, colors, mesh, error);
    if (status == HL_OK) (*mesh)->is_cut = true;
    if (status == HL_OK && hl_iso_capped_faces(grid) == ISO_ALL_CAPPED) hl_mesh_take_as_closed(*mesh);
  }
  hl_iso_triangles_release(context, &made);
  return status;
}

hl_scene_mesh hl_scene_mesh_of_iso(const hl_scene_volume *volume, size_t i, hl_mesh *mesh) {
  hl_scene_mesh made;
  hl_scene_mesh_defaults(&made);
  made.mesh = mesh;
  made.scale = volume->scale;
  memcpy(made.rotate_axis, volume->rotate_axis, sizeof made.rotate_axis);
  made.rotate_angle_deg = volume->rotate_angle_deg;
  memcpy(made.translate, volume->translate, sizeof made.translate);
  for (int c = 0; c < 3; c++) /* the vertices have the colours of a second volume */
    made.color[c] = hl_iso_has_second_color(volume, i) ? 1 : volume->iso[i].color[c];
  made.opacity = volume->iso[i].opacity;
  made.material = volume->material;
  if (volume->shading == HL_SHADING_FLAT) made.material = (hl_material){.emission = 1};
  made.visible = volume->visible;
  made.casts_shadow = volume->casts_shadow;
  made.receives_shadow = volume->receives_shadow && volume->shading != HL_SHADING_FLAT;
  return made;
}
