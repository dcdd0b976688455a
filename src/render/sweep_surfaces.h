/* render/sweep_surfaces.h - handles surfaces in the loop over sheets. It cuts slabs at the fragments of the
 * eye's view, lights and composites fragments, and attenuates the shadow buffers by fragments of the lights'
 * views. */
#ifndef HL_RENDER_SWEEP_SURFACES_H
#define HL_RENDER_SWEEP_SURFACES_H

#include "render/sweep.h"

/* Returns whether the frame has meshes that are not visible but shade its volumes. */
bool hl_sweep_has_unseen(const sweep *sweep);

/* hl_sweep_surfaces_begin() makes the surfaces of the picture. Call it after the sweep's views and lights
 * have begun. hl_sweep_surfaces_begin_lights() makes the surfaces of the lights. Call it when it is known
 * which tiles of the lights' buffers are needed. Both functions do nothing if the frame has no surfaces. */
hl_status hl_sweep_surfaces_begin(sweep *sweep, hl_error *error);
hl_status hl_sweep_surfaces_begin_lights(sweep *sweep, hl_error *error);
void hl_sweep_surfaces_end(sweep *sweep);
/* Counts approximately the memory that hl_sweep_surfaces_begin() and hl_sweep_surfaces_begin_lights() take
 * (fragments.h), for lights whose shadows are planned. Sets no pointers. */
void hl_sweep_surfaces_count(sweep *sweep, hl_layout *layout);

/* Finds the fragments of the eye's view in a slab of a tile. Call it once for each slab, in rising order. */
fragment_range hl_sweep_surfaces_reach(const sweep *sweep, size_t tile, int slab);

/* Does steps 12 to 16 for a tile with fragments: each pixel's slab is cut at its fragments, and its pieces
 * and the fragments are composited in the order of their heights. slab->blocks: the blocks with density.
 * blocks: all blocks that must be shaded. Returns the blocks that stay open. */
uint32_t hl_sweep_surfaces_tile(const sweep *sweep, const tile_slab *slab, uint32_t blocks,
                                fragment_range range);

/* Does steps 12 to 16 for a tile that has no fragments in the slab, but may have fragments in the slabs
 * before it. Returns the blocks that stay open. */
uint32_t hl_sweep_surfaces_beside(const sweep *sweep, const tile_slab *slab);

/* Does step 17 for the surfaces of a slab in a tile of a light's buffer. Returns whether any surface absorbed
 * light. */
bool hl_sweep_surfaces_attenuate(const sweep *sweep, const attenuate_job *job, fragment_range range);
fragment_range hl_sweep_surfaces_reach_light(const sweep *sweep, int light, size_t tile, int slab);

#endif
