/* isosurface/isosurface.h - a surface on which the kernel's field has one value, as a mesh. */
#ifndef HL_ISOSURFACE_ISOSURFACE_H
#define HL_ISOSURFACE_ISOSURFACE_H

#include "core/pool.h"
#include "grid/grid.h"
#include "mesh/mesh.h"

/* The mesh of the value in the volume's box, in the world of the volume's own file times its axis_scale: the
 * rest of the volume's transform is the mesh's. Owned by the caller; null where the surface is empty. grid:
 * of the volume, for the kernel. */
hl_status hl_isosurface_create(hl_pool *pool, const hl_scene_volume *volume, const grid *grid,
                               const kernel *kernel, double value, hl_mesh **mesh, hl_error *error);

/* Surface i of a volume as a mesh of the scene, with the volume's transform and material. mesh: borrowed. */
hl_scene_mesh hl_scene_mesh_of_iso(const hl_scene_volume *volume, size_t i, hl_mesh *mesh);

#endif
