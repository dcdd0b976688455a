/* compose/rest.c - applies "rest:FRACTION" in the option "show" of a mask: the matter outside the labels gets
 * this fraction of its opacity.
 *
 * hl_mask.rest multiplies extinction. Derived: matter of the optical depth d along a path has the opacity 1 -
 * exp(-d). If its extinction is multiplied by f, the opacity is 1 - exp(-f d). The second opacity is the
 * fraction r of the first opacity if f = -ln(1 - r (1 - exp(-d))) / d. The factor f is near r if d is small,
 * and is 1 for r = 1. */
#include <math.h>

#include "compose/composer.h"
#include "elementary/elementary.h"
#include "scene/function/transfer_function.h"
#include "scene/geometry/placement.h"
#include "volume/volume.h"

/* A limit of opacities, which is below 1, because an opacity of 1 has an infinite extinction. */
#define MOST_OPACITY 0.9999

/* The optical depth along a typical path: the mean extinction of the visible voxels, times the edge of a cube
 * that has the same number of voxels. The result is 0 if opacity does not depend on the value alone. */
static double typical_depth(const hl_scene_volume *seen) {
  const hl_volume *volume = seen->volume;
  const hl_transfer_function *function = &seen->transfer_function;
  if (function->plane.second != HL_SECOND_NONE || !(function->unit_distance > 0)) return 0;
  const double width = (volume->maximum - volume->minimum) / HL_HISTOGRAM_BINS;
  double sum = 0, visible = 0;
  for (int bin = 0; bin < HL_HISTOGRAM_BINS; bin++) {
    double opacity = hl_transfer_function_opacity(function, volume->minimum + (bin + 0.5) * width);
    if (!(opacity > 0)) continue;
    sum -= (double)volume->histogram[bin] * hl_log1p(-fmin(opacity, MOST_OPACITY)) / function->unit_distance;
    visible += (double)volume->histogram[bin];
  }
  const mat3 placed = hl_scene_volume_index_to_world(seen).linear;
  const double voxel = fabs(vec3_dot(placed.row[0], vec3_cross(placed.row[1], placed.row[2])));
  return visible > 0 ? sum / visible * hl_cbrt(visible * voxel) : 0;
}

void hl_compose_rest(hl_scene_volume *volume) {
  const double rest = volume->mask.rest;
  if (volume->mask.volume == NULL || !(rest > 0 && rest < 1)) return;
  const double depth = typical_depth(volume);
  if (depth > 0) volume->mask.rest = fmin(-hl_log1p(rest * hl_expm1(-depth)) / depth, 1);
}
