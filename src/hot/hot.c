/* hot/hot.c - the hot functions of all rooms, compiled once for each instruction set; HL_HOT_TABLE names the
 * table that it fills. */
#include "render/hot.h"

#include "field/opacity_lanes.h"
#include "field/sky_lanes.h"
#include "fill/relevant_blocks_lanes.h"
#include "fill/splat_lanes.h"
#include "grid/bounds_lanes.h"
#include "grid/cell_bits_lanes.h"
#include "render/maximum_lanes.h"
#include "render/measure_lanes.h"
#include "render/shade_lanes.h"
#include "render/surface_lanes.h"
#include "shadow/blur_lanes.h"
#include "shadow_cascade/cascade_lanes.h"
#include "shadow_sublights/sublight_lanes.h"
#include "surface/small_spheres_lanes.h"
#include "surface/small_triangles_lanes.h"
#include "view/brick_ranges_lanes.h"

#ifdef HL_WINDOWS
#define HL_READS_COLUMNS true
#else
#define HL_READS_COLUMNS false
#endif

static const cascade_functions cascade = {.lit_blocks = lit_blocks_tile,
                                          .blur_add = field_blur_tile,
                                          .add = add_tile,
                                          .add_half = add_half_tile,
                                          .add_double = add_double_tile,
                                          .refill = refill_tile,
                                          .absorbed = absorbed_tile,
                                          .split = split_tile,
                                          .double_tile = double_tile,
                                          .emission_add = field_emission_tile};

static const sublight_functions sublights = {.composite = sublight_tile,
                                             .composite_row = sublight_row,
                                             .lit = sublight_lit,
                                             .half_pixel = half_pixel_tile};

const hot_functions HL_HOT_TABLE = {
    .grid = {{bound_rows_u8, bound_rows_u16, bound_rows_f32},
             bound_along,
             bound_across,
             brick_bits,
             HL_READS_COLUMNS},
    .view = {brick_ranges_in_view, coverage_tile},
    .field = {field_opacity, sky_row},
    .fill = {relevant_blocks_tile, splat_tile, gather_tile},
    .surface = {cover_small, see_cluster, cover_cluster, cover_spheres},
    .shadow = {attenuate_tile,
               lit_blocks_tile,
               {blur_rows_tile, blur_columns_tile, lit_blocks_tile, emission_tile},
               &cascade,
               &sublights},
    .render = {shade_tile, measure_tile, cover_tile, maximum_tile, shade_surface},
};
