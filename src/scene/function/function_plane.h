/* scene/function/function_plane.h - evaluates transfer functions of two numbers. */
#ifndef HL_SCENE_FUNCTION_FUNCTION_PLANE_H
#define HL_SCENE_FUNCTION_FUNCTION_PLANE_H

#include <halflight/scene.h>
#include <stdbool.h>

#include "core/error.h"

static inline bool hl_has_plane(const hl_transfer_function *function) {
  return function->plane.second != HL_SECOND_NONE;
}

/* The factor by which the second number is multiplied before a transfer function of two numbers uses it. */
static inline double hl_plane_second_scale(const hl_function_plane *plane) {
  return plane->second_scale == 0 ? 1 : plane->second_scale;
}

/* Whether the function's colours are curves over the values of a second volume. */
static inline bool hl_has_second_colors(const hl_transfer_function *function) {
  return function->plane.second == HL_SECOND_VOLUME && function->plane.curves.opacity_count > 0;
}

/* The greatest magnitude of a second number. If an end of own_between has this magnitude, own_between has no
 * end on that side: the volume keeps its own colour at all second numbers from the other end towards that
 * side. */
#define HL_CURVES_NO_END 1e30

/* Whether a volume keeps a colour of its own at some second numbers. */
static inline bool hl_curves_have_own(const hl_function_curves *curves) {
  return curves->own_between[0] < curves->own_between[1];
}

/* Whether the volume keeps its own colour at a second number. */
static inline bool hl_curves_keep_own(const hl_function_curves *curves, double second) {
  return second > curves->own_between[0] && second < curves->own_between[1];
}

/* Finds the colour of the curves at a second number. own: linear RGB; the volume's own colour, which the
 * volume may keep at this second number. */
void hl_curves_color(const hl_function_curves *curves, double second, const double own[3], double color[3]);

/* The keys under which a scene file has the ranges of the two axes: "value" and "second". */
extern const char *const hl_plane_range_keys[2];

/* A rectangle of the plane of two numbers, from low to high: [value, second number]. */
typedef struct plane_box {
  double low[2], high[2];
} plane_box;

/* Finds the box around all shapes of a function of two numbers. Returns false if the function has no shapes.
 */
bool hl_plane_bounds(const hl_function_plane *plane, plane_box *bounds);

/* Sums over all shapes of a function of two numbers. Each shape adds its mean over a part of the plane. */
typedef struct plane_sum {
  double extinction; /* extinction per world unit */
  double color[3];   /* linear RGB, multiplied by extinction */
} plane_sum;

/* The mean of a function of two numbers over a part of the plane. If low and high are equal, the result is
 * the function's value at this point. */
plane_sum hl_plane_mean(const hl_transfer_function *function, const plane_box *part);

/* Replaces the function's opacity and colour by the outline of the plane: a function of the value alone, over
 * the values between low and high. The outline's opacity at a value is at least the greatest opacity over all
 * second numbers, and is 0 only if the function shows nothing at any second number. The new points are owned
 * by *function; the old points are not freed. */
hl_status hl_plane_outline(hl_context *context, double low, double high, hl_transfer_function *function,
                           hl_error *error);

/* Copies the plane of a function of two numbers. *to owns its arrays and texts, also after a failure
 * (hl_plane_release). */
hl_status hl_plane_copy(hl_context *context, const hl_function_plane *from, hl_function_plane *to,
                        hl_error *error);
void hl_plane_release(hl_context *context, hl_function_plane *plane);

/* A hash of the content of a function's plane, which identifies this content. */
uint64_t hl_plane_mark(const hl_function_plane *plane);

/* Checks the plane of a transfer function. place: the JSON pointer of the function, for errors. */
hl_status hl_plane_check(const hl_function_plane *plane, const char *place, hl_error *error);

#endif
