/* surface/primitive.h - the interface of a kind of primitive: of triangles, and of spheres. (Tubes are
 * triangles and spheres: mesh/tubes.c.)
 *
 * A kind is a table in a file of its own. Other code asks the table and names no kind. The functions for
 * sixteen primitives at a time (small_triangles.h, small_spheres_lanes.h) are made for one kind each: the
 * kind's raster, primitive_raster.h, calls them. */
#ifndef HL_SURFACE_PRIMITIVE_H
#define HL_SURFACE_PRIMITIVE_H

#include "surface/surface_plane.h"

typedef struct primitive_raster primitive_raster; /* primitive_raster.h */

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
  const char *noun; /* what people call several of them */
  /* Whether primitives are flat between three corners, which all->triangles lists: they have one normal and
   * one plane, and clusters of them keep a copy of their vertices. */
  bool has_corners;
  const primitive_raster *raster; /* what views see of it */
  /* The number of a mesh's first primitive of this kind, and how many it has. */
  uint32_t (*first)(const surfaces *all, const surface_mesh *mesh);
  uint32_t (*count)(const surface_mesh *mesh);
  /* A point of it; [3]. */
  const float *(*place)(const surfaces *all, uint32_t primitive);
  /* A box around it, wider by what rounding may take. */
  void (*bound)(const surfaces *all, uint32_t primitive, float low[3], float high[3]);
  /* The fraction of light that it stops, at its middle. */
  double (*opacity)(const surfaces *all, const surface_mesh *mesh, uint32_t primitive);
  /* Its unit normal where a ray met it; *from: a point's distance from the plane there, on the normal's side
   * above 0. */
  vec3 (*normal)(const surfaces *all, uint32_t primitive, vec3 met, vec3 point, double *from);
  /* The plane in which it lies, or which touches it where it was met, as a view sees it. */
  void (*plane)(const view *view, const sheet_stack *sheets, const surfaces *all, uint32_t primitive,
                vec3 met, surface_plane *plane);
  /* The interpolated unit normal and the linear RGB colour of its mesh at a point of it; returns the unit
   * normal of the primitive itself, on the side of *normal. */
  vec3 (*look)(const surfaces *all, const surface_mesh *mesh, uint32_t primitive, vec3 at, vec3 *normal,
               double color[3]);
  /* How much the surface is bent towards a light: the turn of its normal, which lies on the eye's side, per
   * length of the unit way `along` it; above 0 in a hollow. 0: flat, rough, or light passes it. */
  double (*bend)(const surfaces *all, const surface_mesh *mesh, uint32_t primitive, vec3 at, vec3 normal,
                 vec3 along);
  /* Where a ray meets it: [return value], in lengths of the ray's way. */
  int (*intersect)(const surfaces *all, uint32_t primitive, const surface_ray *ray, double distance[2]);
  /* Whether the convex hull of balls has points on both sides of it; what lies beyond it by less than `least`
   * counts as being on it. */
  bool (*parts)(const surfaces *all, uint32_t primitive, const hull_ball *balls, int count, double least);
} primitive_kind;

/* The registry of kinds, in the order of their primitives' numbers. A kind "sphere" has the table
 * hl_primitive_sphere in sphere.c, and the table hl_raster_sphere in sphere_raster.c. The build reads the
 * names here. */
/* clang-format off */
#define HL_PRIMITIVES     \
  HL_PRIMITIVE(triangle)  \
  HL_PRIMITIVE(sphere)
/* clang-format on */

#define HL_PRIMITIVE(name) PRIMITIVE_##name,
enum primitive_number { HL_PRIMITIVES PRIMITIVE_KINDS };
#undef HL_PRIMITIVE
#define HL_PRIMITIVE(name) extern const primitive_kind hl_primitive_##name;
HL_PRIMITIVES
#undef HL_PRIMITIVE
#define HL_PRIMITIVE(name) &hl_primitive_##name,
static const primitive_kind *const hl_primitive_kinds[PRIMITIVE_KINDS] = {HL_PRIMITIVES};
#undef HL_PRIMITIVE

/* The table of a primitive's kind. */
static inline const primitive_kind *hl_primitive_kind(const surfaces *all, uint32_t primitive) {
  return primitive < all->triangle_count ? &hl_primitive_triangle : &hl_primitive_sphere;
}

static inline bool hl_has_corners(const surfaces *all, uint32_t primitive) {
  return hl_primitive_kind(all, primitive)->has_corners;
}

/* Of a sphere: its centre and radius. */
static inline const float *hl_sphere_of(const surfaces *all, uint32_t primitive) {
  return all->spheres[primitive - all->triangle_count];
}

/* The index of the mesh that a primitive belongs to. Slow: fragments know theirs. */
size_t hl_surface_mesh_of(const surfaces *all, uint32_t primitive);

/* The first primitive after those of the mesh that are of this one's kind. */
uint32_t hl_surface_mesh_end(const surfaces *all, size_t mesh, uint32_t primitive);

/* The fraction of light that a primitive stops, at its middle. */
float hl_primitive_opacity(const surfaces *all, const surface_mesh *mesh, uint32_t primitive);

/* The colour of a mesh's material times a row of the mesh's colours; null: white. Linear RGB. */
static inline void hl_primitive_color(const surface_mesh *mesh, const float *own, double color[3]) {
  for (int c = 0; c < 3; c++) color[c] = mesh->look.color[c] * (own != NULL ? (double)own[c] : 1);
}

#endif
