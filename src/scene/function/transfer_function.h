/* scene/function/transfer_function.h - evaluates transfer functions. */
#ifndef HL_SCENE_FUNCTION_TRANSFER_FUNCTION_H
#define HL_SCENE_FUNCTION_TRANSFER_FUNCTION_H

#include <halflight/scene.h>
#include <stdbool.h>

#include "core/error.h"
#include "image/colormaps.h"
#include "image/srgb.h"

/* hl_transfer_function_opacity() gives the opacity of a data value, per unit_distance, and
 * hl_transfer_function_color() gives its linear colour. Opacity and colour are piecewise linear between
 * points, and constant beyond the ends. */
double hl_transfer_function_opacity(const hl_transfer_function *function, double value);
/* The factor by which gradient opacity multiplies the extinction of matter whose gradient has a given length.
 * The factor is 1 if the function has no gradient opacity. */
double hl_transfer_function_gradient_opacity(const hl_transfer_function *function, double gradient);
void hl_transfer_function_color(const hl_transfer_function *function, double value, double color[3]);

/* The greatest difference between the opacities of two values that are at most `reach` apart; reach: 0 or
 * more, or NAN, which gives NAN. */
double hl_transfer_function_opacity_change(const hl_transfer_function *function, double reach);

/* Returns whether some value from `low` to `high` has an opacity above zero. */
int hl_transfer_function_visible(const hl_transfer_function *function, double low, double high);

/* Finds the transparent value between `low` and `high` that is nearest to `target`, which also lies between
 * `low` and `high`. Returns false if no value between `low` and `high` is transparent. */
bool hl_transfer_function_transparent(const hl_transfer_function *function, double low, double high,
                                      double target, double *nearest);

/* Copies a transfer function. *to owns its points. */
hl_status hl_transfer_function_copy(hl_context *context, const hl_transfer_function *from,
                                    hl_transfer_function *to, hl_error *error);

#define HL_COLORMAP_POINTS 65 /* number of colour points into which a colormap is divided */

static inline bool hl_is_grey(const double color[3]) { return color[0] == color[1] && color[1] == color[2]; }

/* The linear value of middle grey. */
#define HL_MIDDLE_GREY 0.18

/* Whether a colour is brighter than middle grey. color: linear RGB. */
static inline bool hl_color_is_bright(const double color[3]) {
  return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2] > HL_MIDDLE_GREY;
}

#endif
