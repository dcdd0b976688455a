/* scene/light_disk.c - a light that is a flat disk with a normal. */
#include "scene/light_kind.h"

static vec3 normal_of(const hl_light *light) { return vec3_normalise(vec3_of(light->normal)); }

static mat3 spread(const hl_light *light, vec3 facing) {
  (void)facing;
  return hl_disk_spread(normal_of(light), light->radius);
}

static vec3 point(const hl_light *light, vec3 facing, double a, double b) {
  (void)facing;
  return hl_disk_point(normal_of(light), light->radius, a, b);
}

static emission_plane plane(const hl_light *light, vec3 facing) {
  (void)facing;
  return hl_disk_plane(normal_of(light), light->radius, vec3_of(light->emission.up));
}

const light_kind hl_light_kind_disk = {.deviations = 4,
                                       .check_reach = hl_check_round_reach,
                                       .centre = hl_position_of_light,
                                       .spread = spread,
                                       .point = point,
                                       .plane = plane,
                                       .has_surface = hl_has_radius,
                                       .is_wide = hl_has_radius,
                                       .apparent_lengths = hl_apparent_diameter};
