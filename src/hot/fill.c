/* hot/fill.c - compiles the hot functions that fill tiles of a sheet with densities. */
#include "hot/tables.h"

#include "fill/relevant_blocks_lanes.h"
#include "fill/splat_lanes.h"

const fill_functions HL_HOT(fill) = {relevant_blocks_tile, splat_tile, gather_tile};
