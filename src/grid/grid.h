/* grid/grid.h - a volume ready for sampling: its voxels, their position in the frame, and bricks and cells
 * that tell where the transfer function shows something.
 *
 * Densities on sheets are differences from the grid's empty value, in stored units (what the voxels hold):
 * where no voxel is splatted the density is 0, the empty value. Where only some of a point's voxels are
 * splatted, the sum lies between the empty value and values that are transparent as well.
 *
 * The cell of a point p (index space, clamped to [-1, n)) has the coordinates floor(p) + 1, from 0 to n along
 * each axis. A brick is 4x4x4 cells. A point's density depends on the 4x4x4 voxels around its cell. */
#ifndef HL_GRID_GRID_H
#define HL_GRID_GRID_H

#include "core/error.h"
#include "core/pool.h"
#include "grid/kernel.h"
#include "scene/cut.h"
#include "scene/scene.h"
#include "volume/pages.h"

enum {
  HL_BRICK_CELLS = 4,
  HL_LOOKUP_CELLS = 2, /* cells along an edge of the finer unit (2x2x2 cells) of bounds and look-ups */
  GRID_COLUMN = 8,     /* voxels: the width of a column */
  GRID_MARGIN =
      4 /* voxels: how far outside its box a grid has values, for slabs that cross the box's faces */
};

/* Where something is visible, in units of 2x2x2 cells or of bricks. A box of two or three units along each
 * axis is looked up at its first unit: bit i + 2 j + 4 k of `visible` tells whether the box of 2 + i by 2 + j
 * by 2 + k units from there on shows something. */
enum { LOOKUP_SIZES = 2, LOOKUP_REACH = 3 /* units along an axis that one look-up covers */ };
typedef struct cell_lookup {
  int32_t count[3];
  unsigned char
      *visible; /* in the grid's memory; [count z][y][x]; null where 32 bits cannot number the cells */
} cell_lookup;

typedef struct grid {
  void *memory;          /* owned; all arrays but the volume's voxels and the layers of cell_bounds */
  const void *voxels;    /* [dimension[2]][dimension[1]][dimension[0]]; stored values; the volume's, or
                            finite_voxels; null with pages. Rows are packed */
  const hl_pages *pages; /* the volume's (volume/pages.h), or value_pages; null: its voxels are in memory.
                            With pages, bricks alone tell where something is visible */
  hl_pages *value_pages; /* owned (value_pages.h); null: sampling needs no other values than the voxels' */
  size_t row_bytes, slice_bytes; /* of voxels: from row to row, and from slice to slice */
  /* u8 voxels once more, in columns eight voxels wide: eight rows of a column are 64 bytes in a line, so that
   * a window of 8x8 voxels comes from two columns by two loads (of 512 bits), and neighbouring windows come
   * from the same lines of the cache whichever way the sheets lie. Values are less 128, as signed numbers.
   * [column][dimension[2]][dimension[1]][GRID_COLUMN]; null where nothing reads them. */
  unsigned char *columns;
  size_t column_slice_bytes, column_bytes; /* bytes from slice to slice, and from column to column */
  hl_storage storage;
  int32_t dimension[3];
  float empty;                      /* stored units */
  double value_scale, value_offset; /* data value = value_scale * stored + value_offset */
  affine3 index_to_frame, frame_to_index;
  double box_low[3], box_high[3];  /* index space: where the volume exists */
  float face_low[3], face_high[3]; /* the box's faces that cut something visible; others are far outside, and
                                      in a frame those where another volume goes on */
  bool face_shows[3][2];           /* [axis][low, high]: whether something is visible on the face itself */
  int32_t brick_count[3];
  void *brick_bounds;      /* [bricks z][y][x][2]; least and greatest stored value, of the voxels' type,
                              of the voxels that the brick's cells and the cells around it depend on */
  unsigned char *relevant; /* [bricks z][y][x]; 1 where the transfer function may show something */
  cell_lookup lookup[LOOKUP_SIZES]; /* of 2x2x2 cells, and of bricks */
  unsigned char **cell_bounds; /* [bricks z], each owned, of the size that packing finds: packed bounds of
                                  every 2x2x2 cells of a layer of bricks (bounds.h), stored value = cell_base
                                  + cell_step * bound; null where 32 bits cannot number the cells */
  float cell_base, cell_step;  /* stored units */
  uint64_t *cell_bits;     /* [bricks z][y][x]; bit x + 4 y + 16 z: whether the cell (x, y, z) of the brick
                              may show something; or null */
  bool cell_bits_tell;     /* enough cells show nothing for the bits to be worth asking */
  uint32_t *relevant_list; /* [relevant_count]; relevant bricks with a visible cell, in rising order */
  uint32_t relevant_count;
  int32_t relevant_low[3], relevant_high[3]; /* the least and greatest coordinates of relevant bricks */
  int32_t content_low[3],
      content_high[3]; /* the same of these and of those that only a mask hides: what a
                          frame's geometry follows from, so that no mask moves its sheets */
  bool cut; /* some relevant brick reaches the box's faces: rays need to know where they cross them */
  const cut_shape *cuts; /* borrowed; [cut_count]; what they remove of the box is not there */
  size_t cut_count;
  bool cut_casts_shadow; /* lights meet what the cuts remove */
  float *finite_voxels;  /* a copy of the voxels with non-finite ones replaced by empty, of which
  interpolating kernels keep coefficients (prefilter.h); or null */
  uint64_t kept_voxels;  /* 64 for each relevant brick, fewer at the borders */
} grid;

/* ---- the functions of this room that are compiled for each instruction set ---- */

/* Elementwise bounds of rows of stored values. rows: row_count pointers to count values of one type. */
typedef void bound_rows_function(const void *const *rows, int row_count, size_t count, float *least,
                                 float *greatest);

enum { CELL_TAPS = 5 /* voxels along an axis that two neighbouring cells depend on */ };

/* Bounds of pairs of cells along x: pair f depends on the voxels 2f-2 .. 2f+2; beyond the row's ends the last
 * voxel continues. row: count stored values. padded: scratch, count + 6 floats. low, high: count / 2 + 1.
 * smooth: whether the kernel is the B-spline. */
typedef void bound_along_function(hl_storage storage, const void *row, int32_t count, bool smooth,
                                  float *padded, float *low, float *high);
/* Bounds of pairs of cells along y or z: as for a row, elementwise across rows of bounds. */
typedef void bound_across_function(const float *const low_rows[CELL_TAPS],
                                   const float *const high_rows[CELL_TAPS], size_t count, bool smooth,
                                   float *low, float *high);

/* Bit x + 4 y + 16 z: whether sign times the reconstruction may exceed a threshold (stored units) somewhere
 * in the cell (x, y, z) of the brick. */
typedef uint64_t brick_bits_function(const grid *grid, const int32_t brick[3], float sign, float threshold);

typedef struct grid_functions {
  bound_rows_function *rows[3]; /* by hl_storage */
  bound_along_function *along;
  bound_across_function *across;
  brick_bits_function *brick_bits;
  bool reads_columns; /* whether the instruction set's gathering reads the columns of u8 voxels */
} grid_functions;

/* ---- bricks and voxels ---- */

static inline size_t hl_grid_bricks(const grid *grid) {
  return (size_t)grid->brick_count[0] * (size_t)grid->brick_count[1] * (size_t)grid->brick_count[2];
}

/* The index of the brick with coordinates. */
static inline size_t hl_brick_index(const grid *grid, const int32_t b[3]) {
  return ((size_t)b[2] * (size_t)grid->brick_count[1] + (size_t)b[1]) * (size_t)grid->brick_count[0] +
         (size_t)b[0];
}

/* Whether a brick from first to last, both included, is relevant. */
static inline bool hl_any_brick_relevant(const grid *grid, const int32_t first[3], const int32_t last[3]) {
  int32_t b[3];
  for (b[2] = first[2]; b[2] <= last[2]; b[2]++)
    for (b[1] = first[1]; b[1] <= last[1]; b[1]++)
      for (b[0] = first[0]; b[0] <= last[0]; b[0]++)
        if (grid->relevant[hl_brick_index(grid, b)]) return true;
  return false;
}

/* Coordinates of the brick with an index. */
static inline void hl_brick_coordinates(const grid *grid, uint32_t brick, int32_t b[3]) {
  b[0] = (int32_t)(brick % (uint32_t)grid->brick_count[0]);
  b[1] = (int32_t)(brick / (uint32_t)grid->brick_count[0] % (uint32_t)grid->brick_count[1]);
  b[2] = (int32_t)(brick / (uint32_t)grid->brick_count[0] / (uint32_t)grid->brick_count[1]);
}

/* The first voxel of a row of a grid without pages. */
static inline const unsigned char *hl_grid_row(const grid *grid, int64_t y, int64_t z) {
  return (const unsigned char *)grid->voxels + (size_t)z * grid->slice_bytes + (size_t)y * grid->row_bytes;
}

/* A grid whose voxels are those of one page of another: the same places, but only the page's voxels may be
 * read, and count if the page stays (hl_page_stayed()). */
static inline void hl_grid_of_page(const grid *grid, const size_t page[3], struct grid *view,
                                   hl_page_reading *reading) {
  const hl_pages *pages = grid->pages;
  size_t before = ((page[2] * pages->slice_bytes + page[1] * pages->row_bytes) +
                   page[0] * hl_storage_bytes(pages->storage))
                  << pages->shift;
  *view = *grid;
  view->pages = NULL;
  *reading = hl_page_begin(pages, page);
  view->voxels = (const void *)((uintptr_t)reading->first - before);
  view->row_bytes = pages->row_bytes;
  view->slice_bytes = pages->slice_bytes;
}

/* The stored value of a voxel; beyond the grid's faces the border's values continue. */
static inline float hl_stored_value(const grid *grid, int64_t x, int64_t y, int64_t z) {
  int64_t at[3] = {x, y, z};
  for (int a = 0; a < 3; a++)
    at[a] = at[a] < 0 ? 0 : at[a] >= grid->dimension[a] ? grid->dimension[a] - 1 : at[a];
  if (grid->pages != NULL)
    return (float)hl_page_number(grid->pages, (size_t)at[0], (size_t)at[1], (size_t)at[2]);
  const void *row = hl_grid_row(grid, at[1], at[2]);
  if (grid->storage == HL_STORAGE_U8) return ((const uint8_t *)row)[at[0]];
  if (grid->storage == HL_STORAGE_U16) return ((const uint16_t *)row)[at[0]];
  return ((const float *)row)[at[0]];
}

#endif
