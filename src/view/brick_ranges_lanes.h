/* view/brick_ranges_lanes.h - finds the tiles and sheets that sixteen bricks touch. It does the work of
 * hl_brick_bounds() and hl_footprint_bounds() with floats, whose results are rounded outwards. */
#ifndef HL_VIEW_BRICK_RANGES_LANES_H
#define HL_VIEW_BRICK_RANGES_LANES_H

#include "core/sheet_constants.h"
#include "simd/lanes.h"
#include "view/occupancy.h"

/* Sixteen boxes: their centres and half of their edges. */
typedef struct lanes_boxes {
  lanes centre[3], half[3];
} lanes_boxes;
typedef struct lanes_range {
  lanes low, high;
} lanes_range;

/* For each brick, the box around its cells, in index space. At the grid's borders a box is larger by
 * GRID_MARGIN. */
LANES_INLINE lanes_boxes boxes_of_bricks(const brick_view *view, const grid *grid,
                                         const int32_t brick[3][BRICKS_AT_ONCE]) {
  lanes_boxes boxes;
  for (int axis = 0; axis < 3; axis++) {
    float count = (float)grid->dimension[axis];
    lanes_int at;
    memcpy(&at, brick[axis], sizeof at);
    lanes low = lanes_from_int(at * HL_BRICK_CELLS - 1), high = low + (float)HL_BRICK_CELLS;
    low = lanes_select(at == 0, low - GRID_MARGIN, low);
    high = lanes_select(high >= count - 1.0f, lanes_set(count - 0.5f + GRID_MARGIN), high);
    boxes.centre[axis] = (low + high) * 0.5f - view->middle[axis];
    boxes.half[axis] = (high - low) * 0.5f;
  }
  return boxes;
}

LANES_INLINE lanes_range range_of_row(const lanes_boxes *boxes, const float row[4], float slack) {
  lanes centre = boxes->centre[0] * row[0] + boxes->centre[1] * row[1] + (boxes->centre[2] * row[2] + row[3]);
  lanes reach = boxes->half[0] * fabsf(row[0]) + boxes->half[1] * fabsf(row[1]) +
                (boxes->half[2] * fabsf(row[2]) + slack);
  return (lanes_range){centre - reach, centre + reach};
}

/* Stores a range of tiles or sheets: the first and the last integer between `first` and `last`, limited to
 * the view. If there is no such integer, the stored first number is greater than the stored last number. */
LANES_INLINE void store_range(const brick_view *view, lanes first, lanes last, int axis,
                              brick_ranges *ranges) {
  float least = (float)view->first[axis], greatest = (float)view->last[axis];
  lanes_int from = lanes_floor(lanes_clamp(first, least, greatest + 1.0f)),
            to = lanes_floor(lanes_clamp(last, least - 1.0f, greatest));
  memcpy(ranges->first[axis], &from, sizeof from);
  memcpy(ranges->last[axis], &to, sizeof to);
}

static void brick_ranges_in_view(const brick_view *view, const grid *grid,
                                 const int32_t brick[3][BRICKS_AT_ONCE], brick_ranges *ranges) {
  lanes_boxes boxes = boxes_of_bricks(view, grid, brick);
  lanes_range w = range_of_row(&boxes, view->view[0], view->slack[0]);
  lanes_range height = range_of_row(&boxes, view->height, view->slack[3]);
  lanes_int ahead = w.high > 0.0f;
  /* the lanes whose box reaches behind the eye, so that it may touch any tile */
  lanes_int anywhere = w.low <= w.high * 1e-6f;
  lanes nearest = 1.0f / lanes_select(anywhere, lanes_set(1.0f), w.low),
        farthest = 1.0f / lanes_select(ahead, w.high, lanes_set(1.0f));
  for (int axis = 0; axis < 2; axis++) {
    lanes_range at = range_of_row(&boxes, view->view[1 + axis], view->slack[1 + axis]);
    lanes low = at.low * lanes_select(at.low < 0.0f, nearest, farthest),
          high = at.high * lanes_select(at.high < 0.0f, farthest, nearest);
    low = lanes_select(anywhere, lanes_set(-INFINITY), low - lanes_abs(low) * 1e-6f - view->spare);
    high = lanes_select(anywhere, lanes_set(INFINITY), high + lanes_abs(high) * 1e-6f + view->spare);
    store_range(view, low, lanes_select(ahead, high, lanes_set(-INFINITY)), axis, ranges);
  }
  /* sheets lie at whole numbers of the unit of heights, so the first sheet that a brick touches is the first
   * whole number that is not below the low end */
  store_range(view, -lanes_from_int(lanes_floor(lanes_clamp(-height.low, -1e9f, 1e9f))), height.high,
              RANGE_SHEETS, ranges);
}

#endif
