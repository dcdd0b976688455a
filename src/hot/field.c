/* hot/field.c - the hot functions of fields: how opaque cells are, and the sky over a row of them. */
#include "hot/tables.h"

#include "field/opacity_lanes.h"
#include "field/sky_lanes.h"

const field_functions HL_HOT(field) = {field_opacity, sky_row};
