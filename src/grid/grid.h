/* grid/grid.h - describes a volume ready for sampling: its voxels, their position in the frame, and bricks
 * and cells that tell where the transfer function shows something.
 *
 * Densities on sheets are differences from the grid's empty value, in stored units (the units of the voxels).
 * Where no voxel is splatted, the density is 0, which stands for the empty value. Where only some of the
 * voxels around a point are splatted, the sum lies between the empty value and other transparent values.
 *
 * The cell of a point p (index space, clamped to [-1, n)) has the coordinates floor(p) + 1, from 0 to n along
 * each axis. A brick is 4x4x4 cells. A point's density depends on the 4x4x4 voxels around its cell. */
#ifndef HL_GRID_GRID_H
#define HL_GRID_GRID_H

#include "bricks/bricks.h"
#include "core/error.h"
#include "core/pool.h"
#include "grid/kernel.h"
#include "scene/geometry/cut.h"
#include "scene/scene.h"
#include "volume/store/pages.h"

enum {
  HL_BRICK_CELLS = 4,
  HL_LOOKUP_CELLS = 2, /* number of cells along an edge of a group of 2x2x2 cells. A group of 2x2x2 cells is
                        * the finer unit of bounds and look-ups */
  GRID_COLUMN = 8      /* width of a column in voxels */
};

/* A table that tells which small boxes of the grid show something. A grid has two such tables: the unit of
 * the first is a group of 2x2x2 cells, the unit of the second is a brick. Eight boxes begin at each unit;
 * each box is two or three units long along each axis. Each unit has a byte, with a bit for each of the eight
 * boxes: bit i + 2 j + 4 k tells whether the box of 2 + i by 2 + j by 2 + k units shows something. */
enum { LOOKUP_SIZES = 2, LOOKUP_REACH = 3 /* units along an axis that one look-up covers */ };
typedef struct cell_lookup {
  int32_t count[3];
  unsigned char *visible; /* in the grid's memory; [count z][y][x]; null if 32 bits cannot number the cells */
} cell_lookup;

typedef struct grid {
  void *memory;          /* owned; holds all arrays except the volume's voxels and the layers of
                          * cell_bounds */
  const void *voxels;    /* [dimension[2]][dimension[1]][dimension[0]]; stored values; the volume's own voxels
                          * or finite_voxels; rows are packed. Null for a grid with pages or bricks */
  const hl_pages *pages; /* the volume's pages (volume/store/pages.h), or value_pages; null if the voxels are
                          * in memory. A grid with pages has no look-ups of cells: only its bricks tell where
                          * something is visible */
  /* The field in bricks; borrowed from the volume; null if the grid has voxels. A coordinate in the field's
   * lattice is one more than the coordinate in the grid, so that cells of the grid (floor(p) + 1) are cells
   * of the lattice. The grid's "voxels" are the field's coefficients of level 0. A grid with a field in
   * bricks has no look-ups of 2x2x2 cells: only its bricks tell where something is visible */
  const hl_bricks *bricks;
  hl_bricks *finite_bricks; /* in the grid's memory; a copy of the field, with the empty value at places
                             * without data; null if the field has data everywhere */
  double shift[3];          /* grid coordinate = voxel index + shift; shift is 0 if the grid has no field in
                             * bricks */
  hl_pages *value_pages;    /* owned (value_pages.h); pages with the values that sampling needs; null if
                             * sampling uses the stored values */
  size_t row_bytes, slice_bytes; /* bytes of the voxels from each row to the next, and from each slice to the
                                  * next */
  /* A second copy of u8 voxels, in columns eight voxels wide. Eight rows of a column are 64 consecutive
   * bytes. So two loads of 512 bits take a window of 8x8 voxels from two columns, and neighbouring windows
   * lie in the same cache lines for any direction of the sheets. The values are reduced by 128 and stored as
   * signed numbers. [column][dimension[2]][dimension[1]][GRID_COLUMN]; null if nothing reads the columns. */
  unsigned char *columns;
  size_t column_slice_bytes, column_bytes; /* number of bytes from one slice of a column to the next, and from
                                            * one column to the next */
  hl_storage storage;
  int32_t dimension[3];
  float empty;                      /* the empty value, in stored units */
  double value_scale, value_offset; /* data value = value_scale * stored + value_offset */
  affine3 index_to_frame, frame_to_index;
  double box_low[3], box_high[3]; /* corners of the box within which the volume exists; index space */
  /* The places of the box's faces along each axis, in index space. A face that cuts nothing visible gets a
   * place far outside the grid. In a frame, a face beyond which another volume continues the matter gets a
   * place far outside, too. */
  float face_low[3], face_high[3];
  bool face_shows[3][2]; /* [axis][low, high]: whether something is visible on the face itself */
  int32_t brick_count[3];
  void *brick_bounds;      /* [bricks z][y][x][2], of the voxels' type; the least and the greatest stored
                            * value among the voxels on which the brick's cells and the cells around the brick
                            * depend */
  unsigned char *relevant; /* [bricks z][y][x]; 1 for bricks in which the transfer function may show
                            * something */
  cell_lookup lookup[LOOKUP_SIZES]; /* two look-ups: of groups of 2x2x2 cells, and of bricks */
  /* [bricks z]; for each layer of bricks, the packed bounds of all groups of 2x2x2 cells in the layer
   * (bounds.h). The grid owns each layer, whose size packing finds. A bound stands for the stored value
   * cell_base + cell_step * bound. Null if 32 bits cannot number the cells */
  unsigned char **cell_bounds;
  float cell_base, cell_step; /* the stored value for the bound 0, and the step from one bound to the next;
                               * stored units */
  uint64_t *cell_bits;        /* [bricks z][y][x]; bit x + 4 y + 16 z tells whether the cell (x, y, z) of the
                               * brick may show something; may be null */
  bool cell_bits_tell;        /* whether reading the bits of cells saves time, because a large part of the
                               * cells shows nothing */
  uint32_t *relevant_list;    /* [relevant_count]; relevant bricks with a visible cell, in rising order */
  uint32_t relevant_count;
  int32_t relevant_low[3], relevant_high[3]; /* the box around all relevant bricks
                                              * (grid/relevant.h), in bricks; both ends are in it */
  int32_t content_low[3],
      content_high[3]; /* the least and greatest coordinates of relevant bricks and of bricks that only a mask
                        * hides. The geometry of a frame follows from these coordinates, so that no mask moves
                        * the frame's sheets */
  bool cut; /* whether relevant bricks reach the box's faces, or the grid has cuts; if so, sweeps need the
             * places where rays cross faces */
  const cut_shape *cuts; /* borrowed; [cut_count]; the shapes that are removed from the box */
  size_t cut_count;
  bool cut_casts_shadow; /* whether the matter that cuts remove still casts shadows */
  /* in the grid's memory; a copy of the voxels in which the empty value replaces values that are not finite;
   * for an interpolating kernel, the kernel's coefficients (prefilter.h); null if the grid reads the volume's
   * own voxels */
  float *finite_voxels;
  uint64_t kept_voxels; /* number of voxels of the relevant bricks: 64 for each brick, and fewer for bricks at
                         * the borders */
} grid;

/* ---- the functions of this room that are compiled for each instruction set ---- */

/* The type of the function that finds the least and the greatest value of several rows of voxels, element by
 * element. rows: row_count pointers to `count` stored values of one type. */
typedef void bound_rows_function(const void *const *rows, int row_count, size_t count, float *least,
                                 float *greatest);

enum { CELL_TAPS = 5 /* number of voxels along an axis on which a pair of neighbouring cells depends */ };

/* The type of the function that finds the bounds of pairs of cells along x. Pair f depends on the voxels 2f-2
 * .. 2f+2; beyond the row's ends the last voxel repeats. row: count stored values. padded: scratch memory of
 * count + 6 floats. low, high: count / 2 + 1. smooth: whether the kernel is the B-spline. */
typedef void bound_along_function(hl_storage storage, const void *row, int32_t count, bool smooth,
                                  float *padded, float *low, float *high);
/* The type of the function that finds the bounds of pairs of cells along y or z, as bound_along_function does
 * along x. The function works element by element on CELL_TAPS rows of bounds. */
typedef void bound_across_function(const float *const low_rows[CELL_TAPS],
                                   const float *const high_rows[CELL_TAPS], size_t count, bool smooth,
                                   float *low, float *high);

/* The type of the function that finds the bits of a brick's cells. Bit x + 4 y + 16 z tells whether the field
 * times `sign` may exceed a threshold (stored units) somewhere in the cell (x, y, z). */
typedef uint64_t brick_bits_function(const grid *grid, const int32_t brick[3], float sign, float threshold);

typedef struct grid_functions {
  bound_rows_function *rows[3]; /* bounds of rows of voxels; one function for each hl_storage */
  bound_along_function *along;
  bound_across_function *across;
  brick_bits_function *brick_bits;
  bool reads_columns; /* whether this instruction set's code for gathering reads the columns of u8 voxels */
} grid_functions;

/* ---- bricks and voxels ---- */

static inline size_t hl_grid_bricks(const grid *grid) {
  return (size_t)grid->brick_count[0] * (size_t)grid->brick_count[1] * (size_t)grid->brick_count[2];
}

/* The smallest edge of a voxel; frame units. */
static inline double hl_smallest_edge(const grid *grid) {
  double most = 0; /* the greatest number of voxels per frame unit along an axis */
  for (int axis = 0; axis < 3; axis++) {
    double along = vec3_length(grid->frame_to_index.linear.row[axis]);
    most = along > most ? along : most;
  }
  return 1 / most;
}

/* The index of the brick that has given coordinates. */
static inline size_t hl_brick_index(const grid *grid, const int32_t b[3]) {
  return ((size_t)b[2] * (size_t)grid->brick_count[1] + (size_t)b[1]) * (size_t)grid->brick_count[0] +
         (size_t)b[0];
}

/* Returns whether any brick in a box of bricks is relevant. first, last: the coordinates of the box's
 * corners, both included. */
static inline bool hl_any_brick_relevant(const grid *grid, const int32_t first[3], const int32_t last[3]) {
  int32_t b[3];
  for (b[2] = first[2]; b[2] <= last[2]; b[2]++)
    for (b[1] = first[1]; b[1] <= last[1]; b[1]++)
      for (b[0] = first[0]; b[0] <= last[0]; b[0]++)
        if (grid->relevant[hl_brick_index(grid, b)]) return true;
  return false;
}

/* The coordinates of the brick that has a given index. */
static inline void hl_brick_coordinates(const grid *grid, uint32_t brick, int32_t b[3]) {
  b[0] = (int32_t)(brick % (uint32_t)grid->brick_count[0]);
  b[1] = (int32_t)(brick / (uint32_t)grid->brick_count[0] % (uint32_t)grid->brick_count[1]);
  b[2] = (int32_t)(brick / (uint32_t)grid->brick_count[0] / (uint32_t)grid->brick_count[1]);
}

/* The address of the first voxel of a row, in a grid without pages. */
static inline const unsigned char *hl_grid_row(const grid *grid, int64_t y, int64_t z) {
  return (const unsigned char *)grid->voxels + (size_t)z * grid->slice_bytes + (size_t)y * grid->row_bytes;
}

/* Makes a grid that shows one page of another grid: its voxels are the page's voxels, at the same places.
 * Only the page's voxels may be read. The voxels that a caller has read are valid only if the page has stayed
 * in memory (hl_page_stayed()). */
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

/* Does the work of hl_stored_value() for a grid with pages or bricks. */
float hl_value_outside_memory(const grid *grid, int64_t x, int64_t y, int64_t z);

/* Places the grid in a frame. voxel_to_frame: maps the volume's index space to frame space. Returns false if
 * the volume's axes are singular. */
static inline bool hl_grid_place(grid *grid, affine3 voxel_to_frame) {
  const vec3 moved = mat3_apply(voxel_to_frame.linear, vec3_of(grid->shift));
  grid->index_to_frame = (affine3){voxel_to_frame.linear, vec3_subtract(voxel_to_frame.offset, moved)};
  return affine3_invert(grid->index_to_frame, &grid->frame_to_index);
}

/* The stored value of a voxel. Beyond the grid's faces the values at the border continue. */
static inline float hl_stored_value(const grid *grid, int64_t x, int64_t y, int64_t z) {
  int64_t at[3] = {x, y, z};
  if (grid->voxels == NULL) return hl_value_outside_memory(grid, x, y, z);
  for (int a = 0; a < 3; a++)
    at[a] = at[a] < 0 ? 0 : at[a] >= grid->dimension[a] ? grid->dimension[a] - 1 : at[a];
  const void *row = hl_grid_row(grid, at[1], at[2]);
  if (grid->storage == HL_STORAGE_U8) return ((const uint8_t *)row)[at[0]];
  if (grid->storage == HL_STORAGE_U16) return ((const uint16_t *)row)[at[0]];
  return ((const float *)row)[at[0]];
}

#endif
