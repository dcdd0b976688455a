/* mesh/mesh.c - hl_mesh: checked arrays of triangles, spheres and lines. */
#include "mesh/mesh.h"

#include <math.h>
#include <string.h>

#include "core/door.h"
#include "core/key.h"
#include "core/memory.h"

void hl_mesh_description_defaults(hl_mesh_description *description) {
  if (description != NULL) *description = (hl_mesh_description){.struct_size = sizeof *description};
}

void hl_mesh_retain(hl_mesh *mesh) {
  if (mesh != NULL) atomic_fetch_add(&mesh->references, 1);
}

void hl_mesh_release(hl_mesh *mesh) {
  if (mesh == NULL || atomic_fetch_sub(&mesh->references, 1) > 1) return;
  const hl_mesh_description *d = &mesh->description;
  const void *const arrays[] = {d->positions,   d->normals,     d->colors,        d->triangles,
                                d->face_colors, d->spheres,     d->sphere_colors, d->line_points,
                                d->line_colors, d->line_lengths};
  for (size_t n = 0; n < sizeof arrays / sizeof *arrays; n++) hl_release(mesh->context, (void *)arrays[n]);
  hl_release(mesh->context, mesh->edges);
  hl_release(mesh->context, mesh->edge_normals);
  hl_release(mesh->context, mesh->insides);
  hl_release(mesh->context, mesh);
}

const hl_mesh_description *hl_mesh_describe(const hl_mesh *mesh) {
  return mesh != NULL ? &mesh->description : NULL;
}

hl_status hl_mesh_get_box(const hl_mesh *mesh, double low[3], double high[3]) {
  HL_DOOR;
  if (mesh == NULL || low == NULL || high == NULL) return HL_ERROR_ARGUMENT;
  memcpy(low, mesh->low, sizeof mesh->low);
  memcpy(high, mesh->high, sizeof mesh->high);
  return HL_OK;
}

static bool is_finite(const float v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

/* Returns whether a triangle has an area, so that the cross product of its edges is not zero. */
static bool has_area(const float a[3], const float b[3], const float c[3]) {
  double p[3], q[3];
  for (int i = 0; i < 3; i++) p[i] = (double)b[i] - a[i], q[i] = (double)c[i] - a[i];
  double x = p[1] * q[2] - p[2] * q[1], y = p[2] * q[0] - p[0] * q[2], z = p[0] * q[1] - p[1] * q[0];
  return x != 0 || y != 0 || z != 0;
}

static void grow_bounds(hl_mesh *mesh, const float at[3], double radius) {
  for (int axis = 0; axis < 3; axis++) {
    mesh->low[axis] = fmin(mesh->low[axis], (double)at[axis] - radius);
    mesh->high[axis] = fmax(mesh->high[axis], (double)at[axis] + radius);
  }
}

/* Keeps only the triangles that can be seen. The mesh owns its arrays, so this function may change them. */
static hl_status keep_triangles(hl_mesh *mesh, hl_error *error) {
  hl_mesh_description *d = &mesh->description;
  uint32_t(*triangles)[3] = (uint32_t(*)[3])d->triangles;
  float(*face_colors)[4] = (float(*)[4])d->face_colors;
  size_t kept = 0;
  for (size_t t = 0; t < d->triangle_count; t++) {
    const float *corner[3];
    for (int i = 0; i < 3; i++) {
      if (triangles[t][i] >= d->vertex_count)
        return hl_fail(error, HL_ERROR_INPUT,
                       "triangle %zu names vertex %u: the mesh has %zu vertices, counted from 0", t,
                       (unsigned)triangles[t][i], d->vertex_count);
      corner[i] = d->positions[triangles[t][i]];
    }
    if (t == mesh->given_triangles) mesh->given_triangles = kept;
    if (!is_finite(corner[0]) || !is_finite(corner[1]) || !is_finite(corner[2])) continue;
    if (!has_area(corner[0], corner[1], corner[2])) continue;
    if (face_colors != NULL) memmove(face_colors[kept], face_colors[t], sizeof *face_colors);
    memmove(triangles[kept++], triangles[t], sizeof triangles[t]);
    for (int i = 0; i < 3; i++) grow_bounds(mesh, corner[i], 0);
  }
  if (mesh->given_triangles > kept) mesh->given_triangles = kept;
  d->triangle_count = kept;
  return HL_OK;
}

/* Keeps only the spheres whose place is finite and whose radius is above 0. */
static void keep_spheres(hl_mesh *mesh) {
  hl_mesh_description *d = &mesh->description;
  float(*spheres)[4] = (float(*)[4])d->spheres, (*colors)[4] = (float(*)[4])d->sphere_colors;
  size_t kept = 0;
  for (size_t n = 0; n < d->sphere_count; n++) {
    if (!is_finite(spheres[n]) || !isfinite(spheres[n][3]) || !(spheres[n][3] > 0)) continue;
    if (colors != NULL) memmove(colors[kept], colors[n], sizeof *colors);
    memmove(spheres[kept], spheres[n], sizeof *spheres);
    grow_bounds(mesh, spheres[kept], (double)spheres[kept][3]);
    kept++;
  }
  d->sphere_count = kept;
}

/* Keeps only the elements that can be seen, and finds their bounds. */
static hl_status keep_visible(hl_mesh *mesh, hl_error *error) {
  for (int axis = 0; axis < 3; axis++) mesh->low[axis] = INFINITY, mesh->high[axis] = -INFINITY;
  hl_status status = keep_triangles(mesh, error);
  if (status != HL_OK) return status;
  keep_spheres(mesh);
  if (mesh->description.triangle_count > 0 || mesh->description.sphere_count > 0) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT,
                 "the mesh has no triangle with an area, no sphere and no line: give at least one");
}

/* The hash of the edge from vertex a to vertex b, where a is less than b. */
static uint64_t hash_of_edge(uint32_t a, uint32_t b) {
  /* the hash function splitmix64 (Steele et al. 2014) */
  uint64_t hash = ((uint64_t)a << 32 | b) + 0x9e3779b97f4a7c15u;
  hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9u;
  hash = (hash ^ hash >> 27) * 0x94d049bb133111ebu;
  return hash ^ hash >> 31;
}

uint64_t hl_hash_of_way(uint32_t a, uint32_t b) { return a < b ? hash_of_edge(a, b) : -hash_of_edge(b, a); }

/* Whether all colours of an array have an opacity of 1. The result is true if `colors` is null. */
static bool are_opaque(const float (*colors)[4], size_t count) {
  for (size_t n = 0; colors != NULL && n < count; n++)
    if (!(colors[n][3] >= 1)) return false;
  return true;
}

static uint64_t mark_of(const hl_mesh_description *d) {
  const uint64_t marks[] = {
      hl_key_mark(d->positions, d->vertex_count * sizeof *d->positions),
      hl_key_mark(d->triangles, d->triangle_count * sizeof *d->triangles),
      hl_key_mark(d->spheres, d->sphere_count * sizeof *d->spheres),
      hl_key_mark(d->colors, d->colors == NULL ? 0 : d->vertex_count * sizeof *d->colors),
      hl_key_mark(d->face_colors, d->face_colors == NULL ? 0 : d->triangle_count * sizeof *d->face_colors),
      hl_key_mark(d->sphere_colors,
                  d->sphere_colors == NULL ? 0 : d->sphere_count * sizeof *d->sphere_colors)};
  return hl_key_mark(marks, sizeof marks);
}

hl_status hl_mesh_of_parts(mesh_parts *parts, hl_mesh **mesh, hl_error *error) {
  size_t vertices = parts->vertex_count, triangles = parts->triangle_count;
  hl_status status = hl_mesh_add_tubes(parts, error);
  if (status != HL_OK) return status;
  hl_mesh *made = hl_allocate_zeroed(parts->context, 1, sizeof *made);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "a mesh");
  made->context = parts->context;
  made->given_vertices = vertices;
  made->given_triangles = triangles;
  made->description = hl_mesh_parts_describe(parts);
  atomic_init(&made->references, 1);
  hl_release(parts->context, parts->polygons);
  *parts = (mesh_parts){.context = parts->context, .path = parts->path};
  status = keep_visible(made, error);
  if (status == HL_OK) status = hl_mesh_find_edges(made, error);
  if (status == HL_OK) status = hl_mesh_find_insides(made, error);
  if (status == HL_OK) {
    const hl_mesh_description *d = &made->description;
    made->opaque = are_opaque(d->colors, d->vertex_count) && are_opaque(d->face_colors, d->triangle_count);
    made->mark = mark_of(d);
    *mesh = made;
  } else {
    hl_mesh_release(made);
  }
  return status;
}

/* ---- from memory ---- */

static hl_status check_arrays(const hl_mesh_description *d, hl_error *error) {
  if (d->struct_size != sizeof *d)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_mesh_create: struct_size is %zu, not %zu: call hl_mesh_description_defaults() first",
                   d->struct_size, sizeof *d);
  bool nothing = d->positions == NULL && d->spheres == NULL && d->line_points == NULL;
  if (nothing || (d->positions == NULL && d->vertex_count > 0) ||
      (d->triangles == NULL && d->triangle_count > 0) || (d->positions != NULL && d->triangles == NULL) ||
      (d->spheres == NULL && d->sphere_count > 0) || (d->line_points == NULL && d->line_point_count > 0) ||
      (d->line_lengths == NULL && d->line_count > 0))
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_mesh_create: positions or triangles are null, or an array that has a count");
  if (d->vertex_count > UINT32_MAX || d->triangle_count > HL_LIMIT_TRIANGLES)
    return hl_fail(error, HL_ERROR_INPUT, "the mesh has %zu vertices and %zu triangles: at most %u and %d",
                   d->vertex_count, d->triangle_count, UINT32_MAX, HL_LIMIT_TRIANGLES);
  if (d->sphere_count > HL_LIMIT_SPHERES || d->line_point_count > HL_LIMIT_LINE_POINTS)
    return hl_fail(error, HL_ERROR_INPUT,
                   "the mesh has %zu spheres and %zu points of lines: at most %d and %d", d->sphere_count,
                   d->line_point_count, HL_LIMIT_SPHERES, HL_LIMIT_LINE_POINTS);
  size_t left = d->line_point_count;
  for (size_t n = 0; n < d->line_count; n++) {
    if (d->line_lengths[n] > left) left = SIZE_MAX;
    if (left == SIZE_MAX) break;
    left -= d->line_lengths[n];
  }
  return left == 0 ? HL_OK
                   : hl_fail(error, HL_ERROR_INPUT, "the lines' lengths do not sum to their %zu points",
                             d->line_point_count);
}

/* Copies an array. Returns true for a null array, which needs no copy. */
static bool copy_array(hl_context *context, const void *from, size_t count, size_t size, void *to) {
  if (from == NULL) return true;
  void *copy = hl_allocate(context, count, size);
  if (copy == NULL) return false;
  memcpy(to, &copy, sizeof copy);
  if (count > 0) memcpy(copy, from, count * size);
  return true;
}

static bool copy_arrays(const hl_mesh_description *d, mesh_parts *parts) {
  hl_context *context = parts->context;
  parts->vertex_count = parts->vertex_room = d->vertex_count;
  parts->triangle_count = parts->triangle_room = d->triangle_count;
  parts->sphere_count = d->sphere_count;
  parts->line_point_count = d->line_point_count;
  parts->line_count = d->line_count;
  return copy_array(context, d->positions, d->vertex_count, sizeof *d->positions, &parts->positions) &&
         copy_array(context, d->normals, d->vertex_count, sizeof *d->normals, &parts->normals) &&
         copy_array(context, d->colors, d->vertex_count, sizeof *d->colors, &parts->colors) &&
         copy_array(context, d->triangles, d->triangle_count, sizeof *d->triangles, &parts->triangles) &&
         copy_array(context, d->face_colors, d->triangle_count, sizeof *d->face_colors,
                    &parts->face_colors) &&
         copy_array(context, d->spheres, d->sphere_count, sizeof *d->spheres, &parts->spheres) &&
         copy_array(context, d->sphere_colors, d->sphere_count, sizeof *d->sphere_colors,
                    &parts->sphere_colors) &&
         copy_array(context, d->line_points, d->line_point_count, sizeof *d->line_points,
                    &parts->line_points) &&
         copy_array(context, d->line_colors, d->line_point_count, sizeof *d->line_colors,
                    &parts->line_colors) &&
         copy_array(context, d->line_lengths, d->line_count, sizeof *d->line_lengths, &parts->line_lengths);
}

hl_status hl_mesh_create(hl_context *context, const hl_mesh_description *description, hl_mesh **mesh,
                         hl_error *error) {
  HL_DOOR;
  if (context == NULL || description == NULL || mesh == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_mesh_create: null context, description or mesh");
  *mesh = NULL;
  hl_status status = check_arrays(description, error);
  if (status != HL_OK) return status;
  mesh_parts parts = {.context = context, .path = "a mesh"};
  if (copy_arrays(description, &parts)) status = hl_mesh_of_parts(&parts, mesh, error);
  else status = hl_fail_memory(error, description->vertex_count * sizeof *parts.positions, "a mesh");
  hl_mesh_parts_release(&parts);
  return status;
}
