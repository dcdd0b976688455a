/* render/surface_batch.h - lights and composites fragments of one mesh together. */
#ifndef HL_RENDER_SURFACE_BATCH_H
#define HL_RENDER_SURFACE_BATCH_H

#include "render/surface_samples.h"
#include "render/sweep.h"

typedef struct surface_batch {
  const fragment *fragments[SURFACE_SAMPLES]; /* [count]; borrowed */
  int count;
  const surface_mesh *mesh;
  surface_samples samples;
} surface_batch;

/* Finds the samples of the batch's fragments, in a tile. */
void hl_surface_batch_place(const sweep *sweep, const tile_slab *slab, surface_batch *batch);

/* Composites the batch's lit samples into the picture (step 16). pixels: the tile's pixels, [16 blocks][R G
 * B A][16]. */
void hl_surface_batch_composite(const surface_batch *batch, int back_to_front, float *pixels);

#endif
