/* mesh/points.c - makes spheres of points, for files that have points and no faces. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "mesh/mesh.h"

/* The radius of spheres and tubes in files that give none, as a fraction of the diagonal of the box around
 * all points. */
static const double RADIUS_PART = 1.0 / 400;

double hl_mesh_usual_radius(const double low[3], const double high[3]) {
  double square = 0;
  for (int axis = 0; axis < 3; axis++)
    if (high[axis] > low[axis]) square += (high[axis] - low[axis]) * (high[axis] - low[axis]);
  return square > 0 ? sqrt(square) * RADIUS_PART : 1;
}

static double radius_of(const mesh_parts *parts) {
  double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
  for (size_t v = 0; v < parts->vertex_count; v++)
    for (int axis = 0; axis < 3; axis++) {
      const double at = parts->positions[v][axis];
      if (isfinite(at)) low[axis] = fmin(low[axis], at), high[axis] = fmax(high[axis], at);
    }
  return hl_mesh_usual_radius(low, high);
}

hl_status hl_mesh_show_points(mesh_parts *parts, hl_error *error) {
  const size_t count = parts->vertex_count;
  if (parts->triangle_count > 0 || count == 0) return HL_OK;
  if (count > HL_LIMIT_SPHERES)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: has %zu points: at most %d are read: reduce them",
                   parts->path, count, HL_LIMIT_SPHERES);
  parts->spheres = hl_allocate(parts->context, count, sizeof *parts->spheres);
  if (parts->spheres == NULL) return hl_fail_memory(error, count * sizeof *parts->spheres, parts->path);
  const float radius = (float)radius_of(parts);
  for (size_t v = 0; v < count; v++) {
    memcpy(parts->spheres[v], parts->positions[v], sizeof *parts->positions);
    parts->spheres[v][3] = radius;
  }
  parts->sphere_count = count;
  parts->sphere_colors = parts->colors;
  parts->colors = NULL;
  hl_release(parts->context, parts->positions);
  hl_release(parts->context, parts->normals);
  parts->positions = parts->normals = NULL;
  parts->vertex_count = parts->vertex_room = 0;
  return HL_OK;
}
