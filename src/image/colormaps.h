/* image/colormaps.h - finds colours of the named colormaps. */
#ifndef HL_IMAGE_COLORMAPS_H
#define HL_IMAGE_COLORMAPS_H

#include <stdbool.h>

enum { HL_COLORMAPS_MOST = 32 }; /* at least the number of named colormaps */

/* Sets `linear` to the linear RGB of a named colormap at t, which is clamped to [0,1]. Returns false if no
 * colormap has the name. */
bool hl_colormap_evaluate(const char *name, double t, double linear[3]);

#endif
