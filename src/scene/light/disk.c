/* scene/light/disk.c - implements a light that is a flat disk with a normal. */
#include "scene/light/light_kind.h"

static light_shape shape_of(const hl_light *light) {
  light_shape shape = hl_round_shape(light);
  shape.normal = vec3_normalise(vec3_of(light->normal));
  return shape;
}

static mat3 spread(const light_shape *shape, vec3 facing) {
  (void)facing;
  return hl_round_spread(shape, shape->normal);
}

static vec3 point(const light_shape *shape, vec3 facing, double a, double b) {
  (void)facing;
  return hl_round_point(shape, shape->normal, a, b);
}

static emission_plane plane(const light_shape *shape, vec3 facing) {
  (void)facing;
  return hl_round_plane(shape, shape->normal);
}

const light_kind hl_light_kind_disk = {.deviations = 4,
                                       .check_reach = hl_check_round_reach,
                                       .shape = shape_of,
                                       .spread = spread,
                                       .point = point,
                                       .plane = plane,
                                       .apparent_lengths = hl_apparent_diameter};
