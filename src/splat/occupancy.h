/* splat/occupancy.h - which tiles of which sheets can hold anything, for one view.
 *
 * Every relevant brick marks the tiles and sheets that it can touch: one bit each. A sheet then visits
 * only its marked tiles; empty space costs nothing. */
#ifndef HL_SPLAT_OCCUPANCY_H
#define HL_SPLAT_OCCUPANCY_H

#include "splat/brick_ranges.h"
#include "splat/fill.h"

/* The sheets of a sweep: mid-plane of sheet k at height first + k * spacing along the unit normal. */
typedef struct sheet_stack {
  vec3 normal; /* h; frame space */
  double first, spacing;
  int count;
} sheet_stack;

static inline double hl_sheet_height(const sheet_stack *sheets, int sheet) {
  return sheets->first + sheet * sheets->spacing;
}

/* The tiles of a view that one grid can touch: nothing is kept or done for it elsewhere. */
typedef struct tile_rectangle {
  int x, y, width, height; /* tiles */
  size_t first;            /* its first tile in patch_of; row after row */
} tile_rectangle;

/* A patch is one grid's part in one tile. A tile's patches follow each other, in the order of the grids. */
typedef struct occupancy {
  int tiles_x, tiles_y, sheets;
  int words;                 /* 64-bit words of one patch: sheets rounded up */
  int tile_words;            /* 64-bit words of one sheet: tiles rounded up */
  double spare;              /* pixels */
  tile_rectangle *rectangle; /* owned; [grids] */
  size_t patch_count;
  uint32_t *patch_of;    /* owned; [patches]; the patch of each tile of each grid's rectangle */
  uint32_t *first_patch; /* owned; [tiles + 1]; a tile's patches */
  uint32_t *patch_grid;  /* owned; [patches]; whose it is */
  uint64_t *by_patch;    /* owned; [patches][words]; bit = sheet */
  uint64_t *by_sheet;    /* owned; [words * 64][tile_words]; bit = tile, all grids together */
} occupancy;

enum { PIXEL_TO_SPARE = 1 };

/* Builds an empty occupancy for a view of width x height pixels. spare: pixels around each brick that it
 * touches too, PIXEL_TO_SPARE at least. What fails half-way is released as usual. */
hl_status hl_occupancy_build(hl_context *context, hl_pool *pool, const grid *grids, int grid_count,
                             const view *view, const sheet_stack *sheets, double spare,
                             brick_ranges_function *ranges, occupancy *occupancy, hl_error *error);
void hl_occupancy_release(hl_context *context, occupancy *occupancy);

/* How many patches it would have, and the bytes that it would hold. */
uint64_t hl_occupancy_bytes(const grid *grids, int grid_count, const view *view, const sheet_stack *sheets,
                            double spare, size_t *patch_count);

static inline int hl_occupancy_has(const occupancy *occupancy, size_t patch, int sheet) {
  const uint64_t *bits = occupancy->by_patch + patch * (size_t)occupancy->words;
  return (int)(bits[sheet / 64] >> (sheet % 64) & 1);
}

/* Bounds of a box of index space (centre, half edges) in a view and in sheets. */
typedef struct footprint_bounds {
  double low[2], high[2];         /* continuous pixels */
  double low_height, high_height; /* along the normal */
} footprint_bounds;

/* Maps index space to a view and to heights; prepared once a grid and view. */
typedef struct footprint_map {
  double view[3][4]; /* (w, w u, w v) */
  double height[4];
} footprint_map;

void hl_footprint_map(const view *view, vec3 normal, affine3 index_to_frame, footprint_map *map);
/* False where the box lies wholly behind the view. */
bool hl_footprint_bounds(const footprint_map *map, const double centre[3], const double half[3],
                         footprint_bounds *bounds);

/* Index-space bounds of the points that a brick's cells stand for, borders stretched by margin voxels. */
void hl_brick_bounds(const grid *grid, const int32_t b[3], double margin, double centre[3], double half[3]);
/* The box around all relevant bricks; false if there is none. */
bool hl_relevant_bounds(const grid *grid, double margin, double low[3], double high[3]);

#endif
