/* mesh/edges.c - finds normals at the creases of meshes that have no normals of their own.
 *
 * In: a mesh's triangles. Out: a normal for each corner at a crease. A vertex's normal is the mean of its
 * triangles' normals, weighted by area. If the normal of one of its triangles differs much from this mean,
 * the vertex is at a crease. The normal of a corner at a crease is the mean over fewer triangles: the
 * triangles at the vertex whose normals differ little from the normal of the corner's own triangle. Without
 * creases a long box would look rounded, because its short faces contribute little to the means. */
#include "core/memory.h"
#include "core/vector.h"
#include "mesh/mesh.h"

/* The cosine of 60 degrees: at a crease, two triangles of a vertex share a normal if the angle between them
 * is smaller than this. */
static const double SHARED = 0.5;

/* A vertex with more triangles than this keeps one normal for all of them. */
enum { MOST_TRIANGLES = 256 };

typedef struct edge_search {
  const hl_mesh_description *mesh;
  float (*sums)[3]; /* owned; [vertex_count]; sums of the cross products of each vertex's triangles */
  uint16_t *marks;  /* owned; [vertex_count]; at first, whether the vertex is at a crease; later, the number
                     * of its corners that were listed */
  /* owned; [vertex_count + 1]; for each vertex at a crease, the index in `corners` at which the vertex's
   * corners begin */
  uint32_t *first;
  /* owned; [first[vertex_count]]; the corners at creases, each as 3 x triangle + number of the corner in the
   * triangle */
  size_t *corners;
} edge_search;

static vec3 position_of(const hl_mesh_description *d, uint32_t vertex) {
  const float *p = d->positions[vertex];
  return (vec3){p[0], p[1], p[2]};
}

/* The cross product of two edges of a triangle: a vector along its normal, as long as twice its area. */
static vec3 cross_of(const hl_mesh_description *d, size_t triangle) {
  const uint32_t *corner = d->triangles[triangle];
  vec3 a = position_of(d, corner[0]);
  return vec3_cross(vec3_subtract(position_of(d, corner[1]), a), vec3_subtract(position_of(d, corner[2]), a));
}

static void add_up(edge_search *search) {
  const hl_mesh_description *d = search->mesh;
  for (size_t t = 0; t < d->triangle_count; t++) {
    vec3 cross = cross_of(d, t);
    for (int i = 0; i < 3; i++) {
      float *sum = search->sums[d->triangles[t][i]];
      vec3_store(sum, vec3_add((vec3){sum[0], sum[1], sum[2]}, cross));
    }
  }
}

/* Marks the vertices at which a triangle's normal differs much from the mean of the vertex's normals. Returns
 * whether any vertex was marked. */
static bool mark_edges(edge_search *search) {
  const hl_mesh_description *d = search->mesh;
  bool any = false;
  for (size_t t = 0; t < d->triangle_count; t++) {
    vec3 cross = cross_of(d, t);
    for (int i = 0; i < 3; i++) {
      const float *sum = search->sums[d->triangles[t][i]];
      vec3 mean = {sum[0], sum[1], sum[2]};
      double along = vec3_dot(mean, cross),
             least = HL_MESH_ROUNDED * HL_MESH_ROUNDED * vec3_dot(mean, mean) * vec3_dot(cross, cross);
      if (along * along >= least) continue;
      search->marks[d->triangles[t][i]] = 1;
      any = true;
    }
  }
  return any;
}

/* Finds where the corners of each marked vertex begin. */
static void count_corners(edge_search *search) {
  const hl_mesh_description *d = search->mesh;
  for (size_t t = 0; t < d->triangle_count; t++)
    for (int i = 0; i < 3; i++) search->first[d->triangles[t][i] + 1] += search->marks[d->triangles[t][i]];
  for (size_t v = 0; v < d->vertex_count; v++) {
    if (search->first[v + 1] > MOST_TRIANGLES) search->first[v + 1] = 0;
    search->first[v + 1] += search->first[v];
    search->marks[v] = 0;
  }
}

/* Lists the corners at creases, and stores each corner's place in the list in `edges`. */
static void list_corners(edge_search *search, uint32_t (*edges)[3]) {
  const hl_mesh_description *d = search->mesh;
  for (size_t t = 0; t < d->triangle_count; t++)
    for (int i = 0; i < 3; i++) {
      uint32_t vertex = d->triangles[t][i], first = search->first[vertex];
      edges[t][i] = HL_NO_EDGE;
      if (search->first[vertex + 1] == first) continue;
      edges[t][i] = first + search->marks[vertex]++;
      search->corners[edges[t][i]] = 3 * t + (size_t)i;
    }
}

/* Finds the normals of the corners of one vertex at a crease. A corner's normal is the mean over the
 * triangles whose normals differ little from the normal of the corner's own triangle. */
static void find_normals_of(const edge_search *search, size_t vertex, float (*normals)[3]) {
  vec3 cross[MOST_TRIANGLES], unit[MOST_TRIANGLES];
  const size_t *corners = search->corners + search->first[vertex];
  int count = (int)(search->first[vertex + 1] - search->first[vertex]);
  for (int k = 0; k < count; k++) {
    cross[k] = cross_of(search->mesh, corners[k] / 3);
    unit[k] = vec3_normalise(cross[k]);
  }
  for (int k = 0; k < count; k++) {
    vec3 sum = {0, 0, 0};
    for (int other = 0; other < count; other++)
      if (vec3_dot(unit[k], unit[other]) > SHARED) sum = vec3_add(sum, cross[other]);
    vec3_store(normals[search->first[vertex] + (uint32_t)k], vec3_normalise(sum));
  }
}

static bool make_normals(edge_search *search, hl_mesh *mesh) {
  const hl_mesh_description *d = search->mesh;
  mesh->edge_normal_count = search->first[d->vertex_count];
  mesh->edges = hl_allocate(mesh->context, d->triangle_count, sizeof *mesh->edges);
  mesh->edge_normals = hl_allocate(mesh->context, mesh->edge_normal_count, sizeof *mesh->edge_normals);
  search->corners = hl_allocate(mesh->context, mesh->edge_normal_count, sizeof *search->corners);
  if (mesh->edges == NULL || mesh->edge_normals == NULL || search->corners == NULL) return false;
  list_corners(search, mesh->edges);
  for (size_t v = 0; v < d->vertex_count; v++) find_normals_of(search, v, mesh->edge_normals);
  return true;
}

static bool search_edges(edge_search *search, hl_mesh *mesh) {
  size_t vertices = search->mesh->vertex_count;
  search->sums = hl_allocate_zeroed(mesh->context, vertices, sizeof *search->sums);
  search->marks = hl_allocate_zeroed(mesh->context, vertices, sizeof *search->marks);
  if (search->sums == NULL || search->marks == NULL) return false;
  add_up(search);
  if (!mark_edges(search)) return true;
  search->first = hl_allocate_zeroed(mesh->context, vertices + 1, sizeof *search->first);
  if (search->first == NULL) return false;
  count_corners(search);
  return make_normals(search, mesh);
}

hl_status hl_mesh_find_edges(hl_mesh *mesh, hl_error *error) {
  edge_search search = {.mesh = &mesh->description};
  if (mesh->description.normals != NULL || mesh->description.triangle_count == 0) return HL_OK;
  bool done = search_edges(&search, mesh);
  hl_release(mesh->context, search.sums);
  hl_release(mesh->context, search.marks);
  hl_release(mesh->context, search.first);
  hl_release(mesh->context, search.corners);
  return done ? HL_OK
              : hl_fail_memory(error, mesh->description.vertex_count * sizeof *search.sums,
                               "a mesh's normals");
}
