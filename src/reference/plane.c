/* reference/plane.c - evaluates a volume's transfer function of two numbers at one point, directly from the
 * function's description. */
#include <string.h>

#include "reference/reference.h"
#include "scene/function/function_plane.h"

void hl_reference_find_second(const reference *all, size_t index) {
  reference_volume *volume = &all->volumes[index];
  const hl_function_plane *plane = &volume->described->transfer_function.plane;
  if (plane->second != HL_SECOND_VOLUME) return;
  const hl_scene_volume *second = hl_scene_volume_named(all->scene, plane->volume);
  volume->second = &all->volumes[second - all->scene->volumes];
  volume->index_to_second = affine3_multiply(volume->second->world_to_index,
                                             hl_scene_volume_index_to_world(volume->described));
}

plane_sum hl_reference_plane_sum(const reference_volume *volume, double value, vec3 point) {
  const hl_transfer_function *function = &volume->described->transfer_function;
  double second = volume->second != NULL
                      ? hl_reference_value(volume->second, affine3_apply(volume->index_to_second, point))
                      : vec3_length(hl_reference_gradient(volume, point));
  second *= hl_plane_second_scale(&function->plane);
  const plane_box at = {{value, second}, {value, second}};
  return hl_plane_mean(function, &at);
}

void hl_reference_iso_color(const reference_hit *hit, vec3 point, double color[3]) {
  const reference_volume *volume = hit->volume;
  const hl_transfer_function *function = &volume->described->transfer_function;
  memcpy(color, hit->iso->color, 3 * sizeof *color);
  if (!hit->iso->second_color || !hl_has_second_colors(function)) return;
  const vec3 index = affine3_apply(volume->world_to_index, point);
  const double second = hl_reference_value(volume->second, affine3_apply(volume->index_to_second, index));
  hl_curves_color(&function->plane.curves, second * hl_plane_second_scale(&function->plane), hit->iso->color,
                  color);
}

void hl_reference_color(const reference_volume *volume, double value, vec3 point, double color[3]) {
  const hl_transfer_function *function = &volume->described->transfer_function;
  if (!hl_has_plane(function)) {
    hl_transfer_function_color(function, value, color);
    return;
  }
  plane_sum sum = hl_reference_plane_sum(volume, value, point);
  for (int c = 0; c < 3; c++) color[c] = sum.extinction > 0 ? sum.color[c] / sum.extinction : 0;
}
