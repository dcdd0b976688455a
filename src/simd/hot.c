/* simd/hot.c - compiled once for each instruction set; HL_HOT_TABLE names the table it fills. */
#include "simd/hot.h"

#include "render/cover_lanes.h"
#include "render/maximum_lanes.h"
#include "render/measure_lanes.h"
#include "render/shade_lanes.h"
#include "shadow/blur_lanes.h"
#include "shadow_cascade/cascade_lanes.h"
#include "shadow_sublights/sublight_lanes.h"
#include "shadow_sublights/sublight_shift_lanes.h"
#include "splat/bounds_lanes.h"
#include "splat/brick_ranges_lanes.h"
#include "splat/cell_bits_lanes.h"
#include "splat/cell_bounds_lanes.h"
#include "splat/relevant_lanes.h"
#include "splat/splat_lanes.h"

#ifdef HL_WINDOWS
#define HL_COLUMN_SLICE column_slice
#else
#define HL_COLUMN_SLICE NULL
#endif

const hot_functions HL_HOT_TABLE = {
    .grid = {{bound_rows_u8, bound_rows_u16, bound_rows_f32},
             bound_along,
             bound_across,
             brick_bits,
             HL_COLUMN_SLICE},
    .brick_ranges = brick_ranges_in_view,
    .relevant_blocks_tile = relevant_blocks_tile,
    .splat_tile = splat_tile,
    .gather_tile = gather_tile,
    .coverage_tile = coverage_tile,
    .attenuate_tile = attenuate_tile,
    .lit_blocks_tile = lit_blocks_tile,
    .shade_tile = shade_tile,
    .measure_tile = measure_tile,
    .cover_tile = cover_tile,
    .maximum_tile = maximum_tile,
    .blur_rows_tile = blur_rows_tile,
    .blur_columns_tile = blur_columns_tile,
    .field_blur_tile = field_blur_tile,
    .add_tile = add_tile,
    .add_half_tile = add_half_tile,
    .add_double_tile = add_double_tile,
    .sublight_tile = sublight_tile,
    .sublight_row = sublight_row,
    .sublight_lit = sublight_lit,
    .half_pixel_tile = half_pixel_tile,
    .left_tile = left_tile,
    .absorbed_tile = absorbed_tile,
    .part_tile = part_tile,
    .double_tile = double_tile,
    .image_tile = image_tile,
    .field_image_tile = field_image_tile,
};
