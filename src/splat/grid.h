/* splat/grid.h - a volume as the sheets read it: voxels in place, bricks that tell where it can matter.
 *
 * Densities on sheets are differences from the grid's empty value, in stored units (what the voxels
 * hold): nothing splatted means empty, and partial sums of dropped voxels stay between empty and what
 * is transparent anyway.
 *
 * Bricks are 4x4x4 cells; the cell of a point p (index space, clamped to [-1, n)) is
 * floor(p) + 1, from 0 to n. A point's density depends on the 4x4x4 voxels around its cell. */
#ifndef HL_SPLAT_GRID_H
#define HL_SPLAT_GRID_H

#include "core/error.h"
#include "core/pool.h"
#include "scene/scene.h"
#include "splat/kernel.h"

enum {
  HL_BRICK_CELLS = 4,
  HL_NEAR_CELLS = 2,
  GRID_COLUMN = 8, /* voxels: the width of its columns (columns.h) */
  GRID_MARGIN = 4  /* voxels outside its box that a grid still continues, for slabs across its faces */
};

/* Cells, two or four along an axis together, that show something. A box of places is looked up by its first
 * cell: of `near` there, bit i + 2 j + 4 k tells whether something shows in any of the 2 + i, 2 + j, 2 + k
 * cells from there on along x, y, z. */
enum { CELL_LEVELS = 2, CELL_REACH = 3 /* cells along an axis that one look takes in */ };
typedef struct cell_level {
  int32_t count[3];
  unsigned char *near; /* owned; [count z][y][x]; null where 32 bits cannot number the cells */
} cell_level;

typedef struct grid {
  const void *voxels;     /* [dimension[2]][dimension[1]][dimension[0]]; stored values; the volume's */
  unsigned char *columns; /* owned; [column][dimension[2]][dimension[1]][GRID_COLUMN], u8 voxels again; null
                             where nothing reads them (columns.h) */
  size_t column_slice_bytes, column_bytes; /* from slice to slice, from column to column */
  hl_storage storage;
  int32_t dimension[3];
  float empty;                      /* stored units */
  double value_scale, value_offset; /* data value = value_scale * stored + value_offset */
  affine3 index_to_frame, frame_to_index;
  double box_low[3], box_high[3]; /* index space: where the volume exists */
  int32_t brick_count[3];
  void *brick_bounds; /* owned; [bricks z][y][x][2]; least and greatest stored value, of the voxels' type,
                         over the voxels that the brick's cells and their neighbours depend on */
  unsigned char *relevant;       /* owned; [bricks z][y][x]; 1 where the volume can matter */
  cell_level level[CELL_LEVELS]; /* of 2x2x2 cells, and of bricks */
  unsigned char **
      cell_bounds; /* owned; [bricks z], each owned: bounds in every 2x2x2 cells of a layer of bricks, packed
                      (cell_bounds.c): cell_base + cell_step * value; null where 32 bits cannot number them */
  float cell_base, cell_step; /* stored units */
  uint64_t *cell_bits; /* owned; [bricks z][y][x]; which of a brick's cells may show something (cell_bits.h);
                          or null */
  bool cell_bits_tell; /* they leave out enough to be asked */
  uint32_t *relevant_list; /* owned; [relevant_count]; relevant bricks with a visible cell, rising */
  uint32_t relevant_count;
  int32_t relevant_low[3],
      relevant_high[3]; /* the least and greatest place of a relevant brick along each axis */
  bool cut;             /* some relevant brick reaches the box's faces: rays need their entry and exit */
  void *finite_voxels;  /* owned; a copy with non-finite voxels replaced, or null */
  uint64_t kept_voxels; /* 64 a relevant brick, cut at the borders */
} grid;

static inline size_t hl_grid_bricks(const grid *grid) {
  return (size_t)grid->brick_count[0] * (size_t)grid->brick_count[1] * (size_t)grid->brick_count[2];
}

/* Brick coordinates of a brick's index. */
static inline void hl_grid_brick_place(const grid *grid, uint32_t brick, int32_t b[3]) {
  b[0] = (int32_t)(brick % (uint32_t)grid->brick_count[0]);
  b[1] = (int32_t)(brick / (uint32_t)grid->brick_count[0] % (uint32_t)grid->brick_count[1]);
  b[2] = (int32_t)(brick / (uint32_t)grid->brick_count[0] / (uint32_t)grid->brick_count[1]);
}

#endif
