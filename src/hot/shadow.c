/* hot/shadow.c - compiles the hot functions of shadows: attenuation, and the blurs of the cascade, which the
 * shadow buffer also uses. The hot functions of sub-lights are in sublights.c. */
#include "hot/tables.h"

#include "shadow/attenuate_lanes.h"
#include "shadow/blur_lanes.h"
#include "shadow_cascade/cascade_lanes.h"

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

const shadow_functions HL_HOT(shadow) = {attenuate_tile,
                                         lit_blocks_tile,
                                         {blur_rows_tile, blur_columns_tile, lit_blocks_tile, emission_tile},
                                         &cascade,
                                         &HL_HOT(sublights)};
