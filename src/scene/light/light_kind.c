/* scene/light/light_kind.c - finds the table of a light's type, and has functions that several types
 * share. */
#include "scene/light/light_kind.h"

#define HL_LIGHT_KIND(value, name) [value] = &hl_light_kind_##name,
static const light_kind *const kinds[] = {HL_LIGHT_KINDS};
#undef HL_LIGHT_KIND

const light_kind *hl_light_kind(const hl_light *light) { return kinds[light->type]; }

vec3 hl_position_of_light(const hl_light *light) { return vec3_of(light->position); }

hl_status hl_check_round_reach(const hl_checker *check, const hl_light *light, const hl_frame_space *space) {
  hl_status status = hl_check_distance(check, "position", light->position, space);
  return status == HL_OK ? hl_check_reach(check, "radius", light->radius, space) : status;
}

bool hl_has_radius(const hl_light *light) { return light->radius > 0; }

void hl_apparent_diameter(const hl_light *light, vec3 along, double length[2]) {
  (void)along;
  length[0] = length[1] = 2 * light->radius;
}

mat3 hl_round_spread(const hl_light *light, vec3 facing) { return hl_disk_spread(facing, light->radius); }

vec3 hl_round_point(const hl_light *light, vec3 facing, double a, double b) {
  return hl_disk_point(facing, light->radius, a, b);
}

emission_plane hl_round_plane(const hl_light *light, vec3 facing) {
  return hl_disk_plane(facing, light->radius, vec3_of(light->emission.up));
}
