/* surface/primitive.h - declares the interface of a kind of primitive: triangles or spheres. (Tubes are
 * triangles and spheres: mesh/tubes.c.) primitive_kinds.h lists the kinds.
 *
 * Each kind has a table in a file of its own. Other code calls the functions of the table, and does not name
 * kinds. Some functions work on sixteen primitives of one kind at a time (small_triangles.h,
 * small_spheres_lanes.h). The kind's raster (primitive_raster.h) calls them. */
#ifndef HL_SURFACE_PRIMITIVE_H
#define HL_SURFACE_PRIMITIVE_H

#include "core/memory.h"
#include "surface/surface_plane.h"

typedef struct primitive_lattice primitive_lattice; /* see primitive_lattice.h */
typedef struct primitive_raster primitive_raster;   /* see primitive_raster.h */

/* A ray: the points origin + s way, for all s between `first` and `last`. These bounds may be infinite. */
typedef struct surface_ray {
  vec3 origin, way;
  double first, last;
} surface_ray;

/* One of the balls whose convex hull is compared with a primitive (primitive_kind.parts). */
typedef struct hull_ball {
  vec3 at;
  double radius;
} hull_ball;

typedef struct primitive_kind {
  const char *noun; /* the kind's name in messages, in the plural */
  /* Whether primitives of the kind are flat, and lie between three corners, which all->triangles lists. Such
   * a primitive has one normal and one plane, and its cluster keeps a copy of its vertices. */
  bool has_corners;
  const primitive_raster *raster;   /* the functions that find how views see the kind's primitives */
  const primitive_lattice *lattice; /* the functions that find where lines through a lattice meet the kind's
                                     * primitives */
  /* Returns the number of primitives of the kind in a mesh. */
  size_t (*count)(const hl_mesh_description *mesh);
  /* Lays out the arrays that hold this kind's primitives of all meshes. */
  void (*lay_out)(surfaces *made, hl_layout *layout);
  /* Brings the primitives of a mesh to frame space. */
  void (*place)(hl_pool *pool, surfaces *made, const surface_mesh *mesh);
  /* Returns the coordinates of a point of a primitive, an array [3] in frame space. Primitives are ordered by
   * these points. */
  const float *(*point)(const surfaces *all, uint32_t primitive);
  /* Finds a box around a primitive. The box is so large that the primitive lies within it despite
   * rounding. */
  void (*bound)(const surfaces *all, uint32_t primitive, float low[3], float high[3]);
  /* The fraction of light that a primitive absorbs, at its middle. */
  double (*opacity)(const surfaces *all, const surface_mesh *mesh, uint32_t primitive);
  /* The unit normal of a primitive at `met`, where a ray has met the primitive. *from: receives the distance
   * of `point` from the plane that touches the primitive at `met`, above 0 on the normal's side. */
  vec3 (*normal)(const surfaces *all, uint32_t primitive, vec3 met, vec3 point, double *from);
  /* Describes a plane as a view sees it: the plane of a primitive, or the plane that touches the primitive
   * where a ray has met it. */
  void (*plane)(const view *view, const sheet_stack *sheets, const surfaces *all, uint32_t primitive,
                vec3 met, surface_plane *plane);
  /* Finds the interpolated unit normal and the linear RGB colour at a point of a primitive. Returns the
   * primitive's own unit normal, on the side of *normal. */
  vec3 (*look)(const surfaces *all, const surface_mesh *mesh, uint32_t primitive, vec3 at, vec3 *normal,
               double color[3]);
  /* Finds the bend of the surface in a direction: the change, per length, of the normal on the eye's side.
   * along: the direction, a unit vector on the surface. The bend is above 0 in a hollow. It is 0 for a
   * surface that is flat, rough or lets light pass. */
  double (*bend)(const surfaces *all, const surface_mesh *mesh, uint32_t primitive, vec3 at, vec3 normal,
                 vec3 along);
  /* Finds where a ray meets a primitive, as values of s on the ray. Returns the number of places that were
   * stored. */
  int (*intersect)(const surfaces *all, uint32_t primitive, const surface_ray *ray, double distance[2]);
  /* Returns whether the convex hull of some balls has points on both sides of a primitive. Points that lie
   * beyond the primitive by less than `least` count as lying on it. */
  bool (*parts)(const surfaces *all, uint32_t primitive, const hull_ball *balls, int count, double least);
} primitive_kind;

#define HL_PRIMITIVE(name) extern const primitive_kind hl_primitive_##name;
HL_PRIMITIVES
#undef HL_PRIMITIVE
#define HL_PRIMITIVE(name) &hl_primitive_##name,
static const primitive_kind *const hl_primitive_kinds[PRIMITIVE_KINDS] = {HL_PRIMITIVES};
#undef HL_PRIMITIVE

/* Returns the number of a primitive's kind in the list of kinds (primitive_kinds.h). */
static inline int hl_primitive_number(const surfaces *all, uint32_t primitive) {
  int kind = 0;
  while (kind + 1 < PRIMITIVE_KINDS && primitive >= all->first[kind + 1]) kind++;
  return kind;
}

/* The table of a primitive's kind. */
static inline const primitive_kind *hl_primitive_kind(const surfaces *all, uint32_t primitive) {
  return hl_primitive_kinds[hl_primitive_number(all, primitive)];
}

static inline bool hl_has_corners(const surfaces *all, uint32_t primitive) {
  return hl_primitive_kind(all, primitive)->has_corners;
}

/* The centre and the radius of a primitive, which must be a sphere. */
static inline const float *hl_sphere_of(const surfaces *all, uint32_t primitive) {
  return all->spheres[primitive - all->first[PRIMITIVE_sphere]];
}

/* Finds the index of the mesh to which a primitive belongs. The search is slow; a fragment stores its mesh
 * instead. */
size_t hl_surface_mesh_of(const surfaces *all, uint32_t primitive);

/* The fraction of light that a primitive absorbs, at its middle. */
float hl_primitive_opacity(const surfaces *all, const surface_mesh *mesh, uint32_t primitive);

/* Multiplies the colour of a mesh's material by a row of the mesh's own colours, linear RGB. row: null stands
 * for white everywhere. */
static inline void hl_primitive_color(const surface_mesh *mesh, const float *own, double color[3]) {
  for (int c = 0; c < 3; c++) color[c] = mesh->look.color[c] * (own != NULL ? (double)own[c] : 1);
}

#endif
