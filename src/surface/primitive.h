/* surface/primitive.h - the interface of a kind of primitive: of triangles, and of spheres. (Tubes are
 * triangles and spheres: mesh/tubes.c.)
 *
 * A kind is a table of functions in a file of its own. Whatever asks one primitive at a time asks the table
 * of its kind. What works on many primitives at a time is made for one kind (small_triangles.h,
 * small_spheres_lanes.h, the vertices of clusters): it asks once for each batch which kind it has. */
#ifndef HL_SURFACE_PRIMITIVE_H
#define HL_SURFACE_PRIMITIVE_H

#include "surface/surface_plane.h"

/* The points origin + s way with first < s < last, which may be infinite. */
typedef struct surface_ray {
  vec3 origin, way;
  double first, last;
} surface_ray;

/* A ball of points of a hull. */
typedef struct hull_ball {
  vec3 at;
  double radius;
} hull_ball;

typedef struct primitive_kind {
  /* The number of a mesh's first primitive of this kind, and how many it has. */
  uint32_t (*first)(const surfaces *all, const surface_mesh *mesh);
  uint32_t (*count)(const surface_mesh *mesh);
  /* A point of it; [3]. */
  const float *(*place)(const surfaces *all, uint32_t primitive);
  /* A box around it, wider by what rounding may take. */
  void (*bound)(const surfaces *all, uint32_t primitive, float low[3], float high[3]);
  /* The fraction of light that it stops, at its middle. */
  float (*opacity)(const surfaces *all, const surface_mesh *mesh, uint32_t primitive);
  /* Its unit normal where a ray met it; *from: a point's distance from the plane there, on the normal's side
   * above 0. */
  vec3 (*normal)(const surfaces *all, uint32_t primitive, vec3 met, vec3 point, double *from);
  /* The plane in which it lies, or which touches it where it was met, as a view sees it. */
  void (*plane)(const view *view, const sheet_stack *sheets, const surfaces *all, uint32_t primitive,
                vec3 met, surface_plane *plane);
  /* Where a ray meets it: [return value], in lengths of the ray's way. */
  int (*intersect)(const surfaces *all, uint32_t primitive, const surface_ray *ray, double distance[2]);
  /* Whether the convex hull of balls has points on both sides of it; what lies beyond it by less than `least`
   * counts as being on it. */
  bool (*parts)(const surfaces *all, uint32_t primitive, const hull_ball *balls, int count, double least);
} primitive_kind;

extern const primitive_kind hl_primitive_triangle, hl_primitive_sphere;

/* The table of a primitive's kind. */
static inline const primitive_kind *hl_primitive_kind(const surfaces *all, uint32_t primitive) {
  return primitive < all->triangle_count ? &hl_primitive_triangle : &hl_primitive_sphere;
}

static inline bool hl_is_triangle(const surfaces *all, uint32_t primitive) {
  return primitive < all->triangle_count;
}

/* Of a sphere: its centre and radius. */
static inline const float *hl_sphere_of(const surfaces *all, uint32_t primitive) {
  return all->spheres[primitive - all->triangle_count];
}

/* The index of the mesh that a primitive belongs to. Slow: fragments know theirs. */
size_t hl_surface_mesh_of(const surfaces *all, uint32_t primitive);

/* The first primitive after those of the mesh that are of this one's kind. */
uint32_t hl_surface_mesh_end(const surfaces *all, size_t mesh, uint32_t primitive);

/* The fraction of light that a mesh's surface stops, at the middle of a triangle. */
float hl_primitive_opacity(const surfaces *all, const surface_mesh *mesh, uint32_t primitive);

/* A triangle's unit normal; *from: a point's distance from its plane, on the normal's side above 0. */
vec3 hl_triangle_normal(const surfaces *all, uint32_t triangle, vec3 point, double *from);

#endif
