/* scene/light/directional.c - a light that is infinitely far away: its points are directions, a disk around
 * the way that it travels. */
#include "scene/light/light_kind.h"

static double radius_of(const hl_light *light) { return tan(light->angular_diameter_deg * HL_PI / 360); }

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

static mat3 spread(const hl_light *light, vec3 facing) { return hl_disk_spread(facing, radius_of(light)); }

static vec3 point(const hl_light *light, vec3 facing, double a, double b) {
  return hl_disk_point(facing, radius_of(light), a, b);
}

static emission_plane plane(const hl_light *light, vec3 facing) {
  return hl_disk_plane(facing, radius_of(light), vec3_of(light->emission.up));
}

static bool is_wide(const hl_light *light) { return light->angular_diameter_deg > 0; }

const light_kind hl_light_kind_directional = {.parallel = true,
                                              .deviations = 4,
                                              .check = check_falloff,
                                              .check_reach = reaches,
                                              .spread = spread,
                                              .point = point,
                                              .plane = plane,
                                              .has_surface = is_wide,
                                              .is_wide = is_wide};
