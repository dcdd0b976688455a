/* isosurface/refine.c - halves the edges of triangles where the surface bends away from them.
 *
 * Let e be an edge, and m and n the unit normals at its ends. Above the middle of the edge, the surface rises
 * by about |e . (n - m)| / 8 (derived: on a circle of radius r the normals' difference along e is |e| / r,
 * and the arc rises by |e|^2 / (8 r) above its chord). An edge is halved in the two triangles that share it,
 * so that the surface gets no gaps. Lengths are measured in the world, in units of a voxel's smallest edge.
 * Lengths in index space would be wrong where voxels are long. */
#include <stdlib.h>

#include "core/memory.h"
#include "isosurface/triangles.h"
#include "mesh/mesh.h"

/* The greatest rise of the surface above an edge that is left whole. Above the middle of an equilateral
 * triangle, the surface rises by 4/3 of its rise above the triangle's edges. */
static const double MOST_RISE = 0.014;

/* An edge of at most this length is never halved. Otherwise noise, whose surfaces bend within a voxel, would
 * be cut into countless triangles. A surface of radius 5 rises by 0.014 above an edge of this length. */
static const double LEAST_EDGE = 0.75;

typedef struct halving {
  const lattice *lattice;
  iso_triangles *made;
  uint64_t *edges; /* owned; [count]; the edges to halve, in rising order. An edge is a number of 64 bits: the
                    * upper half is the lesser of its two vertices, the lower half the greater one */
  size_t count;
  size_t first_vertex; /* number of the first vertex that is an edge's middle */
  mat3 ways, turns;    /* `ways` maps differences of index coordinates to the world; `turns`, the inverse
                        * transpose of `ways`, maps normals */
  float (*normals)[3]; /* owned; unit normals, in the world, of the vertices that are not middles of edges */
} halving;

static vec3 vertex_of(const float (*of)[3], uint32_t vertex) {
  return (vec3){(double)of[vertex][0], (double)of[vertex][1], (double)of[vertex][2]};
}

enum { RUN_VERTICES = 4096 };

static void turn_normals(void *data, size_t index, int worker) {
  (void)worker;
  const halving *job = data;
  const size_t end = (index + 1) * RUN_VERTICES;
  for (size_t v = index * RUN_VERTICES; v < end && v < job->made->vertex_count; v++) {
    const vec3 own = vertex_of((const float(*)[3])job->made->normals, (uint32_t)v);
    vec3_store(job->normals[v], vec3_normalise(mat3_apply(job->turns, own)));
  }
}

static bool bends(const halving *job, uint32_t a, uint32_t b) {
  const float(*positions)[3] = (const float(*)[3])job->made->positions;
  const vec3 way = mat3_apply(job->ways, vec3_subtract(vertex_of(positions, b), vertex_of(positions, a)));
  if (!(vec3_dot(way, way) > LEAST_EDGE * LEAST_EDGE)) return false;
  const float(*normals)[3] = (const float(*)[3])job->normals;
  const double rise = vec3_dot(way, vec3_subtract(vertex_of(normals, b), vertex_of(normals, a)));
  return fabs(rise) > 8 * MOST_RISE;
}

static uint64_t key_of(uint32_t a, uint32_t b) {
  return a < b ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
}

static int compare_keys(const void *a, const void *b) {
  uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return x < y ? -1 : x > y;
}

/* Lists the edges that are to be halved, and returns their number. keys: receives the edges; it has room for
 * three edges for each triangle. If it is null, the edges are only counted. */
static size_t list_edges(const halving *job, uint64_t *keys) {
  const iso_triangles *made = job->made;
  size_t count = 0, kept = 0;
  for (size_t t = 0; t < made->triangle_count; t++)
    for (int i = 0; i < 3; i++) {
      uint32_t a = made->triangles[t][i], b = made->triangles[t][(i + 1) % 3];
      if (!bends(job, a, b)) continue;
      if (keys != NULL) keys[count] = key_of(a, b);
      count++;
    }
  if (keys == NULL || count == 0) return count;
  qsort(keys, count, sizeof *keys, compare_keys);
  for (size_t n = 0; n < count; n++)
    if (n == 0 || keys[n] != keys[n - 1]) keys[kept++] = keys[n];
  return kept;
}

/* The vertex in the middle of the edge between vertices a and b; -1: the edge is left whole. */
static int64_t middle_of(const halving *job, uint32_t a, uint32_t b) {
  if (!bends(job, a, b)) return -1;
  uint64_t key = key_of(a, b);
  const uint64_t *found = bsearch(&key, job->edges, job->count, sizeof key, compare_keys);
  return found != NULL ? (int64_t)(job->first_vertex + (size_t)(found - job->edges)) : -1;
}

/* Moves a point of index space onto the surface, in the direction of the field's gradient in the world
 * (Newton's method). If the surface is farther away than `reach`, the point stays. The reach is a length in
 * the world, because in long voxels the middle of an edge may have to move by several of the short voxel
 * edges. */
static vec3 move_to_surface(const halving *job, vec3 start, double reach) {
  enum { STEPS = 4 };
  const lattice *lattice = job->lattice;
  vec3 at = start, slope;
  for (int step = 0; step < STEPS; step++) {
    double off = lattice->value - hl_field_value_and_slope(lattice->grid, lattice->kernel, at, &slope);
    const vec3 in_world = mat3_apply(job->turns, slope);
    double steep = vec3_dot(in_world, in_world);
    if (!(steep > 0)) return start;
    at = vec3_add(at, mat3_apply(mat3_transpose(job->turns), vec3_scale(in_world, off / steep)));
    if (!(vec3_length(mat3_apply(job->ways, vec3_subtract(at, start))) <= reach)) return start;
  }
  return at;
}

static void place_middle(void *data, size_t index, int worker) {
  (void)worker;
  const halving *job = data;
  iso_triangles *made = job->made;
  const float *a = made->positions[job->edges[index] >> 32],
              *b = made->positions[job->edges[index] & UINT32_MAX];
  vec3 from = {a[0], a[1], a[2]}, to = {b[0], b[1], b[2]}, slope;
  vec3 middle = vec3_scale(vec3_add(from, to), 0.5);
  middle = move_to_surface(job, middle, vec3_length(mat3_apply(job->ways, vec3_subtract(to, from))) / 2);
  (void)hl_field_value_and_slope(job->lattice->grid, job->lattice->kernel, middle, &slope);
  vec3_store(made->positions[job->first_vertex + index], middle);
  vec3_store(made->normals[job->first_vertex + index], hl_iso_normal(job->lattice, slope));
}

/* ---- triangles ---- */

static void put(uint32_t (*triangles)[3], size_t *count, uint32_t a, uint32_t b, uint32_t c) {
  uint32_t *triangle = triangles[(*count)++];
  triangle[0] = a, triangle[1] = b, triangle[2] = c;
}

/* Writes the parts of a triangle whose edges are halved. The edge from corner 0 to corner 1 must be halved.
 * The edge from corner 2 to corner 0 must be whole, unless all three edges are halved. */
static void put_parts(uint32_t (*triangles)[3], size_t *count, const uint32_t v[3], const int64_t m[3]) {
  uint32_t m0 = (uint32_t)m[0], m1 = (uint32_t)m[1], m2 = (uint32_t)m[2];
  if (m[1] < 0) {
    put(triangles, count, v[0], m0, v[2]);
    put(triangles, count, m0, v[1], v[2]);
    return;
  }
  put(triangles, count, m0, v[1], m1);
  if (m[2] < 0) {
    put(triangles, count, v[0], m0, m1);
    put(triangles, count, v[0], m1, v[2]);
    return;
  }
  put(triangles, count, v[0], m0, m2);
  put(triangles, count, m2, m1, v[2]);
  put(triangles, count, m0, m1, m2);
}

static void put_triangle(const halving *job, const uint32_t corner[3], uint32_t (*triangles)[3],
                         size_t *count) {
  int64_t middle[3];
  int halved = 0, first = 0;
  for (int i = 0; i < 3; i++) {
    middle[i] = middle_of(job, corner[i], corner[(i + 1) % 3]);
    halved += middle[i] >= 0;
  }
  if (halved == 0) {
    put(triangles, count, corner[0], corner[1], corner[2]);
    return;
  }
  while (middle[first] < 0 || (halved == 2 && middle[(first + 1) % 3] < 0)) first++;
  uint32_t v[3];
  int64_t m[3];
  for (int i = 0; i < 3; i++) v[i] = corner[(first + i) % 3], m[i] = middle[(first + i) % 3];
  put_parts(triangles, count, v, m);
}

/* Makes room for the vertices in the middles of the edges, and places these vertices. */
static hl_status add_middles(hl_pool *pool, halving *job, hl_error *error) {
  hl_context *context = job->lattice->context;
  iso_triangles *made = job->made;
  size_t vertices = made->vertex_count + job->count;
  if (vertices > UINT32_MAX) return hl_fail(error, HL_ERROR_UNSUPPORTED, "an isosurface of 2^32 vertices");
  void *positions = hl_reallocate(context, made->positions, vertices, sizeof *made->positions);
  if (positions != NULL) made->positions = positions;
  void *normals = hl_reallocate(context, made->normals, vertices, sizeof *made->normals);
  if (normals != NULL) made->normals = normals;
  if (positions == NULL || normals == NULL)
    return hl_fail_memory(error, vertices * sizeof *made->positions, "an isosurface");
  job->first_vertex = made->vertex_count;
  made->vertex_count = vertices;
  return hl_lattice_run(pool, job->count, place_middle, job, error);
}

/* The number of triangles after all listed edges have been halved. */
static size_t count_parts(const halving *job) {
  size_t count = job->made->triangle_count;
  for (size_t t = 0; t < job->made->triangle_count; t++)
    for (int i = 0; i < 3; i++)
      count += middle_of(job, job->made->triangles[t][i], job->made->triangles[t][(i + 1) % 3]) >= 0;
  return count;
}

static hl_status cut_triangles(halving *job, hl_error *error) {
  hl_context *context = job->lattice->context;
  iso_triangles *made = job->made;
  size_t room = count_parts(job), count = 0;
  if (room > HL_LIMIT_TRIANGLES)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "an isosurface of more than %d triangles: choose another value", HL_LIMIT_TRIANGLES);
  uint32_t(*triangles)[3] = hl_allocate(context, room, sizeof *triangles);
  if (triangles == NULL) return hl_fail_memory(error, room * sizeof *triangles, "an isosurface");
  for (size_t t = 0; t < made->triangle_count; t++) put_triangle(job, made->triangles[t], triangles, &count);
  hl_release(context, made->triangles);
  made->triangles = triangles;
  made->triangle_count = count;
  return HL_OK;
}

/* Halves the listed edges. listed: number of edges in the list, which may hold an edge more than once. */
static hl_status halve(hl_pool *pool, halving *job, size_t listed, hl_error *error) {
  hl_context *context = job->lattice->context;
  job->edges = hl_allocate(context, listed, sizeof *job->edges);
  if (job->edges == NULL) return hl_fail_memory(error, listed * sizeof *job->edges, "an isosurface");
  job->count = list_edges(job, job->edges);
  hl_status status = add_middles(pool, job, error);
  if (status == HL_OK) status = cut_triangles(job, error);
  hl_release(context, job->edges);
  return status;
}

/* Halves once all edges that lie too far from the surface. *any: set to false if there is no such edge, or if
 * there is no room for more triangles. */
static hl_status halve_edges(hl_pool *pool, const lattice *lattice, iso_triangles *triangles, bool *any,
                             hl_error *error) {
  halving job = {.lattice = lattice, .made = triangles};
  const mat3 placed = lattice->grid->index_to_frame.linear;
  mat3 inverse;
  *any = false;
  if (!mat3_invert(placed, &inverse)) return HL_OK; /* such a map was refused when the grid was made */
  const double voxel = mat3_shortest_column(placed);
  const mat3 turned = mat3_transpose(inverse);
  for (int row = 0; row < 3; row++) {
    job.ways.row[row] = vec3_scale(placed.row[row], 1 / voxel);
    job.turns.row[row] = vec3_scale(turned.row[row], voxel);
  }
  const size_t vertices = triangles->vertex_count;
  job.normals = hl_allocate(lattice->context, vertices, sizeof *job.normals);
  if (job.normals == NULL) return hl_fail_memory(error, vertices * sizeof *job.normals, "an isosurface");
  hl_status status = hl_lattice_run(pool, (vertices + RUN_VERTICES - 1) / RUN_VERTICES, turn_normals, &job,
                                    error);
  const size_t listed = status == HL_OK ? list_edges(&job, NULL)
                                        : 0; /* an edge that two triangles share is listed twice */
  *any = listed > 0 && triangles->triangle_count + listed <= HL_LIMIT_TRIANGLES;
  if (*any) status = halve(pool, &job, listed, error);
  hl_release(lattice->context, job.normals);
  return status;
}

hl_status hl_iso_refine(hl_pool *pool, const lattice *lattice, iso_triangles *triangles, hl_error *error) {
  enum {
    ROUNDS = 8
  }; /* the greatest number of rounds of halving; cells that are twenty times as wide along one axis as
      * along another need five */
  hl_status status = HL_OK;
  bool any = true;
  for (int round = 0; round < ROUNDS && any && status == HL_OK; round++)
    status = halve_edges(pool, lattice, triangles, &any, error);
  return status;
}
