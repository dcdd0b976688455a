/* scene/light/disk.c - a light that is a flat disk with a normal. */
#include "scene/light/light_kind.h"

static vec3 normal_of(const hl_light *light) { return vec3_normalise(vec3_of(light->normal)); }

static mat3 spread(const hl_light *light, vec3 facing) {
  (void)facing;
  return hl_round_spread(light, normal_of(light));
}

static vec3 point(const hl_light *light, vec3 facing, double a, double b) {
  (void)facing;
  return hl_round_point(light, normal_of(light), a, b);
}

static emission_plane plane(const hl_light *light, vec3 facing) {
  (void)facing;
  return hl_round_plane(light, normal_of(light));
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
