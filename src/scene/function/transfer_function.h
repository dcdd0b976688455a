/* scene/function/transfer_function.h - evaluating transfer functions. */
#ifndef HL_SCENE_FUNCTION_TRANSFER_FUNCTION_H
#define HL_SCENE_FUNCTION_TRANSFER_FUNCTION_H

#include <halflight/scene.h>
#include <stdbool.h>

#include "core/error.h"
#include "image/colormaps.h"
#include "image/srgb.h"

/* The opacity (per unit_distance) or the linear colour of a data value. They are piecewise linear between
 * points, and constant beyond the ends. */
double hl_transfer_function_opacity(const hl_transfer_function *function, double value);
/* The factor by which gradient opacity multiplies extinction, for a gradient's length; 1 without gradient
 * opacity. */
double hl_transfer_function_gradient_opacity(const hl_transfer_function *function, double gradient);
void hl_transfer_function_color(const hl_transfer_function *function, double value, double color[3]);

/* True if some value in [low, high] has opacity above zero. */
int hl_transfer_function_visible(const hl_transfer_function *function, double low, double high);

/* The transparent value in [low, high] that is nearest to target (inside them); false if there is none. */
bool hl_transfer_function_transparent(const hl_transfer_function *function, double low, double high,
                                      double target, double *nearest);

/* The values over which a function grades what it shows, which "range" then moves: in pictures with light,
 * the visible range; in a maximum projection, where opacity only says whether a value counts, the values from
 * the first colour to the last one. If these are the same, the visible range. */
hl_status hl_transfer_function_graded_range(const hl_volume *volume, const hl_transfer_function *function,
                                            bool projected, double range[2], hl_error *error);

/* Copies a function; *to owns its points. */
hl_status hl_transfer_function_copy(hl_context *context, const hl_transfer_function *from,
                                    hl_transfer_function *to, hl_error *error);

#define HL_COLORMAP_POINTS 65 /* number of colour points into which a colormap is divided */

static inline bool hl_is_grey(const double color[3]) { return color[0] == color[1] && color[1] == color[2]; }

#endif
