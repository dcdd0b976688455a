/* image/colormaps.h - colours of the named colormaps. */
#ifndef HL_IMAGE_COLORMAPS_H
#define HL_IMAGE_COLORMAPS_H

#include <stdbool.h>

enum { HL_COLORMAPS_MOST = 32 }; /* more than there are */

/* Linear RGB at t in [0,1] (clamped); false if there is no such map. */
bool hl_colormap_evaluate(const char *name, double t, double linear[3]);

#endif
