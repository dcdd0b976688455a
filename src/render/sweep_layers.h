/* render/sweep_layers.h - makes the layers of a sweep: its tiles are shaded once more for each layer. */
#ifndef HL_RENDER_SWEEP_LAYERS_H
#define HL_RENDER_SWEEP_LAYERS_H

#include "render/surface_batch.h"

/* hl_sweep_layers_begin() is called at the end of hl_sweep_begin(). hl_sweep_layers_tile() shades one tile
 * for every layer. hl_sweep_layers_batch() shades fragments of a tile for every layer; the samples of the
 * batch must have been placed. */
hl_status hl_sweep_layers_begin(sweep *sweep, hl_error *error);
void hl_sweep_layers_end(sweep *sweep);
/* Counts the memory that hl_sweep_layers_begin() takes. Sets no pointers. */
void hl_sweep_layers_count(sweep *sweep, hl_layout *layout);
void hl_sweep_layers_tile(const sweep *sweep, const tile_slab *slab);
void hl_sweep_layers_batch(const sweep *sweep, const tile_slab *slab, const surface_batch *batch);

#endif
