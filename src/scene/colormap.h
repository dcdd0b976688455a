/* scene/colormap.h - named colormaps, evaluated. */
#ifndef HL_SCENE_COLORMAP_H
#define HL_SCENE_COLORMAP_H

#include <stdbool.h>

#include "core/error.h"
#include "scene/nearest.h"

#define HL_COLORMAP_POINTS 65 /* colour points that stand for a whole map */

double hl_srgb_to_linear(double srgb);

/* Linear RGB at t in [0,1] (clamped); false if there is no such map. */
bool hl_colormap_evaluate(const char *name, double t, double linear[3]);

#endif
