/* surface/primitive.c - see primitive.h: which mesh a primitive belongs to, its opacity. */
#include "surface/primitive.h"

size_t hl_surface_mesh_of(const surfaces *all, uint32_t primitive) {
  size_t low = 0, high = all->mesh_count;
  const primitive_kind *kind = hl_primitive_kind(all, primitive);
  while (high - low > 1) {
    size_t middle = (low + high) / 2;
    if (kind->first(all, &all->meshes[middle]) <= primitive) low = middle;
    else high = middle;
  }
  return low;
}

uint32_t hl_surface_mesh_end(const surfaces *all, size_t mesh, uint32_t primitive) {
  const primitive_kind *kind = hl_primitive_kind(all, primitive);
  return kind->first(all, &all->meshes[mesh]) + kind->count(&all->meshes[mesh]);
}

float hl_primitive_opacity(const surfaces *all, const surface_mesh *mesh, uint32_t primitive) {
  return (float)hl_primitive_kind(all, primitive)->opacity(all, mesh, primitive);
}
