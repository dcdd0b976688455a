/* light/lit_region.h - the part of a light's view that its screen, its cone or its sector lets light
 * through. */
#ifndef HL_LIGHT_LIT_REGION_H
#define HL_LIGHT_LIT_REGION_H

#include "light/light_source.h"
#include "view/view.h"

/* Cuts bounds in the coordinates of a view from the light down to what is lit; where nothing within them is,
 * to a point. */
void hl_lit_region(const view *view, const light_source *source, double low[2], double high[2]);

#endif
