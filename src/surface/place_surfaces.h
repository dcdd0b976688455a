/* surface/place_surfaces.h - brings meshes to frame space, finds the normals of their vertices, and cuts them
 * into clusters. */
#ifndef HL_SURFACE_PLACE_SURFACES_H
#define HL_SURFACE_PLACE_SURFACES_H

#include "core/memory.h"
#include "core/pool.h"
#include "surface/surfaces.h"

/* Brings surfaces up to date. kept: at first a struct of zeros, later the surfaces of an earlier frame.
 * scene: in frame space; the descriptions of its meshes are borrowed for the frame. */
hl_status hl_surfaces_update(hl_context *context, hl_pool *pool, const hl_scene_description *scene,
                             surfaces *kept, hl_error *error);
void hl_surfaces_release(hl_context *context, surfaces *kept);

/* Counts the memory that hl_surfaces_update() takes if nothing can be kept from an earlier frame. Fails where
 * 32 bits cannot number all primitives. */
hl_status hl_surfaces_count_memory(const hl_scene_description *scene, hl_layout *layout, hl_error *error);

/* Returns whether the meshes are the same as in the earlier frame, and stand in the same places. If so, an
 * update allocates only a few cuts. */
bool hl_surfaces_current(const surfaces *kept, const hl_scene_description *scene);

#endif
