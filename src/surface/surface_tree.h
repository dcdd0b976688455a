/* surface/surface_tree.h - a tree of boxes over triangles and spheres: where single rays meet them.
 *
 * For rays that belong to no view: those between a light and the nodes of a coarse grid, and the grid's
 * lines. The tree holds what casts shadows. */
#ifndef HL_SURFACE_SURFACE_TREE_H
#define HL_SURFACE_SURFACE_TREE_H

#include "surface/surfaces.h"

typedef struct surface_box {
  float low[3], high[3];
  uint32_t first, count; /* of a leaf: among the tree's primitives; of others count is 0 and `first` the
                            second child: the first one follows its parent */
} surface_box;

typedef struct surface_tree {
  const surfaces *all;  /* borrowed */
  uint32_t *primitives; /* owned; [count]; sorted by leaves */
  surface_box *boxes;   /* owned; [box_count]; the root is the first */
  uint32_t count, box_count;
} surface_tree;

/* all: null for none. A tree that was not created is all zero, and may be released. */
hl_status hl_surface_tree_create(hl_context *context, const surfaces *all, surface_tree *tree,
                                 hl_error *error);
void hl_surface_tree_release(hl_context *context, surface_tree *tree);

/* The most bytes of a tree over all meshes of a scene. */
uint64_t hl_surface_tree_bytes(const hl_scene_description *scene);

/* Whether a mesh takes light away. */
static inline bool hl_mesh_takes_light(const hl_scene_mesh *mesh) {
  return mesh->casts_shadow && mesh->opacity > 0;
}

/* Called for each place where a ray meets a surface, in any order. distance: along the ray, in lengths of its
 * way; opacity: of the primitive; mesh: its own. */
typedef void surface_met(void *data, double distance, double opacity, const hl_scene_mesh *mesh);

/* The points origin + s way with first < s < last, which may be infinite. */
typedef struct surface_ray {
  vec3 origin, way;
  double first, last;
} surface_ray;

void hl_surface_tree_cast(const surface_tree *tree, const surface_ray *ray, surface_met *met, void *data);

#endif
