/* scene/light/light_kind.c - finds the table of a light's type, and has the functions that several types
 * share. */
#include "scene/light/light_kind.h"

#define HL_ENTRY(with, value, name, settings) [value] = &hl_light_kind_##name,
static const light_kind *const kinds[] = {HL_LIGHT_KINDS(HL_ENTRY, 0)};
#undef HL_ENTRY

const light_kind *hl_light_kind(const hl_light *light) { return kinds[light->type]; }

light_shape hl_light_shape(const hl_light *light) {
  light_shape shape = hl_light_kind(light)->shape(light);
  shape.kind = hl_light_kind(light);
  shape.image_up = vec3_of(light->emission.up);
  return shape;
}

hl_status hl_check_round_reach(const hl_checker *check, const hl_light *light, const hl_frame_space *space) {
  hl_status status = hl_check_distance(check, "position", light->position, space);
  return status == HL_OK ? hl_check_reach(check, "radius", light->radius, space) : status;
}

light_shape hl_round_shape(const hl_light *light) {
  return (light_shape){.centre = vec3_of(light->position),
                       .radius = light->radius,
                       .is_wide = light->radius > 0,
                       .has_surface = light->radius > 0};
}

void hl_apparent_diameter(const light_shape *shape, vec3 along, double length[2]) {
  (void)along;
  length[0] = length[1] = 2 * shape->radius;
}

mat3 hl_round_spread(const light_shape *shape, vec3 facing) { return hl_disk_spread(facing, shape->radius); }

vec3 hl_round_point(const light_shape *shape, vec3 facing, double a, double b) {
  return hl_disk_point(facing, shape->radius, a, b);
}

emission_plane hl_round_plane(const light_shape *shape, vec3 facing) {
  return hl_disk_plane(facing, shape->radius, shape->image_up);
}
