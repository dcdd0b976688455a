/* figure/strip.h - draws the strip of a legend: a transfer function's colours over the values, with a curve
 * of the opacity at its left and numbers at its right. */
#ifndef HL_FIGURE_STRIP_H
#define HL_FIGURE_STRIP_H

#include "core/error.h"
#include "figure/ink.h"
#include "scene/function/transfer_function.h"

/* The values along a strip, from its lower end to its upper end. */
typedef struct hl_strip_scale {
  double low, high; /* low < high; above 0 if `logarithmic` */
  bool logarithmic; /* whether equal ways along the strip are equal ratios of values, not equal differences */
  bool even;        /* whether all values from low to high have the same opacity, so that there is no curve */
  double own[2];    /* the two values between which the matter keeps its own colour, so that the strip shows
                     * own_color; equal if there is no such range of values */
  double own_color[3]; /* linear RGB */
} hl_strip_scale;

/* Returns whether all values have the same opacity, as in a slice, so that only colours distinguish the
 * values. */
bool hl_strip_is_even(const hl_transfer_function *function);

/* Returns the scale, linear or logarithmic, on which a function's colours are spread evenly. range: the
 * values at the ends of the scale. */
hl_strip_scale hl_strip_scale_of(const hl_transfer_function *function, const double range[2]);

/* The width of a strip with its curve and its numbers; points. height: the strip's height, points. */
double hl_strip_width(const hl_ink *ink, const hl_strip_scale *scale, double height);

/* Draws a strip. right: the right edge of the numbers. */
void hl_strip_draw(const hl_ink *ink, const hl_transfer_function *function, const hl_strip_scale *scale,
                   double right, double top, double height);

#endif
