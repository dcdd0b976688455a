/* render/cover_lanes.h - compositing opacity alone, to find what is hidden from the eye. */
#ifndef HL_RENDER_COVER_LANES_H
#define HL_RENDER_COVER_LANES_H

#include "render/slab_lanes.h"

/* Returns true while some pixel of the block is not opaque. bits: the pixels in which something may be
 * seen. */
LANES_INLINE int cover_block(const shade_job *job, const tile_slab *tile, int block, uint32_t bits,
                             float *alpha) {
  block_density *densities = tile->scratch;
  block_slab slab;
  slab_of_block(job, tile, tile->patch_count, block, bits, densities, &slab);
  classify_slab(densities, tile->patch_count, &slab);
  lanes before = lanes_load(alpha), path = geometry_of_block(job, slab.u, slab.v).path;
  lanes opacity = lanes_keep(slab.seen, 1.0f - lanes_exp_negative(lanes_keep(slab.seen, slab.total * path)));
  lanes after = lanes_fma(opacity, 1.0f - before, before);
  lanes_store(alpha, after);
  return lanes_bits(after < OPAQUE) != 0;
}

static uint32_t cover_tile(const shade_job *job, const tile_slab *tile, float *pixels, uint64_t *samples) {
  uint32_t open = tile->blocks;
  (void)samples;
  for (uint32_t left = tile->blocks; left != 0; left &= left - 1) {
    int block = __builtin_ctz(left);
    float *alpha = pixels + (block * 4 + 3) * BLOCK_PIXELS;
    uint32_t bits = visible_in_block(job, tile->patches, tile->patch_count, block, alpha);
    if (bits != 0 && !cover_block(job, tile, block, bits, alpha)) open &= ~(1u << block);
  }
  return open;
}

#endif
