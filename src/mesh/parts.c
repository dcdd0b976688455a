/* mesh/parts.c - keeps the arrays of a mesh while its file is read; they grow as needed. */
#include "core/memory.h"
#include "mesh/mesh.h"

hl_mesh_description hl_mesh_parts_describe(const mesh_parts *parts) {
  return (hl_mesh_description){.struct_size = sizeof(hl_mesh_description),
                               .positions = (const float(*)[3])parts->positions,
                               .normals = (const float(*)[3])parts->normals,
                               .colors = (const float(*)[4])parts->colors,
                               .vertex_count = parts->vertex_count,
                               .triangles = (const uint32_t(*)[3])parts->triangles,
                               .triangle_count = parts->triangle_count,
                               .face_colors = (const float(*)[4])parts->face_colors,
                               .spheres = (const float(*)[4])parts->spheres,
                               .sphere_colors = (const float(*)[4])parts->sphere_colors,
                               .sphere_count = parts->sphere_count,
                               .line_points = (const float(*)[4])parts->line_points,
                               .line_colors = (const float(*)[4])parts->line_colors,
                               .line_point_count = parts->line_point_count,
                               .line_lengths = parts->line_lengths,
                               .line_count = parts->line_count};
}

void hl_mesh_parts_release(mesh_parts *parts) {
  void *const arrays[] = {parts->positions,   parts->normals,      parts->colors,        parts->triangles,
                          parts->face_colors, parts->spheres,      parts->sphere_colors, parts->line_points,
                          parts->line_colors, parts->line_lengths, parts->polygons};
  for (size_t n = 0; n < sizeof arrays / sizeof *arrays; n++) hl_release(parts->context, arrays[n]);
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
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "%s: more than %d triangles: reduce them (decimate)",
                   parts->path, HL_LIMIT_TRIANGLES);
  hl_status status = hl_mesh_reserve_triangles(parts, parts->triangle_count + 1, error);
  if (status != HL_OK) return status;
  uint32_t *triangle = parts->triangles[parts->triangle_count++];
  triangle[0] = a, triangle[1] = b, triangle[2] = c;
  return HL_OK;
}
