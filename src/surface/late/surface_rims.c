/* surface/late/surface_rims.c - see surface_rims.h. */
#include "surface/late/surface_rims.h"

#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"
#include "surface/late/lateness.h"
#include "surface/surface_cuts.h"

/* Adds a hash of each edge to the sums of its two vertices, with a sign that tells the edge's direction.
 * Derived as in mesh.c: a vertex has the sum 0 if all of its edges are used equally often in both
 * directions. */
static void sum_edges(const surfaces *all, const surface_mesh *mesh, uint64_t *sum) {
  for (uint32_t t = 0; t < mesh->primitives[PRIMITIVE_triangle].count; t++) {
    const uint32_t *corner = all->triangles[mesh->primitives[PRIMITIVE_triangle].first + t];
    for (int i = 0; i < 3; i++) {
      uint32_t a = corner[i] - (uint32_t)mesh->first_vertex,
               b = corner[(i + 1) % 3] - (uint32_t)mesh->first_vertex;
      uint64_t hash = hl_hash_of_way(a, b);
      sum[a] += hash;
      sum[b] += hash;
    }
  }
}

/* The distance that marks a vertex as being at a corner, until begin_distances() sets the distance to 0. */
static const float AT_CORNER = -1;

/* Marks each vertex that has a triangle whose normal differs much from the normal of the vertex's first
 * triangle. Returns the number of marked vertices. first: [vertices]; receives the first triangle of each
 * vertex. */
static size_t mark_corners(const surfaces *all, const surface_mesh *mesh, uint32_t *first, float *from_edge) {
  size_t count = 0;
  for (uint32_t t = mesh->primitives[PRIMITIVE_triangle].count; t-- > 0;)
    for (int i = 0; i < 3; i++)
      first[all->triangles[mesh->primitives[PRIMITIVE_triangle].first + t][i] - mesh->first_vertex] = t;
  for (uint32_t t = 0; t < mesh->primitives[PRIMITIVE_triangle].count; t++) {
    vec3 own = hl_surface_normal(all, mesh->primitives[PRIMITIVE_triangle].first + t);
    for (int i = 0; i < 3; i++) {
      size_t vertex = all->triangles[mesh->primitives[PRIMITIVE_triangle].first + t][i] - mesh->first_vertex;
      if (first[vertex] == t || from_edge[vertex] < 0) continue;
      vec3 other = hl_surface_normal(all, mesh->primitives[PRIMITIVE_triangle].first + first[vertex]);
      if (fabs(vec3_dot(own, other)) >= HL_MESH_ROUNDED) continue;
      from_edge[vertex] = AT_CORNER;
      count++;
    }
  }
  return count;
}

/* Sets the distance of vertices at open edges and corners to 0, and the distance of other vertices to
 * infinity. sum: [vertices]; the sums of sum_edges(). */
static void begin_distances(const surfaces *all, const surface_mesh *mesh, const uint64_t *sum,
                            uint32_t *first, float *from_edge) {
  size_t vertices = mesh->mesh->description.vertex_count;
  for (size_t v = 0; v < vertices; v++) from_edge[v] = INFINITY;
  size_t corners = mark_corners(all, mesh, first, from_edge);
  bool rough = corners > MOST_CORNERS && corners > vertices / MOST_PARTS;
  for (size_t v = 0; v < vertices; v++)
    from_edge[v] = sum[v] != 0 || (from_edge[v] < 0 && !rough) ? 0 : INFINITY;
}

/* Sets the distance of the vertices of triangles that the scene's cuts cross to 0. */
static void begin_at_cuts(const surfaces *all, const surface_mesh *mesh, float *from_edge) {
  for (uint32_t t = 0; t < mesh->primitives[PRIMITIVE_triangle].count && mesh->is_cut; t++) {
    const uint32_t triangle = mesh->primitives[PRIMITIVE_triangle].first + t,
                   *corner = all->triangles[triangle];
    if (hl_surface_cut(all, mesh, triangle) != CUT_LEAVES_SOME) continue;
    for (int i = 0; i < 3; i++) from_edge[corner[i] - mesh->first_vertex] = 0;
  }
}

/* For each vertex of a triangle, lowers its distance to at most another vertex's distance plus the length of
 * the edge between the two. Returns whether a distance changed. */
static bool follow_edges(const surfaces *all, const surface_mesh *mesh, uint32_t triangle, float distance,
                         float *from_edge) {
  const uint32_t *corner = all->triangles[mesh->primitives[PRIMITIVE_triangle].first + triangle];
  bool changed = false, any = false;
  for (int i = 0; i < 3; i++) any |= from_edge[corner[i] - mesh->first_vertex] < distance;
  for (int i = 0; i < 3 && any; i++)
    for (int k = 0; k < 3; k++) {
      float own = from_edge[corner[i] - mesh->first_vertex], *to = &from_edge[corner[k] - mesh->first_vertex];
      if (!(own < distance) || !(own < *to)) continue;
      float length = (float)vec3_length(vec3_subtract(hl_surface_vector(all->positions[corner[i]]),
                                                      hl_surface_vector(all->positions[corner[k]])));
      if (!(own + length < *to)) continue;
      *to = own + length;
      changed = true;
    }
  return changed;
}

/* The arrays of the search; each has one entry for each vertex of the mesh. */
typedef struct rim_search {
  uint64_t *sum;
  uint32_t *first;
  float *from_edge;
} rim_search;

static void lay_out(const surface_mesh *mesh, rim_search *search, hl_layout *layout) {
  const size_t vertices = mesh->mesh->description.vertex_count;
  search->sum = hl_layout_take(layout, vertices, sizeof *search->sum);
  search->first = hl_layout_take(layout, vertices, sizeof *search->first);
  search->from_edge = hl_layout_take(layout, vertices, sizeof *search->from_edge);
}

void hl_surface_rims_count(const surface_mesh *mesh, hl_layout *layout) {
  const size_t kept = layout->bytes;
  lay_out(mesh, &(rim_search){0}, layout);
  hl_layout_give_back(layout, kept);
}

hl_status hl_surface_rims(hl_context *context, const surfaces *all, const surface_mesh *mesh, double distance,
                          bool *near, hl_error *error) {
  rim_search search = {0};
  hl_layout layout = {0};
  while (hl_layout_pass(&layout, context)) lay_out(mesh, &search, &layout);
  if (layout.base == NULL) return hl_fail_memory(error, layout.bytes, "the edges of meshes");
  memset(search.sum, 0, mesh->mesh->description.vertex_count * sizeof *search.sum);
  sum_edges(all, mesh, search.sum);
  begin_distances(all, mesh, search.sum, search.first, search.from_edge);
  begin_at_cuts(all, mesh, search.from_edge);
  bool changed = true;
  for (int pass = 0; pass < RIM_PASSES && changed; pass++) {
    changed = false;
    for (uint32_t i = 0; i < mesh->primitives[PRIMITIVE_triangle].count; i++)
      changed |= follow_edges(all, mesh, pass % 2 ? mesh->primitives[PRIMITIVE_triangle].count - 1 - i : i,
                              (float)distance, search.from_edge);
  }
  for (uint32_t t = 0; t < mesh->primitives[PRIMITIVE_triangle].count; t++) {
    const uint32_t *corner = all->triangles[mesh->primitives[PRIMITIVE_triangle].first + t];
    near[t] = false;
    for (int i = 0; i < 3; i++)
      near[t] |= search.from_edge[corner[i] - mesh->first_vertex] <= (float)distance;
  }
  hl_release(context, layout.base);
  return HL_OK;
}
