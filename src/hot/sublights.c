/* hot/sublights.c - compiles the hot functions of sub-lights. */
#include "hot/tables.h"

#include "shadow_sublights/sublight_lanes.h"

const sublight_functions HL_HOT(sublights) = {.composite = sublight_tile,
                                              .composite_row = sublight_row,
                                              .lit = sublight_lit,
                                              .half_pixel = half_pixel_tile};
