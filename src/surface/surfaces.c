/* surface/surfaces.c - brings meshes to frame space, and finds the normals of their vertices. */
#include "surface/surfaces.h"

#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "scene/placement.h"

uint64_t hl_surfaces_bytes(const hl_scene_description *scene) {
  uint64_t bytes = scene->mesh_count * sizeof(surface_mesh);
  for (size_t m = 0; m < scene->mesh_count; m++) {
    const hl_mesh_description *d = &scene->meshes[m].mesh->description;
    bytes += d->vertex_count * 2 * sizeof(float[3]) + d->triangle_count * sizeof(uint32_t[3]) +
             d->sphere_count * sizeof(float[4]);
  }
  return bytes;
}

/* Adds to each corner's normal the triangle's cross product, whose length is twice its area: large faces
 * count more. */
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

static void place_spheres(surfaces *made, const surface_mesh *mesh, affine3 placement) {
  const hl_mesh_description *d = &mesh->scene->mesh->description;
  for (size_t n = 0; n < d->sphere_count; n++) {
    float *sphere = made->spheres[mesh->first_sphere + n];
    vec3_store(sphere, affine3_apply(placement, hl_surface_vector(d->spheres[n])));
    sphere[3] = (float)(d->spheres[n][3] * mesh->scene->scale);
  }
}

static void place_mesh(surfaces *made, const surface_mesh *mesh) {
  const hl_mesh_description *d = &mesh->scene->mesh->description;
  affine3 placement = hl_scene_mesh_to_world(mesh->scene);
  place_spheres(made, mesh, placement);
  for (size_t v = 0; v < d->vertex_count; v++) {
    float *position = made->positions[mesh->first_vertex + v],
          *normal = made->normals[mesh->first_vertex + v];
    vec3_store(position, affine3_apply(placement, hl_surface_vector(d->positions[v])));
    memset(normal, 0, 3 * sizeof *normal);
    if (d->normals != NULL)
      vec3_store(normal, mat3_apply(placement.linear, hl_surface_vector(d->normals[v])));
  }
  for (uint32_t t = 0; t < mesh->triangle_count; t++)
    for (int i = 0; i < 3; i++)
      made->triangles[mesh->first_triangle + t][i] = (uint32_t)mesh->first_vertex + d->triangles[t][i];
  if (d->normals == NULL) add_face_normals(made, mesh);
  for (size_t v = 0; v < d->vertex_count; v++) {
    float *normal = made->normals[mesh->first_vertex + v];
    vec3 unit = vec3_normalise(hl_surface_vector(normal));
    if (!(vec3_length(unit) < 2)) unit = (vec3){0, 0, 0}; /* not a number */
    vec3_store(normal, unit);
  }
}

static hl_status count_primitives(const hl_scene_description *scene, surfaces *made, hl_error *error) {
  uint64_t vertices = 0, triangles = 0, spheres = 0;
  for (size_t m = 0; m < scene->mesh_count; m++) {
    const hl_mesh_description *d = &scene->meshes[m].mesh->description;
    made->meshes[m] = (surface_mesh){.scene = &scene->meshes[m],
                                     .colors = d->colors,
                                     .face_colors = d->face_colors,
                                     .sphere_colors = d->sphere_colors,
                                     .first_vertex = vertices,
                                     .first_triangle = (uint32_t)triangles,
                                     .triangle_count = (uint32_t)d->triangle_count,
                                     .first_sphere = (uint32_t)spheres,
                                     .sphere_count = (uint32_t)d->sphere_count};
    vertices += d->vertex_count;
    triangles += d->triangle_count;
    spheres += d->sphere_count;
    if (vertices > UINT32_MAX || triangles + spheres > UINT32_MAX)
      return hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "/meshes: have more than 2^32 vertices, or triangles and spheres, together");
  }
  made->mesh_count = scene->mesh_count;
  made->vertex_count = vertices;
  made->triangle_count = (uint32_t)triangles;
  made->sphere_count = (uint32_t)spheres;
  return HL_OK;
}

hl_status hl_surfaces_create(hl_context *context, const hl_scene_description *scene, surfaces *made,
                             hl_error *error) {
  *made = (surfaces){.meshes = hl_allocate(context, scene->mesh_count, sizeof *made->meshes)};
  hl_status status = made->meshes != NULL ? count_primitives(scene, made, error)
                                          : hl_fail_memory(error, sizeof *made->meshes, "the meshes");
  if (status == HL_OK) {
    made->positions = hl_allocate(context, made->vertex_count, sizeof *made->positions);
    made->normals = hl_allocate(context, made->vertex_count, sizeof *made->normals);
    made->triangles = hl_allocate(context, made->triangle_count, sizeof *made->triangles);
    made->spheres = hl_allocate(context, made->sphere_count, sizeof *made->spheres);
    if (made->positions == NULL || made->normals == NULL || made->triangles == NULL || made->spheres == NULL)
      status = hl_fail_memory(error, hl_surfaces_bytes(scene), "the meshes");
  }
  for (size_t m = 0; status == HL_OK && m < made->mesh_count; m++) place_mesh(made, &made->meshes[m]);
  if (status != HL_OK) hl_surfaces_release(context, made);
  return status;
}

void hl_surfaces_release(hl_context *context, surfaces *made) {
  hl_release(context, made->meshes);
  hl_release(context, made->positions);
  hl_release(context, made->normals);
  hl_release(context, made->triangles);
  hl_release(context, made->spheres);
  *made = (surfaces){0};
}

size_t hl_surface_mesh_of(const surfaces *all, uint32_t primitive) {
  size_t low = 0, high = all->mesh_count;
  bool sphere = primitive >= all->triangle_count;
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    const surface_mesh *mesh = &all->meshes[middle];
    uint32_t first = sphere ? all->triangle_count + mesh->first_sphere : mesh->first_triangle;
    if (first <= primitive) low = middle;
    else high = middle;
  }
  return low;
}

uint32_t hl_surface_mesh_end(const surfaces *all, size_t mesh, uint32_t primitive) {
  const surface_mesh *own = &all->meshes[mesh];
  return primitive < all->triangle_count ? own->first_triangle + own->triangle_count
                                         : all->triangle_count + own->first_sphere + own->sphere_count;
}

void hl_surface_corners(const hl_scene_mesh *mesh, double least, vec3 corners[8]) {
  affine3 placement = hl_scene_mesh_to_world(mesh);
  const hl_mesh *triangles = mesh->mesh;
  double low[3], high[3];
  for (int axis = 0; axis < 3; axis++) {
    double middle = (triangles->low[axis] + triangles->high[axis]) / 2;
    double half = fmax((triangles->high[axis] - triangles->low[axis]) / 2, least / 2 / mesh->scale);
    low[axis] = middle - half;
    high[axis] = middle + half;
  }
  for (int corner = 0; corner < 8; corner++)
    corners[corner] = affine3_apply(
        placement,
        (vec3){corner & 1 ? high[0] : low[0], corner & 2 ? high[1] : low[1], corner & 4 ? high[2] : low[2]});
}
