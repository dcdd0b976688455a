/* mesh/mesh.c - hl_mesh: checked arrays of vertices and triangles, and arrays that grow while a file is
 * read. */
#include "mesh/mesh.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"

void hl_mesh_description_defaults(hl_mesh_description *description) {
  if (description != NULL) *description = (hl_mesh_description){.struct_size = sizeof *description};
}

void hl_mesh_retain(hl_mesh *mesh) {
  if (mesh != NULL) atomic_fetch_add(&mesh->references, 1);
}

void hl_mesh_release(hl_mesh *mesh) {
  if (mesh == NULL || atomic_fetch_sub(&mesh->references, 1) > 1) return;
  hl_context *context = mesh->context;
  hl_release(context, (void *)mesh->description.positions);
  hl_release(context, (void *)mesh->description.normals);
  hl_release(context, (void *)mesh->description.colors);
  hl_release(context, (void *)mesh->description.triangles);
  hl_release(context, mesh);
}

const hl_mesh_description *hl_mesh_describe(const hl_mesh *mesh) {
  return mesh != NULL ? &mesh->description : NULL;
}

hl_status hl_mesh_get_box(const hl_mesh *mesh, double low[3], double high[3]) {
  if (mesh == NULL || low == NULL || high == NULL) return HL_ERROR_ARGUMENT;
  memcpy(low, mesh->low, sizeof mesh->low);
  memcpy(high, mesh->high, sizeof mesh->high);
  return HL_OK;
}

static bool is_finite(const float v[3]) { return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]); }

/* Whether a triangle has an area: its edges' cross product is not zero. */
static bool has_area(const float a[3], const float b[3], const float c[3]) {
  double p[3], q[3];
  for (int i = 0; i < 3; i++) p[i] = (double)b[i] - a[i], q[i] = (double)c[i] - a[i];
  double x = p[1] * q[2] - p[2] * q[1], y = p[2] * q[0] - p[0] * q[2], z = p[0] * q[1] - p[1] * q[0];
  return x != 0 || y != 0 || z != 0;
}

/* Keeps the triangles that can be seen, and finds the bounds of their vertices. Opens *mesh's arrays to
 * writing: they are its own. */
static hl_status keep_triangles(hl_mesh *mesh, hl_error *error) {
  hl_mesh_description *d = &mesh->description;
  uint32_t(*triangles)[3] = (uint32_t(*)[3])d->triangles;
  size_t kept = 0;
  for (int axis = 0; axis < 3; axis++) mesh->low[axis] = INFINITY, mesh->high[axis] = -INFINITY;
  for (size_t t = 0; t < d->triangle_count; t++) {
    const float *corner[3];
    for (int i = 0; i < 3; i++) {
      if (triangles[t][i] >= d->vertex_count)
        return hl_fail(error, HL_ERROR_INPUT,
                       "triangle %zu names vertex %u: the mesh has %zu vertices, counted from 0", t,
                       (unsigned)triangles[t][i], d->vertex_count);
      corner[i] = d->positions[triangles[t][i]];
    }
    if (!is_finite(corner[0]) || !is_finite(corner[1]) || !is_finite(corner[2])) continue;
    if (!has_area(corner[0], corner[1], corner[2])) continue;
    memmove(triangles[kept++], triangles[t], sizeof triangles[t]);
    for (int i = 0; i < 9; i++) {
      double at = corner[i / 3][i % 3];
      mesh->low[i % 3] = fmin(mesh->low[i % 3], at);
      mesh->high[i % 3] = fmax(mesh->high[i % 3], at);
    }
  }
  d->triangle_count = kept;
  if (kept > 0) return HL_OK;
  return hl_fail(error, HL_ERROR_INPUT, "the mesh has no triangle with an area: give at least one");
}

static uint64_t hash_of_edge(uint32_t a, uint32_t b) {
  uint64_t hash = ((uint64_t)a << 32 | b) + 0x9e3779b97f4a7c15u; /* splitmix64 (Steele et al. 2014) */
  hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9u;
  hash = (hash ^ hash >> 27) * 0x94d049bb133111ebu;
  return hash ^ hash >> 31;
}

/* Whether each edge runs as often one way as the other, with the volume that the triangles enclose above 0
 * (derived: hashes of edges one way are added, the other way subtracted; another sum than 0 means an open
 * edge, and 0 by chance has the probability 2^-64). */
static bool is_closed(const hl_mesh_description *d) {
  uint64_t sum = 0;
  double volume = 0;
  for (size_t t = 0; t < d->triangle_count; t++) {
    const uint32_t *corner = d->triangles[t];
    for (int i = 0; i < 3; i++) {
      uint32_t a = corner[i], b = corner[(i + 1) % 3];
      sum += a < b ? hash_of_edge(a, b) : -hash_of_edge(b, a);
    }
    const float *a = d->positions[corner[0]], *b = d->positions[corner[1]], *c = d->positions[corner[2]];
    volume += a[0] * ((double)b[1] * c[2] - (double)b[2] * c[1]) +
              a[1] * ((double)b[2] * c[0] - (double)b[0] * c[2]) +
              a[2] * ((double)b[0] * c[1] - (double)b[1] * c[0]);
  }
  return sum == 0 && volume > 0;
}

/* Gives the arrays to a mesh, which then owns them. */
static hl_status own_arrays(hl_context *context, const hl_mesh_description *arrays, hl_mesh **mesh,
                            hl_error *error) {
  hl_mesh *made = hl_allocate_zeroed(context, 1, sizeof *made);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "a mesh");
  made->context = context;
  made->description = *arrays;
  atomic_init(&made->references, 1);
  hl_status status = keep_triangles(made, error);
  if (status == HL_OK) {
    made->closed = is_closed(&made->description);
    *mesh = made;
    return HL_OK;
  }
  made->description = (hl_mesh_description){0}; /* the caller releases the arrays */
  hl_mesh_release(made);
  return status;
}

static hl_status check_arrays(const hl_mesh_description *d, hl_error *error) {
  if (d->struct_size != sizeof *d)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_mesh_create: struct_size is %zu, not %zu: call hl_mesh_description_defaults() first",
                   d->struct_size, sizeof *d);
  if (d->positions == NULL || d->triangles == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_mesh_create: positions or triangles are null");
  if (d->vertex_count > UINT32_MAX || d->triangle_count > HL_LIMIT_TRIANGLES)
    return hl_fail(error, HL_ERROR_INPUT, "the mesh has %zu vertices and %zu triangles: at most %u and %d",
                   d->vertex_count, d->triangle_count, UINT32_MAX, HL_LIMIT_TRIANGLES);
  return HL_OK;
}

hl_status hl_mesh_create(hl_context *context, const hl_mesh_description *description, hl_mesh **mesh,
                         hl_error *error) {
  if (context == NULL || description == NULL || mesh == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_mesh_create: null context, description or mesh");
  *mesh = NULL;
  hl_status status = check_arrays(description, error);
  if (status != HL_OK) return status;
  size_t vertices = description->vertex_count, triangles = description->triangle_count;
  mesh_parts parts = {.context = context, .path = "a mesh"};
  status = hl_mesh_reserve_vertices(&parts, vertices, description->normals != NULL,
                                    description->colors != NULL, error);
  if (status == HL_OK) status = hl_mesh_reserve_triangles(&parts, triangles, error);
  if (status == HL_OK) {
    if (vertices > 0) memcpy(parts.positions, description->positions, vertices * sizeof *parts.positions);
    if (parts.normals != NULL) memcpy(parts.normals, description->normals, vertices * sizeof *parts.normals);
    if (parts.colors != NULL) memcpy(parts.colors, description->colors, vertices * sizeof *parts.colors);
    if (triangles > 0) memcpy(parts.triangles, description->triangles, triangles * sizeof *parts.triangles);
    parts.vertex_count = vertices;
    parts.triangle_count = triangles;
    status = hl_mesh_of_parts(&parts, mesh, error);
  }
  hl_mesh_parts_release(&parts);
  return status;
}

/* ---- arrays that grow ---- */

hl_status hl_mesh_of_parts(mesh_parts *parts, hl_mesh **mesh, hl_error *error) {
  const hl_mesh_description arrays = {.struct_size = sizeof arrays,
                                      .positions = (const float(*)[3])parts->positions,
                                      .normals = (const float(*)[3])parts->normals,
                                      .colors = (const float(*)[4])parts->colors,
                                      .vertex_count = parts->vertex_count,
                                      .triangles = (const uint32_t(*)[3])parts->triangles,
                                      .triangle_count = parts->triangle_count};
  hl_status status = own_arrays(parts->context, &arrays, mesh, error);
  if (status == HL_OK) *parts = (mesh_parts){.context = parts->context, .path = parts->path};
  return status;
}

void hl_mesh_parts_release(mesh_parts *parts) {
  hl_release(parts->context, parts->positions);
  hl_release(parts->context, parts->normals);
  hl_release(parts->context, parts->colors);
  hl_release(parts->context, parts->triangles);
  *parts = (mesh_parts){.context = parts->context, .path = parts->path};
}

static bool grow(hl_context *context, void **array, size_t room, size_t size) {
  void *grown = hl_reallocate(context, *array, room, size);
  if (grown != NULL) *array = grown;
  return grown != NULL;
}

hl_status hl_mesh_reserve_vertices(mesh_parts *parts, size_t count, bool with_normals, bool with_colors,
                                   hl_error *error) {
  if (count <= parts->vertex_room && parts->positions != NULL) return HL_OK;
  size_t room = count > 2 * parts->vertex_room ? count : 2 * parts->vertex_room;
  bool done = grow(parts->context, (void **)&parts->positions, room, sizeof *parts->positions);
  if (with_normals)
    done = done && grow(parts->context, (void **)&parts->normals, room, sizeof *parts->normals);
  if (with_colors) done = done && grow(parts->context, (void **)&parts->colors, room, sizeof *parts->colors);
  if (!done) return hl_fail_memory(error, room * sizeof *parts->positions, "a mesh's vertices");
  parts->vertex_room = room;
  return HL_OK;
}

hl_status hl_mesh_reserve_triangles(mesh_parts *parts, size_t count, hl_error *error) {
  if (count <= parts->triangle_room && parts->triangles != NULL) return HL_OK;
  size_t room = count > 2 * parts->triangle_room ? count : 2 * parts->triangle_room;
  if (!grow(parts->context, (void **)&parts->triangles, room, sizeof *parts->triangles))
    return hl_fail_memory(error, room * sizeof *parts->triangles, "a mesh's triangles");
  parts->triangle_room = room;
  return HL_OK;
}

hl_status hl_mesh_add_triangle(mesh_parts *parts, uint32_t a, uint32_t b, uint32_t c, hl_error *error) {
  if (parts->triangle_count == HL_LIMIT_TRIANGLES)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: more than %d triangles", parts->path,
                   HL_LIMIT_TRIANGLES);
  hl_status status = hl_mesh_reserve_triangles(parts, parts->triangle_count + 1, error);
  if (status != HL_OK) return status;
  uint32_t *triangle = parts->triangles[parts->triangle_count++];
  triangle[0] = a, triangle[1] = b, triangle[2] = c;
  return HL_OK;
}
