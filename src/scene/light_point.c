/* scene/light_point.c - a light that is a sphere, or a point, that shines to all sides: it looks like the
 * disk of its radius that faces whoever looks. */
#include "scene/light_kind.h"

static mat3 spread(const hl_light *light, vec3 facing) { return hl_disk_spread(facing, light->radius); }

static vec3 point(const hl_light *light, vec3 facing, double a, double b) {
  return hl_disk_point(facing, light->radius, a, b);
}

static emission_plane plane(const hl_light *light, vec3 facing) {
  return hl_disk_plane(facing, light->radius, vec3_of(light->emission.up));
}

const light_kind hl_light_kind_point = {.sphere = true,
                                        .deviations = 4,

                                        .check_reach = hl_check_round_reach,
                                        .centre = hl_position_of_light,
                                        .spread = spread,
                                        .point = point,
                                        .plane = plane,
                                        .has_surface = hl_has_radius,
                                        .is_wide = hl_has_radius,
                                        .apparent_lengths = hl_apparent_diameter};
