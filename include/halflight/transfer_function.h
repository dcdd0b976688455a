/* halflight/transfer_function.h - makes transfer functions, which give each value of a volume its opacity and
 * colour.
 *
 * Opacities are per unit of length. Colours are linear RGB. */
#ifndef HALFLIGHT_TRANSFER_FUNCTION_H
#define HALFLIGHT_TRANSFER_FUNCTION_H

#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hl_opacity_point {
  double value, opacity;
} hl_opacity_point;
typedef struct hl_color_point {
  double value;
  double color[3];
} hl_color_point;

/* The second number of a transfer function of two numbers. The first number is the volume's value. */
typedef enum hl_second_axis {
  HL_SECOND_NONE = 0,
  HL_SECOND_GRADIENT = 1, /* the length of the gradient of the volume's values, which the scene's kernel
                           * gives, in data units per world unit */
  HL_SECOND_VOLUME = 2    /* the value of another volume of the scene at the same place, whether or not the
                           * scene shows that volume. Beyond the other volume's faces, its values at the faces
                           * continue */
} hl_second_axis;

/* The following shapes lie in the plane of a transfer function of two numbers, whose points are [value,
 * second number]. Where a shape has the weight w, matter has w times the extinction that follows from the
 * shape's opacity. Where shapes overlap, their extinctions add up, and their colours are averaged with the
 * extinctions as weights. */

/* A box. Its weight rises from 0 at the border to 1 at the distance `edge` from the border. With sigma, the
 * weight is a Gaussian instead. */
typedef struct hl_function_box {
  double low[2], high[2]; /* the corners with the least and the greatest numbers; both belong to the box */
  double color[3];        /* linear RGB */
  double opacity;         /* per unit_distance */
  double edge[2];         /* the width of the edge along both axes; if 0, the weight is 1 up to the border; at
                           * most half of the box's side */
  double sigma; /* above 0: the weight is a Gaussian around the box's middle, and `edge` is not used. The
                 * Gaussian's standard deviation is this fraction of the box's sides, and it is cut off at the
                 * box's border */
} hl_function_box;

/* A polygon, as in Kniss et al. Its weight falls along straight lines from the apex to 0 at the border. */
typedef struct hl_function_polygon {
  const double (*vertices)[2]; /* [vertex_count]; straight lines from the apex to all points of the border
                                * must lie in the polygon */
  size_t vertex_count;
  double apex[2];
  double color[3]; /* linear RGB */
  double opacity;  /* per unit_distance */
  double falloff;  /* the part of the way from the apex to the border over which the weight falls. 1: it falls
                    * over the whole way; 0: it is 1 up to the border */
} hl_function_polygon;

/* An image over the plane. It is interpolated bilinearly between the middles of its pixels. Outside the image
 * nothing is visible. */
typedef struct hl_function_image {
  const char *file;    /* the file that the pixels came from, which hl_scene_to_json writes; may be null */
  const float *pixels; /* [height][width][4]: linear RGB times opacity, and opacity per unit_distance. The top
                        * row has the greatest second numbers; null if there is no image */
  int width, height;
  double low[2], high[2]; /* the least and the greatest numbers that the image covers: its outermost pixels
                           * end there */
} hl_function_image;

/* An opacity that depends on the first number alone, and a colour that depends on the second number alone:
 * one volume shows in the colours of another one. Both are piecewise linear, and constant beyond the first
 * and the last point. Without colours, the volume is white. */
typedef struct hl_function_curves {
  const hl_opacity_point
      *opacity; /* sorted by value; per unit_distance; without points there are no curves */
  size_t opacity_count;
  const hl_color_point *color; /* sorted by the second number; linear RGB */
  size_t color_count;
  /* Where the second number lies between own_between[0] and own_between[1], the volume keeps a colour of its
   * own, which depends on its value: own_color. If both are equal, this is nowhere. */
  double own_between[2];
  const hl_color_point *own_color; /* sorted by value; linear RGB; without points, white */
  size_t own_color_count;
} hl_function_curves;

/* The part of a transfer function that depends on two numbers. */
typedef struct hl_function_plane {
  hl_second_axis second; /* HL_SECOND_NONE: the transfer function depends on the value alone */
  const char *volume;    /* for HL_SECOND_VOLUME: the name of the other volume */
  const hl_function_box *boxes;
  size_t box_count;
  const hl_function_polygon *polygons;
  size_t polygon_count;
  hl_function_image image;
  hl_function_curves curves;
  double second_scale; /* a factor by which the second number is multiplied before the function uses it; 0
                        * counts as 1 */
} hl_function_plane;

/* A transfer function: the opacity and colour of each data value of a volume. Both are piecewise linear in
 * the data value, and constant beyond the first and the last point. */
typedef struct hl_transfer_function {
  double unit_distance;            /* the length, in world units, to which opacities refer */
  const hl_opacity_point *opacity; /* sorted by value */
  size_t opacity_count;
  const hl_color_point *color; /* sorted by value; linear RGB */
  size_t color_count;
  /* The factor, 0 to 1, by which extinction is multiplied, as a function of the length of the data's
   * gradient. `value` is this length, in data units per world unit; points are sorted by it. Without points
   * the factor is 1. */
  const hl_opacity_point *gradient_opacity;
  size_t gradient_opacity_count;
  /* A function of two numbers. If it is set, a scene derives `opacity` and `color` from it. A value's opacity
   * is the greatest opacity that the value has with any second number; its colour is the mean colour. */
  hl_function_plane plane;
} hl_transfer_function;

/* ---- functions that make transfer functions: release their points with hl_transfer_function_release()
 * ---- */

/* Makes a transfer function from nothing but the volume's values. It separates objects from their background
 * in CT, MR and simulations alike. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_automatic(hl_context *context, const hl_volume *volume,
                                                               hl_transfer_function *function,
                                                               hl_error *error);
/* Makes a transfer function from a preset, which adapts to the volume's values. name: a preset's name
 * (hl_preset_name()). */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_preset(hl_context *context, const char *name,
                                                            const hl_volume *volume,
                                                            hl_transfer_function *function, hl_error *error);
/* Replaces the colours of a transfer function by a named colormap over the values from low to high. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_colormap(hl_context *context, const char *name,
                                                              double low, double high,
                                                              hl_transfer_function *function,
                                                              hl_error *error);
/* Finds the range that holds nearly all values that are visible with this function, as seen from any side.
 * This range is a good range for a colormap. If nothing is visible, the result is the volume's range. Always
 * range[0] < range[1]. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_seen_range(const hl_volume *volume,
                                                                const hl_transfer_function *function,
                                                                double range[2], hl_error *error);
/* Finds the range of values that have opacity. It goes from the value at which opacity first rises above 0 to
 * the value at which opacity last falls to 0, and is cut to the range of the volume's values. Always range[0]
 * < range[1]. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_visible_range(const hl_volume *volume,
                                                                   const hl_transfer_function *function,
                                                                   double range[2], hl_error *error);
/* The ways in which the colours or points of a function are spread over a range of values. */
typedef enum hl_range_scale {
  HL_RANGE_LINEAR = 0,
  HL_RANGE_LOG = 1 /* they are spread evenly over the logarithms of the values; the range must be above 0 */
} hl_range_scale;
/* The scale by which the colours of a function were spread. It is HL_RANGE_LOG if they have a point at each
 * of the equal ratios into which this scale divides their range. */
HL_API hl_range_scale hl_transfer_function_scale(const hl_transfer_function *function);
/* Makes the function *to by moving the points of `from`: the values from old[0] to old[1] become the values
 * from range[0] to range[1]. Lengths of gradients are multiplied by the ratio of the ranges' widths. With
 * HL_RANGE_LOG, *to gets further points, so that it follows the logarithm between the moved points, too;
 * beyond the range, *to is constant. The caller owns the points of *to. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_spread(hl_context *context,
                                                            const hl_transfer_function *from,
                                                            const double old[2], const double range[2],
                                                            hl_range_scale scale, hl_transfer_function *to,
                                                            hl_error *error);
/* The uses for which hl_transfer_function_spread_over() spreads a function. */
typedef enum hl_spread_use {
  HL_SPREAD_ALONE = 0,     /* the function's own colours are shown */
  HL_SPREAD_COLORMAP = 1,  /* a colormap over the range replaces the function's colours */
  HL_SPREAD_PROJECTION = 2 /* the function is for a maximum projection */
} hl_spread_use;
/* Spreads a volume's function over a range, as the option "range" does: the value from which opacity rises
 * becomes range[0], and the value at which opacity ends becomes range[1]. The same holds for colours. Evenly
 * spread opacity does not move to an end of the range that chooses no values: an end beyond the volume's
 * values, or with a colormap an end at values that the function keeps clear. Clear values between such an end
 * and the visible values stay clear. If `from` shows values on both sides of clear ones, as for a signed
 * field, the middle of the clear values keeps its place, and each side is spread over its part of the range.
 * If the range lies on one side, the other side is left out, and values before the range are clear. In a
 * maximum projection the range of the colours becomes range[0] to range[1]. The caller owns the points of
 * *to. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_spread_over(hl_context *context, const hl_volume *volume,
                                                                 const hl_transfer_function *from,
                                                                 const double range[2], hl_range_scale scale,
                                                                 hl_spread_use use, hl_transfer_function *to,
                                                                 hl_error *error);
/* Makes the function *to, whose colours fit the background of a maximum projection: from the least value of
 * `from` up to the value from which the automatic function shows objects, the colours fade into the
 * background. The first colour would else surround the objects as a box or ring of noise. *to is a copy where
 * the first colour is nearly the background's, where the least value belongs to an object, and where the
 * function ends before objects begin. background: linear RGB. The caller owns the points of *to. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_fade(hl_context *context, const hl_volume *volume,
                                                          const double background[3],
                                                          const hl_transfer_function *from,
                                                          hl_transfer_function *to, hl_error *error);
/* Replaces the colours as hl_transfer_function_colormap() does, but spreads the colormap over the values from
 * range[0] to range[1] evenly or by their logarithms. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_colormap_scaled(hl_context *context, const char *name,
                                                                     const double range[2],
                                                                     hl_range_scale scale,
                                                                     hl_transfer_function *function,
                                                                     hl_error *error);
/* Reads Halflight's own JSON object, a scene (its first volume's function), ParaView's .json colour maps, the
 * boxes of ParaView's states (.pvsm), or Slicer's .vp.json, .vp, and presets.xml (path: FILE.xml:PRESET). If
 * the file has only colours, opacity becomes null, and the caller must take opacity points from elsewhere. In
 * Slicer and VTK, lengths of gradients are per mean voxel edge, and end at a quarter of the range of values.
 * They are converted to this volume's voxels; if volume is null, to voxels with edges of 1. From a .vp.json
 * of several components, the functions of the volume's component are read; it is an error if the volume is
 * null or has another component. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_load_for(hl_context *context, const char *path,
                                                              const hl_volume *volume,
                                                              hl_transfer_function *function,
                                                              hl_error *error);
/* Does what hl_transfer_function_load_for() does if its volume is null. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_load(hl_context *context, const char *path,
                                                          hl_transfer_function *function, hl_error *error);
HL_API void hl_transfer_function_release(hl_context *context, hl_transfer_function *function);
HL_API const char *hl_preset_name(size_t index);   /* null past the last */
HL_API const char *hl_colormap_name(size_t index); /* null past the last */

#ifdef __cplusplus
}
#endif
#endif
