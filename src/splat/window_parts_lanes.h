/* splat/window_parts_lanes.h - a slice of a window, and the taps taken from one of its rows, as they lie in
 * registers. */
#ifndef HL_SPLAT_WINDOW_PARTS_LANES_H
#define HL_SPLAT_WINDOW_PARTS_LANES_H

#include "splat/grid.h"
#include "splat/row_lanes.h"

/* As many parts as the voxels' type fills; the others stay empty. */
typedef struct window_slice {
  __m512i part[4];
} window_slice;
typedef struct window_taps {
  __m512i part[4];
} window_taps;

/* Some lanes: a bit for each piece of their taps that a permutation moves. */
typedef __mmask64 window_lanes;

#endif
