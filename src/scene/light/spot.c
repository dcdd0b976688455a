/* scene/light/spot.c - implements a light that is a sphere or a point, and shines within a cone. The light
 * looks like the disk of its radius that faces the observer. */
#include "scene/light/light_kind.h"

static hl_status check_cone(const hl_checker *check, const hl_light *light) {
  return hl_check_range(
      check, "falloff_angle_deg", light->falloff_angle_deg, 0, light->opening_angle_deg / 2,
      "give the width of the cone's smooth edge in degrees, from 0 to half the opening angle");
}

static light_shape shape_of(const hl_light *light) {
  light_shape shape = hl_round_shape(light);
  shape.direction = vec3_of(light->direction);
  shape.cone_half_angle = light->opening_angle_deg * HL_PI / 360;
  shape.cone_edge = light->falloff_angle_deg * HL_PI / 180;
  return shape;
}

const light_kind hl_light_kind_spot = {.sphere = true,
                                       .cone = true,
                                       .deviations = 4,
                                       .check = check_cone,
                                       .check_reach = hl_check_round_reach,
                                       .shape = shape_of,
                                       .spread = hl_round_spread,
                                       .point = hl_round_point,
                                       .plane = hl_round_plane,
                                       .apparent_lengths = hl_apparent_diameter};
