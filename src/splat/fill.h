/* splat/fill.h - filling the tiles of a sheet: one interface, two ways.
 *
 * splat pushes every voxel's footprint section onto the tile (the paper's way); gather pulls, for every
 * pixel still needed, the same sum over the 4x4x4 voxels around it. Both give the same densities to
 * rounding. A tile is 16x16 pixels, kept as sixteen 4x4 blocks of sixteen lanes. */
#ifndef HL_SPLAT_FILL_H
#define HL_SPLAT_FILL_H

#include "splat/grid.h"
#include "splat/view.h"

enum { TILE = 16, BLOCK = 4, TILE_BLOCKS = 16, BLOCK_PIXELS = 16, TILE_PIXELS = 256, ALL_BLOCKS = 0xffff };

/* Tiles that cover so many pixels. */
static inline int hl_tiles(int pixels) { return (pixels + TILE - 1) / TILE; }

/* Voxels sorted for splatting: by tile of the view, then by the first sheet that their kernels touch. */
typedef struct voxel_lists {
  int tiles_x, tiles_y;
  int bucket_count; /* sheets + span - 1 */
  int span; /* sheets that a kernel can touch; sheet k reads buckets k .. k + span - 1. At the border, where
               values continue, voxels touch more and are listed again every span sheets */
  uint32_t *start; /* owned; [tiles * bucket_count + 1] */
  uint32_t *voxel; /* owned; [start[last]]; index in the grid padded by 2 voxels on every side */
} voxel_lists;

/* What it takes to fill one sheet of one grid in one view. */
typedef struct fill_source {
  const grid *grid;
  const kernel *kernel;
  const struct classifier
      *classifier;          /* blocks below all that it shows are not returned; null: all may show */
  sheet_rays rays;          /* pixels -> index space */
  const voxel_lists *lists; /* splat only */
  int sheet;
} fill_source;

/* Blocks of a tile, one bit each: those that were filled, and those of them in which some pixel may show
 * something, alone or on the way to another density above it. */
typedef struct filled_blocks {
  uint32_t filled, showing;
} filled_blocks;

/* The pixels of some blocks. By sums of bits two by two, four by four and so on: the baseline has no
 * instruction for it. */
static inline uint64_t hl_pixels_of_blocks(uint32_t blocks) {
  blocks -= blocks >> 1 & 0x5555;
  blocks = (blocks & 0x3333) + (blocks >> 2 & 0x3333);
  blocks = (blocks + (blocks >> 4)) & 0x0f0f;
  return (uint64_t)((blocks + (blocks >> 8)) & 31) * BLOCK_PIXELS;
}

/* Fills density[16][16] (block, lane) for the blocks in need, and for those of some others that the cells
 * around their points let show something (cell_bits.h); what is left is left alone. */
typedef filled_blocks fill_tile_function(const fill_source *source, int tile_x, int tile_y, uint32_t need,
                                         uint32_t others, float *density);

/* A few sheets one after another, and the slabs between them. */
enum { RUN_SLABS = 4 };
typedef struct slab_run {
  const grid *grid;
  sheet_rays rays[RUN_SLABS + 1]; /* pixels -> index space */
  float low[3], high[3];          /* what lies between is not cut by the box */
} slab_run;

/* Of a tile, slab by slab, the needed blocks whose boxes may hold something of the grid that matters, and
 * whether the box leaves all of those whole. */
typedef struct relevant_blocks {
  uint16_t blocks[RUN_SLABS];
  uint16_t whole; /* one bit a slab */
} relevant_blocks;

/* Fills what is asked of the run's slabs, one bit each; others are left alone. need: the blocks that are
 * wanted. */
typedef void relevant_blocks_function(const slab_run *run, int tile_x, int tile_y, uint32_t slabs,
                                      uint32_t need, relevant_blocks *found);

#endif
