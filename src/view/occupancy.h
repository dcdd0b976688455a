/* view/occupancy.h - which tiles of which sheets may show something, for one view.
 *
 * Each relevant brick marks the tiles and sheets that it can touch, one bit each. A sheet then visits its
 * marked tiles only: empty space costs nothing. */
#ifndef HL_VIEW_OCCUPANCY_H
#define HL_VIEW_OCCUPANCY_H

#include "core/memory.h"
#include "grid/grid.h"
#include "view/view.h"

/* The rectangle of a view's tiles that one grid can touch; other tiles take neither memory nor time for the
 * grid. */
typedef struct tile_rectangle {
  int x, y, width, height; /* tiles */
  size_t first;            /* index of the rectangle's first tile in patch_of; tiles follow row by row */
} tile_rectangle;

typedef struct sheet_range {
  int32_t first, last; /* empty if first > last */
} sheet_range;

/* A patch is one grid in one tile. A tile's patches follow each other, in the order of the grids. */
typedef struct occupancy {
  int tiles_x, tiles_y, sheets;
  int words;                 /* number of 64-bit words of one patch, which hold a bit for each sheet */
  int tile_words;            /* number of 64-bit words of one sheet, which hold a bit for each tile */
  double spare;              /* margin, in pixels, around each brick's projection that counts as touched */
  tile_rectangle *rectangle; /* [grids]; owns the block that also holds the arrays below */
  size_t patch_count;
  uint32_t *patch_of;     /* [patches]; for each tile of each grid's rectangle, the number of its patch */
  uint32_t *first_patch;  /* [tiles + 1]; where a tile's patches begin */
  uint32_t *patch_grid;   /* [patches]; the patch's grid */
  uint64_t *by_patch;     /* [patches][words]; bit = sheet */
  sheet_range *sheets_of; /* [grids]; the sheets that a grid touches anywhere */
  uint64_t *by_sheet;     /* [words * 64][tile_words]; for each sheet one bit for each tile that some grid
                           * touches */
} occupancy;

/* ---- tiles and sheets of sixteen bricks: compiled for each instruction set ---- */

enum { BRICKS_AT_ONCE = 16, RANGE_AXES = 3 };
enum range_axis { RANGE_X, RANGE_Y, RANGE_SHEETS };

/* One grid in one view, as affine functions of a point of the grid's index space. Points are counted from
 * `middle`. */
typedef struct brick_view {
  float view[3][4]; /* rows of the functions for w, for w times tiles across, and for w times tiles down */
  float height[4];  /* row for the height, in sheets */
  float slack[4];   /* for each of the four functions, a bound of its rounding error */
  float middle[3];  /* a point of index space */
  float spare;      /* margin, in tiles, around each brick's projection that counts as touched */
  int32_t first[RANGE_AXES], last[RANGE_AXES]; /* limits of the ranges: the first and last tile of the grid's
                                                * rectangle across and down, and the first and last sheet of
                                                * the view */
} brick_view;

/* The first and last tile across, tile down and sheet that each brick touches. A brick with an empty range
 * (first > last) touches nothing. */
typedef struct brick_ranges {
  int32_t first[RANGE_AXES][BRICKS_AT_ONCE], last[RANGE_AXES][BRICKS_AT_ONCE];
} brick_ranges;

/* brick: the bricks' coordinates along each axis. */
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
  const grid *grids; /* [grid_count] */
  int grid_count;
  const view *view;
  const sheet_stack *sheets;
  double spare; /* the occupancy's `spare`, in pixels; at least PIXEL_TO_SPARE */
} occupancy_source;

/* Fills an empty occupancy. Call hl_occupancy_release() even after a failure. */
hl_status hl_occupancy_build(hl_context *context, hl_pool *pool, brick_ranges_function *ranges,
                             const occupancy_source *source, occupancy *occupancy, hl_error *error);
void hl_occupancy_release(hl_context *context, occupancy *occupancy);

/* Counts the memory that hl_occupancy_build() takes. The occupancy must be zeros; its number of patches is
 * set, but no pointers. */
void hl_occupancy_count(const occupancy_source *source, occupancy *occupancy, hl_layout *layout);

/* The first slab, from the given one on, whose own sheet or the sheet before touches a patch. INT32_MAX if
 * there is no such slab. */
int32_t hl_occupancy_next_slab(const occupancy *occupancy, size_t patch, int slab);

static inline int hl_occupancy_has(const occupancy *occupancy, size_t patch, int sheet) {
  const uint64_t *bits = occupancy->by_patch + patch * (size_t)occupancy->words;
  return (int)(bits[sheet / 64] >> (sheet % 64) & 1);
}

/* Whether a slab's sheet or the sheet before may touch a tile. */
static inline bool hl_occupancy_touches(const occupancy *occupancy, size_t tile, int sheet) {
  const uint64_t *after = occupancy->by_sheet + (size_t)sheet * (size_t)occupancy->tile_words;
  const uint64_t *before = after - occupancy->tile_words;
  return (before[tile / 64] | after[tile / 64]) >> tile % 64 & 1;
}

#endif
