/* surface/primitive.c - see primitive.h: finds the mesh of a primitive, and a primitive's opacity. */
#include "surface/primitive.h"

size_t hl_surface_mesh_of(const surfaces *all, uint32_t primitive) {
  size_t low = 0, high = all->mesh_count;
  const int kind = hl_primitive_number(all, primitive);
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (all->meshes[middle].primitives[kind].first <= primitive) low = middle;
    else high = middle;
  }
  return low;
}

float hl_primitive_opacity(const surfaces *all, const surface_mesh *mesh, uint32_t primitive) {
  return (float)hl_primitive_kind(all, primitive)->opacity(all, mesh, primitive);
}
