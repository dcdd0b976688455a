/* scene/light/directional.c - implements a light that is infinitely far away. The light's points are
 * directions: a disk around the direction in which the light travels. */
#include "elementary/elementary.h"
#include "scene/light/light_kind.h"

static hl_status check_falloff(const hl_checker *check, const hl_light *light) {
  if (light->falloff == HL_FALLOFF_NONE) return HL_OK;
  return hl_check_refuse(
      check, "falloff",
      "inverse_square on a directional light, which is infinitely far: use none, or a point light");
}

static hl_status reaches(const hl_checker *check, const hl_light *light, const hl_frame_space *space) {
  (void)check, (void)light, (void)space;
  return HL_OK;
}

static light_shape shape_of(const hl_light *light) {
  bool wide = light->angular_diameter_deg > 0;
  return (light_shape){.direction = vec3_of(light->direction),
                       .radius = hl_tan(light->angular_diameter_deg * HL_PI / 360),
                       .is_wide = wide,
                       .has_surface = wide};
}

const light_kind hl_light_kind_directional = {.parallel = true,
                                              .deviations = 4,
                                              .check = check_falloff,
                                              .check_reach = reaches,
                                              .shape = shape_of,
                                              .spread = hl_round_spread,
                                              .point = hl_round_point,
                                              .plane = hl_round_plane};
