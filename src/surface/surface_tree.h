/* surface/surface_tree.h - a tree of boxes over triangles and spheres: where single rays meet them.
 *
 * For rays that belong to no view: those between a light and the nodes of a coarse grid, the grid's lines,
 * and short ones from points of surfaces towards a light. The tree holds what casts shadows. */
#ifndef HL_SURFACE_SURFACE_TREE_H
#define HL_SURFACE_SURFACE_TREE_H

#include "core/memory.h"
#include "surface/primitive.h"

typedef struct surface_box {
  float low[3], high[3];
  uint32_t first, count; /* of a leaf: among the tree's primitives; of others count is 0 and `first` the
                            second child: the first one follows its parent */
} surface_box;

/* What a tree holds of a mesh: nothing, or something, of a mesh that cuts leave whole or that they cut. */
typedef enum mesh_held { HELD_NOT, HELD_WHOLE, HELD_CUT } mesh_held;

typedef struct surface_tree {
  const surfaces *all;  /* borrowed */
  uint32_t *primitives; /* owned with the next two; [count]; sorted by leaves */
  mesh_held *holds;     /* [mesh_count of all] */
  cut_shape *cuts;      /* [cut_count]; those of `all` when it was created */
  size_t cut_count;
  double distance;    /* as it was created with */
  surface_box *boxes; /* owned; [box_count]; the root is the first */
  uint32_t count, box_count;
} surface_tree;

/* Of what a tree is made: of all meshes that take light away, with their spheres; or only of triangles of
 * meshes that are not closed, or that cuts cut, within a distance of an open edge, a cut or a corner
 * (late/surface_rims.h), in frame units, and of the spheres that cuts cut. */
#define ALL_SURFACES INFINITY

/* all: null for none. A tree that was not created is all zero, and may be released. */
hl_status hl_surface_tree_create(hl_context *context, const surfaces *all, double distance,
                                 surface_tree *tree, hl_error *error);
/* Whether a tree, of all that stays where it is, is the one that would be created. */
bool hl_surface_tree_current(const surface_tree *tree, const surfaces *all, double distance);
void hl_surface_tree_release(hl_context *context, surface_tree *tree);

/* Counts what hl_surface_tree_create() takes at most: as if each triangle of a mesh that is not closed lay
 * within the distance. False: the tree holds nothing. */
bool hl_surface_tree_count(const surfaces *all, double distance, hl_layout *layout);

/* Whether a mesh takes light away. */
static inline bool hl_mesh_takes_light(const surface_mesh *mesh) {
  return mesh->look.casts_shadow && mesh->look.opacity > 0;
}

/* A place where a ray meets a surface. */
typedef struct surface_hit {
  vec3 at;
  double distance; /* along the ray, in lengths of its way */
  double opacity;  /* of the primitive */
  uint32_t primitive;
  const surface_mesh *mesh; /* the primitive's */
  int ray;                  /* of a bundle; else 0 */
} surface_hit;

/* Called for each place where a ray meets a surface, in any order. */
typedef void surface_met(void *data, const surface_hit *hit);

/* Whether some primitive's box meets a box. */
bool hl_surface_tree_overlaps(const surface_tree *tree, const double low[3], const double high[3]);

/* Whether some primitive may meet the convex hull of balls. Triangles on whose one side all lies do not, nor
 * do spheres that all lies within, or beyond a plane that touches them; what lies beyond a surface by less
 * than `least` counts as being on it. */
bool hl_surface_tree_reaches(const surface_tree *tree, const hull_ball *balls, int count, double least);

void hl_surface_tree_cast(const surface_tree *tree, const surface_ray *ray, surface_met *met, void *data);

/* The same for at most MOST_BUNDLED rays from one point, whose ends are finite: what none of them can meet is
 * passed over once for all. Each ray has the hits, and in the order, that hl_surface_tree_cast() tells. */
enum { MOST_BUNDLED = 16 };
void hl_surface_tree_cast_bundle(const surface_tree *tree, const surface_ray *rays, int count,
                                 surface_met *met, void *data);

#endif
