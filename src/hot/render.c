/* hot/render.c - compiles the hot functions that make pixels of the picture. */
#include "hot/tables.h"

#include "render/maximum_lanes.h"
#include "render/measure_lanes.h"
#include "render/shade_lanes.h"
#include "render/surface_lanes.h"

const render_functions HL_HOT(render) = {shade_tile, measure_tile, cover_tile, maximum_tile, shade_surface};
