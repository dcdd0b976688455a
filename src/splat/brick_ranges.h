/* splat/brick_ranges.h - the tiles of a view and the sheets that bricks may touch, sixteen bricks at a
 * time. */
#ifndef HL_SPLAT_BRICK_RANGES_H
#define HL_SPLAT_BRICK_RANGES_H

#include "splat/grid.h"

enum { BRICKS_AT_ONCE = 16, RANGE_AXES = 3 };
enum range_axis { RANGE_X, RANGE_Y, RANGE_SHEETS };

/* One grid in one view: rows for a point of index space, less middle. */
typedef struct brick_view {
  float view[3][4];                            /* w; w times tiles across; w times tiles down */
  float height[4];                             /* sheets */
  float slack[4];                              /* of the four: more than rounding errs by */
  float middle[3];                             /* index space */
  float spare;                                 /* tiles around what bricks touch that count as touched */
  int32_t first[RANGE_AXES], last[RANGE_AXES]; /* that there are: tiles across, tiles down, sheets */
} brick_view;

/* Per axis; a brick touches nothing where one range is empty. */
typedef struct brick_ranges {
  int32_t first[RANGE_AXES][BRICKS_AT_ONCE], last[RANGE_AXES][BRICKS_AT_ONCE];
} brick_ranges;

/* place: of bricks, along each axis. */
typedef void brick_ranges_function(const brick_view *view, const grid *grid,
                                   const int32_t place[3][BRICKS_AT_ONCE], brick_ranges *ranges);

#endif
