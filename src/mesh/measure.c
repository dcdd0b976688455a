/* mesh/measure.c - measures the area of a mesh's triangles and the volume that they enclose. */
#include <halflight/mesh.h>
#include <math.h>
#include <stdlib.h>

#include "core/context.h"
#include "core/door.h"
#include "core/error.h"
#include "core/memory.h"
#include "core/vector.h"

/* An edge of a triangle: the numbers of its two vertices, the lesser number in the upper half of the bits. */
typedef struct edge {
  uint64_t vertices;
  int direction; /* 1 if the triangle goes from the lesser vertex to the greater one, else -1 */
} edge;

static int compare_edges(const void *a, const void *b) {
  const uint64_t one = ((const edge *)a)->vertices, other = ((const edge *)b)->vertices;
  return one < other ? -1 : one > other;
}

/* Returns whether each edge is run through equally often in both directions. edges: [count]; become sorted.
 */
static bool is_closed(edge *edges, size_t count) {
  if (count == 0) return false;
  qsort(edges, count, sizeof *edges, compare_edges);
  int balance = 0;
  for (size_t n = 0; n < count; n++) {
    balance += edges[n].direction;
    const bool last = n + 1 == count || edges[n + 1].vertices != edges[n].vertices;
    if (last && balance != 0) return false;
  }
  return true;
}

static vec3 corner(const hl_mesh_description *mesh, size_t triangle, int c) {
  const float *at = mesh->positions[mesh->triangles[triangle][c]];
  return (vec3){at[0], at[1], at[2]};
}

hl_status hl_mesh_measure(hl_context *context, const hl_mesh *mesh, double *area, double *volume,
                          hl_error *error) {
  HL_DOOR;
  const hl_mesh_description *made = hl_mesh_describe(mesh);
  if (context == NULL || made == NULL || area == NULL || volume == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_mesh_measure: null context, mesh, area or volume");
  const size_t count = made->triangle_count;
  edge *edges = count > 0 ? hl_allocate(context, 3 * count, sizeof *edges) : NULL;
  if (count > 0 && edges == NULL) return hl_fail_memory(error, 3 * count * sizeof *edges, "edges");
  const vec3 origin = count > 0 ? corner(made, 0, 0) : (vec3){0, 0, 0};
  *area = *volume = 0;
  for (size_t t = 0; t < count; t++) {
    vec3 at[3];
    for (int c = 0; c < 3; c++) {
      const uint32_t from = made->triangles[t][c], to = made->triangles[t][(c + 1) % 3];
      edges[3 * t + (size_t)c] = (edge){from < to ? (uint64_t)from << 32 | to : (uint64_t)to << 32 | from,
                                        from < to ? 1 : -1};
      at[c] = vec3_subtract(corner(made, t, c), origin);
    }
    const vec3 normal = vec3_cross(vec3_subtract(at[1], at[0]), vec3_subtract(at[2], at[0]));
    *area += vec3_length(normal) / 2;
    *volume += vec3_dot(at[0], vec3_cross(at[1], at[2])) / 6;
  }
  *volume = is_closed(edges, 3 * count) ? fabs(*volume) : NAN;
  hl_release(context, edges);
  return HL_OK;
}
