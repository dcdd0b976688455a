/* view/occupancy.h - finds the tiles of each sheet that may show something, for one view.
 *
 * Each relevant brick marks the tiles and sheets that it can touch, one bit each. The renderer then visits
 * only the marked tiles of a sheet, so that empty space takes no time. */
#ifndef HL_VIEW_OCCUPANCY_H
#define HL_VIEW_OCCUPANCY_H

#include "core/memory.h"
#include "grid/grid.h"
#include "view/view.h"

/* The rectangle of the tiles of a view that one grid can touch. For this grid, other tiles take neither
 * memory nor time. */
typedef struct tile_rectangle {
  int x, y, width, height; /* position and size of the rectangle, in tiles */
  size_t first;            /* index in patch_of of the rectangle's first tile; the other tiles follow row by
                            * row */
} tile_rectangle;

typedef struct sheet_range {
  int32_t first, last; /* numbers of the first and the last sheet; if first > last, there are no sheets */
} sheet_range;

/* Patches: a patch is one grid in one tile. The patches of a tile follow each other, in the order of the
 * grids. */
typedef struct occupancy {
  int tiles_x, tiles_y, sheets;
  int words;                 /* number of 64-bit words of a patch, which hold one bit for each sheet */
  int tile_words;            /* number of 64-bit words of a sheet, which hold one bit for each tile */
  double spare;              /* margin around each brick's projection, in pixels, that counts as touched,
                              * too */
  tile_rectangle *rectangle; /* [grids]; owns the block that also holds the arrays below */
  size_t patch_count;
  uint32_t *patch_of;    /* [patches]; the number of the patch of each tile in each grid's rectangle */
  uint32_t *first_patch; /* [tiles + 1]; the number of each tile's first patch */
  uint32_t *patch_grid;  /* [patches]; the patch's grid */
  /* [patches][words]; for each patch, one bit for each sheet: whether the grid touches the sheet in this
   * tile */
  uint64_t *by_patch;
  sheet_range *sheets_of; /* [grids]; the range of the sheets that a grid touches in any tile */
  uint64_t *by_sheet;     /* [words * 64][tile_words]; for each sheet, one bit for each tile: whether some
                           * grid touches it */
} occupancy;

/* ---- tiles and sheets of sixteen bricks: compiled for each instruction set ---- */

enum { BRICKS_AT_ONCE = 16, RANGE_AXES = 3 };
enum range_axis { RANGE_X, RANGE_Y, RANGE_SHEETS };

/* The map of one grid in one view, as affine functions of a point of the grid's index space. The point's
 * coordinates are counted from `middle`. */
typedef struct brick_view {
  float view[3][4]; /* the functions' rows: for w, for w times the tile across, and for w times the tile
                     * down */
  float height[4];  /* the row of the function for the height, in distances of sheets */
  float slack[4];   /* for each of the four functions, a bound of its rounding error */
  float middle[3];  /* the point of index space from which coordinates are counted */
  float spare;      /* margin around each brick's projection, in tiles, that counts as touched, too */
  int32_t first[RANGE_AXES], last[RANGE_AXES]; /* limits of the ranges: the first and last tile across and
                                                * down of the grid's rectangle, and the first and last sheet
                                                * of the view */
} brick_view;

/* The ranges that each brick touches: the first and last tile across, tile down, and sheet. A brick with an
 * empty range (first > last) touches nothing. */
typedef struct brick_ranges {
  int32_t first[RANGE_AXES][BRICKS_AT_ONCE], last[RANGE_AXES][BRICKS_AT_ONCE];
} brick_ranges;

/* The type of the function that finds the ranges of tiles and sheets that sixteen bricks touch. brick: the
 * coordinates of the bricks along each axis. */
typedef void brick_ranges_function(const brick_view *view, const grid *grid,
                                   const int32_t brick[3][BRICKS_AT_ONCE], brick_ranges *ranges);

/* The functions of this room that are compiled for each instruction set. */
typedef struct view_functions {
  brick_ranges_function *brick_ranges;
  coverage_tile_function *coverage;
} view_functions;

/* ---- building ---- */

enum { PIXEL_TO_SPARE = 1 };

/* The input of hl_occupancy_build(): the grids and the view. */
typedef struct occupancy_source {
  const grid *grids; /* [grid_count]; all grids of the frame */
  int grid_count;
  const view *view;
  const sheet_stack *sheets;
  double spare; /* the occupancy's `spare`, in pixels; at least PIXEL_TO_SPARE */
} occupancy_source;

/* Fills an empty occupancy from its source. Call hl_occupancy_release() even after a failure. */
hl_status hl_occupancy_build(hl_context *context, hl_pool *pool, brick_ranges_function *ranges,
                             const occupancy_source *source, occupancy *occupancy, hl_error *error);
void hl_occupancy_release(hl_context *context, occupancy *occupancy);

/* Counts the memory that hl_occupancy_build() takes. occupancy: must be all zeros; receives the number of
 * patches, but no pointers. */
void hl_occupancy_count(const occupancy_source *source, occupancy *occupancy, hl_layout *layout);

/* The first slab that touches a patch, from slab `slab` on. A slab touches a patch if the sheet at its end or
 * the sheet at its beginning touches the patch. Returns INT32_MAX if there is no such slab. */
int32_t hl_occupancy_next_slab(const occupancy *occupancy, size_t patch, int slab);

static inline int hl_occupancy_has(const occupancy *occupancy, size_t patch, int sheet) {
  const uint64_t *bits = occupancy->by_patch + patch * (size_t)occupancy->words;
  return (int)(bits[sheet / 64] >> (sheet % 64) & 1);
}

/* Returns whether a slab may touch a tile. A slab may touch a tile if the sheet at the slab's end or the
 * sheet at the slab's beginning touches the tile. */
static inline bool hl_occupancy_touches(const occupancy *occupancy, size_t tile, int sheet) {
  const uint64_t *after = occupancy->by_sheet + (size_t)sheet * (size_t)occupancy->tile_words;
  const uint64_t *before = after - occupancy->tile_words;
  return (before[tile / 64] | after[tile / 64]) >> tile % 64 & 1;
}

#endif
