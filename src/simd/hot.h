/* simd/hot.h - the hot functions behind one table, chosen once a context.
 *
 * Each is written once, in the *_lanes.h of its room, and compiled for every instruction set; all give
 * the same bytes. */
#ifndef HL_SIMD_HOT_H
#define HL_SIMD_HOT_H

#include "render/shade.h"
#include "shadow/attenuate.h"
#include "shadow/blur.h"
#include "shadow_cascade/cascade_field.h"
#include "shadow_sublights/sublight_field.h"
#include "splat/brick_ranges.h"
#include "splat/bricks.h"
#include "splat/coverage.h"
#include "splat/fill.h"

typedef struct hot_functions {
  grid_functions grid;
  brick_ranges_function *brick_ranges;
  relevant_blocks_function *relevant_blocks_tile;
  fill_tile_function *splat_tile, *gather_tile;
  coverage_tile_function *coverage_tile;
  attenuate_tile_function *attenuate_tile;
  lit_blocks_function *lit_blocks_tile;
  shade_tile_function *shade_tile, *measure_tile, *cover_tile, *maximum_tile;
  sublight_tile_function *sublight_tile;
  sublight_row_function *sublight_row;
  sublight_lit_function *sublight_lit;
  half_pixel_tile_function *half_pixel_tile;
  blur_tile_function *blur_rows_tile, *blur_columns_tile;
  field_blur_tile_function *field_blur_tile;
  field_tile_function *add_tile, *add_half_tile, *add_double_tile;
  left_tile_function *left_tile;
  absorbed_tile_function *absorbed_tile;
  part_tile_function *part_tile;
  field_tile_function *double_tile;
  image_tile_function *image_tile;
  field_image_tile_function *field_image_tile;
} hot_functions;

const hot_functions *hl_hot_functions(hl_instruction_set set);

extern const hot_functions hl_hot_scalar;
#if defined(__x86_64__)
extern const hot_functions hl_hot_avx2, hl_hot_avx512, hl_hot_avx512_vbmi;
#elif defined(__aarch64__)
extern const hot_functions hl_hot_neon;
#endif

#endif
