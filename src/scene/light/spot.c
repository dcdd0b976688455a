/* scene/light/spot.c - a light that is a sphere or a point, and shines within a cone. It looks like the disk
 * of its radius that faces the observer. */
#include "scene/light/light_kind.h"

static hl_status check_cone(const hl_checker *check, const hl_light *light) {
  return hl_check_range(
      check, "falloff_angle_deg", light->falloff_angle_deg, 0, light->opening_angle_deg / 2,
      "give the width of the cone's smooth edge in degrees, from 0 to half the opening angle");
}

const light_kind hl_light_kind_spot = {.sphere = true,
                                       .cone = true,
                                       .deviations = 4,
                                       .check = check_cone,
                                       .check_reach = hl_check_round_reach,
                                       .centre = hl_position_of_light,
                                       .spread = hl_round_spread,
                                       .point = hl_round_point,
                                       .plane = hl_round_plane,
                                       .has_surface = hl_has_radius,
                                       .is_wide = hl_has_radius,
                                       .apparent_lengths = hl_apparent_diameter};
