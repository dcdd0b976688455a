/* hot/view.c - compiles the hot functions of views. The hot functions of views find the tiles and sheets that
 * bricks touch, and the points at which rays enter and leave boxes. */
#include "hot/tables.h"

#include "view/brick_ranges_lanes.h"
#include "view/rays_lanes.h"

const view_functions HL_HOT(view) = {brick_ranges_in_view, coverage_tile};
