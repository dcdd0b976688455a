/* isosurface/isosurface.h - makes a mesh of the surface on which the kernel's field has one value. */
#ifndef HL_ISOSURFACE_ISOSURFACE_H
#define HL_ISOSURFACE_ISOSURFACE_H

#include "core/pool.h"
#include "grid/grid.h"
#include "isosurface/vertex_colors.h"
#include "mesh/mesh.h"

/* Makes the surface on which a volume's field has a value, within the volume's box. The mesh's positions are
 * in the world of the volume's file, scaled by the volume's axis_scale. The mesh of the scene that uses this
 * mesh gets the rest of the volume's transform. grid: the volume's grid, made for the kernel. coloring: null
 * if the vertices get no colours. *mesh: owned by the caller; null if the surface is empty. */
hl_status hl_isosurface_create(hl_pool *pool, const hl_scene_volume *volume, const grid *grid,
                               const kernel *kernel, double value, const iso_coloring *coloring,
                               hl_mesh **mesh, hl_error *error);

/* Describes isosurface i of a volume as a mesh of the scene, with the volume's transform and material. mesh:
 * the isosurface; borrowed. */
hl_scene_mesh hl_scene_mesh_of_iso(const hl_scene_volume *volume, size_t i, hl_mesh *mesh);

#endif
