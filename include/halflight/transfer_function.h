/* halflight/transfer_function.h - transfer functions: what the values of a volume look like.
 *
 * Opacities are per unit of length, colours linear RGB.
 */
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

/* What a transfer function takes as its second number. */
typedef enum hl_second_axis {
  HL_SECOND_NONE = 0,
  HL_SECOND_GRADIENT = 1, /* the length of the data's gradient, found with the scene's kernel, in data
                           * units per world unit */
  HL_SECOND_VOLUME = 2    /* the value of another volume of the scene at the same place, whether or not the
                           * scene shows it; beyond the other volume's faces, the values at its faces
                           * continue */
} hl_second_axis;

/* The following shapes lie in the plane of a transfer function of two numbers, whose points are [value,
 * second number]. Where a shape has the weight w, matter has w times the extinction that follows from the
 * shape's opacity. Where shapes overlap, their extinctions add up, and their colours are averaged with the
 * extinctions as weights. */

/* A box. Its weight rises from 0 at its border to 1 over the width `edge`; or the weight is a Gaussian. */
typedef struct hl_function_box {
  double low[2], high[2]; /* its corners belong to it */
  double color[3];        /* linear RGB */
  double opacity;         /* per unit_distance */
  double edge[2];         /* 0: hard; at most half of the box is edge */
  double sigma; /* above 0: `edge` is not used; the weight is a Gaussian around the box's middle, and 0
                   outside the box. Its standard deviation is this fraction of the box's sides */
} hl_function_box;

/* A polygon, as of Kniss et al.: its weight falls, along straight lines, from the apex to 0 at the border. */
typedef struct hl_function_polygon {
  const double (*vertices)[2]; /* [vertex_count]; the whole border must be visible from the apex */
  size_t vertex_count;
  double apex[2];
  double color[3]; /* linear RGB */
  double opacity;  /* per unit_distance */
  double falloff;  /* the part of the way from the apex to the border over which the weight falls: 1: from
                    * the apex on, 0: the border is hard */
} hl_function_polygon;

/* An image, which is interpolated bilinearly between the middles of its pixels. Outside the image nothing is
 * visible. */
typedef struct hl_function_image {
  const char *file;    /* where the pixels came from, for hl_scene_to_json; may be null */
  const float *pixels; /* [height][width][4]: linear RGB times opacity, and opacity per unit_distance; the top
                          row has the greatest second numbers; null: there is no image */
  int width, height;
  double low[2], high[2]; /* the part of the plane that the image covers: from the outer border of its first
                           * pixels to the outer border of its last ones */
} hl_function_image;

/* A transfer function of two numbers. */
typedef struct hl_function_plane {
  hl_second_axis second; /* HL_SECOND_NONE: the transfer function depends on the value alone */
  const char *volume;    /* HL_SECOND_VOLUME: the name of the other volume */
  const hl_function_box *boxes;
  size_t box_count;
  const hl_function_polygon *polygons;
  size_t polygon_count;
  hl_function_image image;
  double second_scale; /* the second number is multiplied by this factor before the function uses it; 0 counts
                        * as 1 */
} hl_function_plane;

/* What the values of a volume look like: opacity and colour are piecewise linear in data values, and
 * constant beyond the end points. */
typedef struct hl_transfer_function {
  double unit_distance;            /* world units; opacities are per this length */
  const hl_opacity_point *opacity; /* sorted by value */
  size_t opacity_count;
  const hl_color_point *color; /* sorted by value; linear RGB */
  size_t color_count;
  /* Factors of extinction, 0 to 1, by the length of the data's gradient. `value` is a length in data units
   * per world unit; points are sorted by it. Without points the factor is 1 everywhere. */
  const hl_opacity_point *gradient_opacity;
  size_t gradient_opacity_count;
  /* A function of two numbers. If there is one, a scene makes opacity and color from it: for each value the
   * greatest opacity that the value has with any second number, and the mean colour. */
  hl_function_plane plane;
} hl_transfer_function;

/* ---- functions that make transfer functions: release their points with hl_transfer_function_release()
 * ---- */

/* Makes a transfer function from the volume's values alone. It separates objects from their background in CT,
 * MR and simulations alike. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_automatic(hl_context *context, const hl_volume *volume,
                                                               hl_transfer_function *function,
                                                               hl_error *error);
/* Makes a transfer function from a preset, which adapts to the volume's values. name: one of
 * hl_preset_name(). */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_preset(hl_context *context, const char *name,
                                                            const hl_volume *volume,
                                                            hl_transfer_function *function, hl_error *error);
/* Replaces the colours by a named colormap over [low, high]. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_colormap(hl_context *context, const char *name,
                                                              double low, double high,
                                                              hl_transfer_function *function,
                                                              hl_error *error);
/* Finds the range that holds nearly all values that are visible with this function, as seen from any side. It
 * is a good range for a colormap. Where nothing is visible, it is the volume's range. range[0] < range[1]. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_seen_range(const hl_volume *volume,
                                                                const hl_transfer_function *function,
                                                                double range[2], hl_error *error);
/* The range of values that have opacity: from where opacity first rises above zero to where it last falls to
 * zero, cut to the volume's values. range[0] < range[1]. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_visible_range(const hl_volume *volume,
                                                                   const hl_transfer_function *function,
                                                                   double range[2], hl_error *error);
/* How a function spreads over a range of values. */
typedef enum hl_range_scale {
  HL_RANGE_LINEAR = 0,
  HL_RANGE_LOG = 1 /* colours are spread evenly over the values' logarithms; the range must be above 0 */
} hl_range_scale;
/* Makes the function *to by moving the points of `from`: the values from old[0] to old[1] become those from
 * range[0] to range[1]. Lengths of gradients are multiplied by the ratio of the ranges' widths. With
 * HL_RANGE_LOG, *to gets further points, so that it follows the logarithm between points, too. Beyond the
 * range, *to then stays as it is at the range's ends. The caller owns the points of *to. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_spread(hl_context *context,
                                                            const hl_transfer_function *from,
                                                            const double old[2], const double range[2],
                                                            hl_range_scale scale, hl_transfer_function *to,
                                                            hl_error *error);
/* Replaces the colours as hl_transfer_function_colormap() does, but spreads the colormap over the values from
 * range[0] to range[1] evenly or by their logarithms. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_colormap_scaled(hl_context *context, const char *name,
                                                                     const double range[2],
                                                                     hl_range_scale scale,
                                                                     hl_transfer_function *function,
                                                                     hl_error *error);
/* Reads Halflight's own JSON object, a scene (its first volume's function), ParaView's .json colour maps, the
 * boxes of ParaView's states (.pvsm), or Slicer's .vp.json, .vp, and presets.xml (path: FILE.xml:PRESET). If
 * the file has only colours, opacity becomes null, and the caller must take opacity points from elsewhere.
 * Slicer's lengths of gradients, like VTK's, are per mean voxel edge and end at a quarter of the range of
 * values. They are converted for the volume; if it is null, as for voxels with edges of 1. From a .vp.json of
 * several components, the functions of the volume's component are read; it is an error if the volume is null
 * or has another component. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_load_for(hl_context *context, const char *path,
                                                              const hl_volume *volume,
                                                              hl_transfer_function *function,
                                                              hl_error *error);
/* The same, volume null. */
HL_API HL_WARN_UNUSED hl_status hl_transfer_function_load(hl_context *context, const char *path,
                                                          hl_transfer_function *function, hl_error *error);
HL_API void hl_transfer_function_release(hl_context *context, hl_transfer_function *function);
HL_API const char *hl_preset_name(size_t index);   /* null past the last */
HL_API const char *hl_colormap_name(size_t index); /* null past the last */

#ifdef __cplusplus
}
#endif
#endif
