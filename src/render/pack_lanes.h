/* render/pack_lanes.h - packs a tile's samples before they are lit. If only some of a block's pixels may show
 * something, the pixels of several blocks are put together into sixteen lanes. */
#ifndef HL_RENDER_PACK_LANES_H
#define HL_RENDER_PACK_LANES_H

#include "render/slab_lanes.h"
#include "simd/packing.h"

/* The packed slab that holds a block's pixels. whole: the packed slab holds this block alone, and all
 * sixteen pixels keep their places. */
typedef struct packed_block {
  lanes_packing packing;
  int slab, whole;
} packed_block;

typedef struct packed_tile {
  block_slab slabs[TILE_BLOCKS];
  int filled[TILE_BLOCKS]; /* number of used lanes of each slab */
  int slab_count;
  packed_block blocks[TILE_BLOCKS];
} packed_tile;

/* A patch's scratch holds a block_density for a block before it is packed, followed by one for each packed
 * slab. For all patches together these are [1 + TILE_BLOCKS][patches]. */
_Static_assert((1 + TILE_BLOCKS) * sizeof(block_density) <= SHADE_SCRATCH_BYTES,
               "a volume's scratch holds its slabs");

/* Adds a packed slab with no pixel in any lane. Returns its number. */
LANES_INLINE int add_slab(packed_tile *tile, int patch_count, block_density *densities) {
  int s = tile->slab_count++;
  tile->filled[s] = 0;
  tile->slabs[s].u = tile->slabs[s].v = lanes_set(0);
  tile->slabs[s].starts = 0;
  for (int i = 0; i < patch_count; i++) densities[(size_t)s * (size_t)patch_count + (size_t)i].there = 0;
  return s;
}

/* Finds the first packed slab that has at least lanes_wanted free lanes. If there is none, adds a slab. */
LANES_INLINE int slab_with_room(packed_tile *tile, int lanes_wanted, int patch_count,
                                block_density *densities) {
  for (int s = 0; s < tile->slab_count; s++)
    if (tile->filled[s] + lanes_wanted <= LANES) return s;
  return add_slab(tile, patch_count, densities);
}

/* A block_way consists of lanes only, so it is copied lane by lane. */
enum { WAY_LANES = sizeof(block_way) / sizeof(lanes) };

LANES_INLINE void pack_way(const lanes_packing *packing, const block_density *from, block_density *into) {
  const lanes *source = (const lanes *)&from->way;
  lanes *way = (lanes *)&into->way;
  for (int i = 0; i < WAY_LANES; i++)
    way[i] = lanes_pack(packing, into->there ? way[i] : lanes_set(0), source[i]);
  into->patch = from->patch;
  into->there = 1;
}

/* Packs a block all of whose pixels may show something: it gets a packed slab of its own. */
LANES_INLINE void keep_block(packed_tile *tile, const block_slab *block, const block_density *ways,
                             int patch_count, block_density *densities, packed_block *packed) {
  int s = add_slab(tile, patch_count, densities);
  tile->slabs[s].u = block->u;
  tile->slabs[s].v = block->v;
  tile->slabs[s].starts = 1;
  tile->slabs[s].open = lanes_set_int(-1);
  tile->filled[s] = LANES;
  for (int i = 0; i < patch_count; i++)
    if (ways[i].there) {
      block_density *into = &densities[(size_t)s * (size_t)patch_count + (size_t)i];
      into->way = ways[i].way;
      into->patch = ways[i].patch;
      into->there = 1;
    }
  packed->slab = s;
  packed->whole = 1;
}

/* Packs the pixels of a block whose bits are set into a slab. densities: the block_density of all slabs. */
LANES_INLINE void pack_block(packed_tile *tile, const block_slab *block, const block_density *ways,
                             int patch_count, uint32_t bits, block_density *densities, packed_block *packed) {
  int count = __builtin_popcount(bits), s = slab_with_room(tile, count, patch_count, densities),
      at = tile->filled[s];
  block_slab *slab = &tile->slabs[s];
  lanes_packing packing = lanes_packing_of(bits, at);
  slab->u = lanes_pack(&packing, slab->u, block->u);
  slab->v = lanes_pack(&packing, slab->v, block->v);
  slab->starts |= 1u << at;
  tile->filled[s] += count;
  slab->open = lanes_from_bits((1u << tile->filled[s]) - 1);
  for (int i = 0; i < patch_count; i++)
    if (ways[i].there) pack_way(&packing, &ways[i], &densities[(size_t)s * (size_t)patch_count + (size_t)i]);
  *packed = (packed_block){packing, s, 0};
}

#endif
