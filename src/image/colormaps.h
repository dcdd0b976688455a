/* image/colormaps.h - colours of the named colormaps. */
#ifndef HL_IMAGE_COLORMAPS_H
#define HL_IMAGE_COLORMAPS_H

#include <stdbool.h>

enum { HL_COLORMAPS_MOST = 32 }; /* at least the number of colormaps */

/* Sets `linear` to the map's linear RGB at t, which is clamped to [0,1]; false if there is no such map. */
bool hl_colormap_evaluate(const char *name, double t, double linear[3]);

#endif
