/* render/surface_point.c - see surface_point.h. */
#include "render/surface_point.h"

#include "mesh/mesh.h"

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

/* The weights of a triangle's corners at a point of its plane. */
static void find_weights(const vec3 corner[3], vec3 cross, vec3 at, double weight[3]) {
  double area = vec3_dot(cross, cross), sum = 0;
  for (int i = 0; i < 3; i++) {
    vec3 a = corner[(i + 1) % 3], b = corner[(i + 2) % 3];
    double part = vec3_dot(cross, vec3_cross(vec3_subtract(a, at), vec3_subtract(b, at)));
    weight[i] = area > 0 ? fmax(part / area, 0) : 1;
    sum += weight[i];
  }
  for (int i = 0; i < 3; i++) weight[i] = sum > 0 ? weight[i] / sum : 1.0 / 3;
}

/* The normal of a triangle's corner: its own where it is at an edge, else its vertex's. */
static vec3 corner_normal(const surfaces *all, const surface_mesh *mesh, uint32_t triangle, int i) {
  uint32_t edge = mesh->edges != NULL ? mesh->edges[triangle - mesh->first_triangle][i] : HL_NO_EDGE;
  return hl_surface_vector(edge != HL_NO_EDGE ? all->edge_normals[mesh->first_edge_normal + edge]
                                              : all->normals[all->triangles[triangle][i]]);
}

vec3 hl_rounded_normal(const surfaces *all, const surface_mesh *mesh, uint32_t triangle, int i, vec3 flat) {
  vec3 own = corner_normal(all, mesh, triangle, i);
  double along = vec3_dot(own, flat);
  if (fabs(along) < HL_MESH_ROUNDED) return flat;
  return along < 0 ? vec3_scale(own, -1) : own;
}

static vec3 smooth_normal(const surfaces *all, const surface_mesh *mesh, uint32_t triangle,
                          const double weight[3], vec3 flat) {
  vec3 sum = {0, 0, 0};
  for (int i = 0; i < 3; i++)
    sum = vec3_add(sum, vec3_scale(hl_rounded_normal(all, mesh, triangle, i, flat), weight[i]));
  return vec3_normalise(sum);
}

/* The colour of a mesh's material times that of a row of its colours; null: white. */
static void set_color(const surface_mesh *mesh, const float *own, double color[3]) {
  for (int c = 0; c < 3; c++) color[c] = mesh->scene->color[c] * (own != NULL ? (double)own[c] : 1);
}

static void interpolate_color(const surface_mesh *mesh, const uint32_t *corner, const double weight[3],
                              double color[3]) {
  for (int c = 0; c < 3; c++) {
    double own = 0;
    for (int i = 0; i < 3; i++) own += weight[i] * mesh->colors[corner[i] - mesh->first_vertex][c];
    color[c] = mesh->scene->color[c] * own;
  }
}

/* Finds the normal and colour of a triangle's point; returns the triangle's own normal. */
static vec3 find_on_triangle(const surfaces *all, const surface_mesh *mesh, uint32_t triangle,
                             surface_point *point) {
  const uint32_t *corner = all->triangles[triangle];
  vec3 at[3];
  double weight[3];
  for (int i = 0; i < 3; i++) at[i] = hl_surface_vector(all->positions[corner[i]]);
  vec3 cross = vec3_cross(vec3_subtract(at[1], at[0]), vec3_subtract(at[2], at[0])),
       flat = vec3_normalise(cross);
  find_weights(at, cross, point->position, weight);
  point->normal = mesh->scene->smooth ? smooth_normal(all, mesh, triangle, weight, flat) : flat;
  if (mesh->face_colors != NULL)
    set_color(mesh, mesh->face_colors[triangle - mesh->first_triangle], point->color);
  else if (mesh->colors != NULL) interpolate_color(mesh, corner, weight, point->color);
  else set_color(mesh, NULL, point->color);
  return flat;
}

static vec3 find_on_sphere(const surfaces *all, const surface_mesh *mesh, uint32_t sphere,
                           surface_point *point) {
  const float(*colors)[4] = mesh->sphere_colors;
  set_color(mesh, colors != NULL ? colors[sphere - mesh->first_sphere] : NULL, point->color);
  point->normal = vec3_normalise(vec3_subtract(point->position, hl_surface_vector(all->spheres[sphere])));
  return point->normal;
}

surface_point hl_surface_point_of(const sweep *sweep, const tile_slab *slab, const fragment *f) {
  const surfaces *all = sweep->frame->surfaces;
  const surface_mesh *mesh = &all->meshes[f->mesh];
  const view *eye = &sweep->frame->eye;
  surface_point point = {.position = hl_surface_place(sweep, slab, f, (double)f->height)};
  point.towards_eye = eye->perspective ? vec3_normalise(vec3_subtract(eye->origin, point.position))
                                       : vec3_scale(eye->direction, -1);
  vec3 flat = hl_is_triangle(all, f->primitive)
                  ? find_on_triangle(all, mesh, f->primitive, &point)
                  : find_on_sphere(all, mesh, f->primitive - all->triangle_count, &point);
  if (vec3_dot(flat, point.towards_eye) >= 0) return point;
  point.normal = vec3_scale(point.normal, mesh->scene->two_sided ? -1 : 0);
  if (!mesh->scene->two_sided) point.color[0] = point.color[1] = point.color[2] = 0;
  return point;
}
