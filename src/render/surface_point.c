/* render/surface_point.c - see surface_point.h. */
#include "render/surface_point.h"

#include "surface/primitive.h"

vec3 hl_surface_place(const sweep *sweep, const tile_slab *slab, const fragment *f, double height) {
  const view *eye = &sweep->frame->eye;
  const sheet_stack *sheets = &sweep->geometry->sheets;
  double u, v;
  vec3 start, way;
  hl_fragment_middle(f->samples, &u, &v);
  u += slab->x * TILE + hl_pixel_column(f->pixel);
  v += slab->y * TILE + hl_pixel_row(f->pixel);
  hl_view_ray(eye, u, v, &start, &way);
  double rise = sheets->first + height - vec3_dot(sheets->normal, start);
  return vec3_add(start, vec3_scale(way, rise / vec3_dot(sheets->normal, way)));
}

surface_point hl_surface_point_of(const sweep *sweep, const tile_slab *slab, const fragment *f) {
  const surfaces *all = sweep->frame->surfaces;
  const surface_mesh *mesh = &all->meshes[f->mesh];
  const view *eye = &sweep->frame->eye;
  surface_point point = {.position = hl_surface_place(sweep, slab, f, (double)f->height)};
  point.towards_eye = eye->perspective ? vec3_normalise(vec3_subtract(eye->origin, point.position))
                                       : vec3_scale(eye->direction, -1);
  vec3 flat = hl_primitive_kind(all, f->primitive)
                  ->look(all, mesh, f->primitive, point.position, &point.normal, point.color);
  if (vec3_dot(flat, point.towards_eye) >= 0) return point;
  point.normal = vec3_scale(point.normal, mesh->look.two_sided ? -1 : 0);
  if (!mesh->look.two_sided) point.color[0] = point.color[1] = point.color[2] = 0;
  return point;
}
