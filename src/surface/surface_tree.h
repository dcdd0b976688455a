/* surface/surface_tree.h - makes a tree of boxes around triangles and spheres. The tree finds where single
 * rays meet triangles and spheres.
 *
 * The rays belong to no view. They are rays between a light and the nodes of a coarse grid, the lines of this
 * grid, and short rays from points of surfaces towards a light. The tree holds primitives that cast
 * shadows. */
#ifndef HL_SURFACE_SURFACE_TREE_H
#define HL_SURFACE_SURFACE_TREE_H

#include "core/memory.h"
#include "surface/primitive.h"

typedef struct surface_box {
  float low[3], high[3];
  uint32_t first, count; /* for a leaf: the first index and the number of its primitives in `primitives`. For
                          * any other node: count is 0, and `first` is the index of the node's second child;
                          * the first child is the next node after this node */
} surface_box;

/* The parts of a mesh that a tree can hold. HELD_NOT: nothing. HELD_WHOLE: primitives of a mesh that no cut
 * cuts. HELD_CUT: primitives of a mesh that cuts cut. */
typedef enum mesh_held { HELD_NOT, HELD_WHOLE, HELD_CUT } mesh_held;

typedef struct surface_tree {
  const surfaces *all;  /* the surfaces whose primitives the tree holds; borrowed */
  uint32_t *primitives; /* [count]; in the order of leaves; owned, as one block with the next two arrays */
  mesh_held *holds;     /* [mesh_count of all]; the part of each mesh that the tree holds */
  cut_shape *cuts;      /* [cut_count]; the cuts that `all` had when the tree was created */
  size_t cut_count;
  double distance;    /* the distance for which the tree was created */
  surface_box *boxes; /* owned; [box_count]; the nodes of the tree; the root is the first one */
  uint32_t count, box_count;
} surface_tree;

/* A tree is created for a distance, which decides which primitives the tree holds. ALL_SURFACES: all
 * primitives of meshes that absorb light. A finite distance, in frame units: only primitives of meshes that
 * are not closed, or that cuts cut; of these, the triangles within this distance of an open edge, a cut or a
 * corner (late/surface_rims.h), and the spheres that cuts cut. */
#define ALL_SURFACES INFINITY

/* Creates a tree. all: the surfaces; null if there are no surfaces. The tree may be released even if it was
 * not created, but is all zeros. */
hl_status hl_surface_tree_create(hl_context *context, const surfaces *all, double distance,
                                 surface_tree *tree, hl_error *error);
/* Returns whether a tree that was kept is the same as a tree that would be created now. */
bool hl_surface_tree_current(const surface_tree *tree, const surfaces *all, double distance);
void hl_surface_tree_release(hl_context *context, surface_tree *tree);

/* Counts the greatest amount of memory that hl_surface_tree_create() can take. It takes this amount if all
 * triangles of the meshes that are not closed lie within the distance. Returns false if the tree holds
 * nothing. */
bool hl_surface_tree_count(const surfaces *all, double distance, hl_layout *layout);

/* Returns whether a mesh absorbs light: it casts a shadow, and its opacity is above 0. */
static inline bool hl_mesh_takes_light(const surface_mesh *mesh) {
  return mesh->look.casts_shadow && mesh->look.opacity > 0;
}

/* A place where a ray meets a surface. */
typedef struct surface_hit {
  vec3 at;
  double distance; /* distance of the place from the ray's origin, in lengths of the vector surface_ray.way */
  double opacity;  /* the fraction of light that the primitive absorbs */
  uint32_t primitive;
  const surface_mesh *mesh; /* the mesh to which the primitive belongs */
  int ray;                  /* in a bundle of rays: the number of the ray in the bundle; else 0 */
} surface_hit;

/* The function that is called for each place where a ray meets a surface, in any order. */
typedef void surface_met(void *data, const surface_hit *hit);

/* Returns whether the box of any primitive in the tree overlaps the given box. */
bool hl_surface_tree_overlaps(const surface_tree *tree, const double low[3], const double high[3]);

/* Returns whether some primitive may meet the convex hull of balls. A triangle does not meet the hull if the
 * hull lies on one side of the triangle's plane. A sphere does not meet the hull if the hull lies within the
 * sphere, or beyond a plane that touches the sphere. Points that lie beyond a surface by less than `least`
 * count as lying on it. */
bool hl_surface_tree_reaches(const surface_tree *tree, const hull_ball *balls, int count, double least);

void hl_surface_tree_cast(const surface_tree *tree, const surface_ray *ray, surface_met *met, void *data);

/* Does the work of hl_surface_tree_cast() for at most MOST_BUNDLED rays that come from one point and have
 * finite ends. A box that none of the rays can meet is skipped for all rays at once. Each ray gets the same
 * hits as from hl_surface_tree_cast(), in the same order. */
enum { MOST_BUNDLED = 16 };
void hl_surface_tree_cast_bundle(const surface_tree *tree, const surface_ray *rays, int count,
                                 surface_met *met, void *data);

#endif
