/* fill/fill.h - fills a tile of a sheet with densities, by splatting or gathering.
 *
 * Splatting is the paper's way: it adds every voxel's footprint to the tile. Gathering sums the 4x4x4 voxels
 * around the point of every pixel that is needed. Splatting and gathering give the same densities, up to
 * rounding. */
#ifndef HL_FILL_FILL_H
#define HL_FILL_FILL_H

#include "fill/voxel_lists.h"
#include "grid/classifier.h"
#include "view/view.h"

/* The inputs of filling one sheet of one grid in one view. */
typedef struct fill_source {
  const grid *grid;
  const kernel *kernel;
  const classifier *classifier; /* tells which blocks show nothing; null if all blocks count as showing
                                 * something */
  sheet_rays rays;              /* the maps from pixels of the view to the grid's index space */
  const voxel_lists *lists;     /* the sorted voxels; only splatting reads them */
  int sheet;
} fill_source;

/* Sets of blocks of a tile, one bit for each block: the filled blocks, and the filled blocks in which some
 * pixel may show something. A pixel may show something by its own density, or by a greater density on the
 * next sheet. */
typedef struct filled_blocks {
  uint32_t filled, showing;
} filled_blocks;

/* The type of the functions that fill a tile of a sheet. These functions fill the array density[16][16]
 * (block, lane) for the blocks whose bits are set in `need`, and for the blocks of `others` whose points lie
 * in cells that may show something (grid/relevant.h). The densities of other blocks do not change. */
typedef filled_blocks fill_tile_function(const fill_source *source, int tile_x, int tile_y, uint32_t need,
                                         uint32_t others, float *density);

/* A cut of a grid, prepared for the rays of a view. */
typedef struct run_cut {
  const cut_shape *shape;
  float rows[3][4]; /* maps index space to the space of the cut's shape */
  float size[3];    /* the lengths of the rows of the map from frame space to the space of the cut's shape */
} run_cut;

/* A run: up to RUN_SLABS consecutive slabs of one grid, and the sheets around them. */
enum { RUN_SLABS = 4 };
typedef struct slab_run {
  const grid *grid;
  sheet_rays rays[RUN_SLABS + 1]; /* map pixels to index space; one map for each sheet of the run */
  float low[3], high[3];          /* corners of a box in index space within which the faces of the volume's
                                   * own box do not matter */
  const run_cut *cuts;            /* [cut_count]; the cuts that remove parts of the grid */
  int cut_count;
  float beside;   /* the distance from the slabs up to which cuts matter; frame units */
  float voxel;    /* the smallest distance between the grid's voxels; frame units */
  float steps[3]; /* the distances between voxels along the axes, in units of `voxel` */
} slab_run;

/* The blocks of a tile that may show something in a run of slabs. blocks: for each slab of the run, the
 * needed blocks of a tile in which the slab may hold something visible. uncut: whether neither the volume's
 * box nor a cut reaches into the slab in these blocks. */
typedef struct relevant_blocks {
  uint16_t blocks[RUN_SLABS];
  uint16_t uncut; /* one bit for each slab of the run */
} relevant_blocks;

/* The type of the function that finds the relevant blocks of a tile. The function sets the members of `found`
 * for the slabs whose bits are set in `slabs`; the members for other slabs do not change. need: the blocks
 * that the caller needs. */
typedef void relevant_blocks_function(const slab_run *run, int tile_x, int tile_y, uint32_t slabs,
                                      uint32_t need, relevant_blocks *found);

/* The functions of the folder fill of which each instruction set has a compiled version. */
typedef struct fill_functions {
  relevant_blocks_function *relevant_blocks;
  fill_tile_function *splat, *gather;
} fill_functions;

#endif
