/* hot/field.c - compiles the hot functions of fields: the opacity of cells, and the sky's light in a row of
 * cells. */
#include "hot/tables.h"

#include "field/opacity_lanes.h"
#include "field/sky_lanes.h"

const field_functions HL_HOT(field) = {field_opacity, sky_row};
