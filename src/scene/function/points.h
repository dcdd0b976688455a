/* scene/function/points.h - evaluates lists of points: functions that are linear between points, and constant
 * beyond the first and the last point.
 *
 * Two points at the same value make a step. At the value of a step, the function has the number of the second
 * point.
 */
#ifndef HL_SCENE_FUNCTION_POINTS_H
#define HL_SCENE_FUNCTION_POINTS_H

#include <halflight/transfer_function.h>

/* The number of points whose value is at most `value`. Points begin with their value, and are `stride` bytes
 * apart. */
size_t hl_points_not_above(const void *points, size_t count, size_t stride, double value);

/* The opacity at a value. The list must have at least one point. */
double hl_points_opacity(const hl_opacity_point *points, size_t count, double value);

/* The colour at a value; white if the list has no points. */
void hl_points_color(const hl_color_point *points, size_t count, double value, double color[3]);

#endif
