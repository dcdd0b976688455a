/* light/lit_region.h - the region of a light's view that its screen, its cone or its sector lights. */
#ifndef HL_LIGHT_LIT_REGION_H
#define HL_LIGHT_LIT_REGION_H

#include "light/light_source.h"
#include "view/view.h"

/* Cuts bounds, in coordinates of a view from the light, down to the lit region; to a point where they do not
 * overlap it. */
void hl_lit_region(const view *view, const light_source *source, double low[2], double high[2]);

#endif
