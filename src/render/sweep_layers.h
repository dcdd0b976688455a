/* render/sweep_layers.h - the layers of a sweep: its tiles shaded once more for each of them. */
#ifndef HL_RENDER_SWEEP_LAYERS_H
#define HL_RENDER_SWEEP_LAYERS_H

#include "render/surface_batch.h"

/* Begin is called at the end of hl_sweep_begin; tile shades one tile of every layer, and batch, whose samples
 * are placed, the fragments of a tile. */
hl_status hl_sweep_layers_begin(sweep *sweep, hl_error *error);
void hl_sweep_layers_end(sweep *sweep);
/* Counts what begin takes; sets no pointers. */
void hl_sweep_layers_count(sweep *sweep, hl_layout *layout);
void hl_sweep_layers_tile(const sweep *sweep, const tile_slab *slab);
void hl_sweep_layers_batch(const sweep *sweep, const tile_slab *slab, const surface_batch *batch);

#endif
