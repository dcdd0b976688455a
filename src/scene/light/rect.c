/* scene/light/rect.c - implements a light that is a parallelogram, given by its centre and two edges. If one
 * of the edges has no length, the light is a line. */
#include "scene/light/light_kind.h"

/* The least area of a parallelogram that can carry an image, as a fraction of the product of its edges. */
static const double THIN = 1e-6;

static hl_status reaches(const hl_checker *check, const hl_light *light, const hl_frame_space *space) {
  hl_status status = hl_check_round_reach(check, light, space);
  if (status == HL_OK) status = hl_check_reach(check, "edge1", vec3_length(vec3_of(light->edge1)), space);
  if (status == HL_OK) status = hl_check_reach(check, "edge2", vec3_length(vec3_of(light->edge2)), space);
  return status;
}

static light_shape shape_of(const hl_light *light) {
  vec3 edge1 = vec3_of(light->edge1), edge2 = vec3_of(light->edge2);
  double length1 = vec3_length(edge1), length2 = vec3_length(edge2);
  return (light_shape){.centre = vec3_of(light->position),
                       .edge1 = edge1,
                       .edge2 = edge2,
                       .is_wide = length1 + length2 > 0,
                       .has_surface = vec3_length(vec3_cross(edge1, edge2)) > THIN * length1 * length2};
}

/* The mean of the matrix x x' over the points x of a parallelogram, relative to its centre. Derived: the mean
 * of t^2 over t in [-1/2, 1/2] is 1/12. */
static mat3 spread(const light_shape *shape, vec3 facing) {
  (void)facing;
  mat3 none = {{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}};
  return hl_add_scaled(hl_add_scaled(none, hl_outer(shape->edge1, shape->edge1), 1.0 / 12),
                       hl_outer(shape->edge2, shape->edge2), 1.0 / 12);
}

static vec3 point(const light_shape *shape, vec3 facing, double a, double b) {
  (void)facing;
  return vec3_add(vec3_scale(shape->edge1, a - 0.5), vec3_scale(shape->edge2, b - 0.5));
}

static emission_plane plane(const light_shape *shape, vec3 facing) {
  (void)facing;
  return (emission_plane){
      .middle = {0, 0, 0}, .right = vec3_scale(shape->edge1, 0.5), .up = vec3_scale(shape->edge2, 0.5)};
}

static void apparent_lengths(const light_shape *shape, vec3 along, double length[2]) {
  length[0] = vec3_length(vec3_cross(shape->edge1, along));
  length[1] = vec3_length(vec3_cross(shape->edge2, along));
}

/* The table of parallelograms. The extent of a box is sqrt(12) standard deviations. */
const light_kind hl_light_kind_rect = {.parallelogram = true,
                                       .deviations = 3.4641016151377544,
                                       .check_reach = reaches,
                                       .shape = shape_of,
                                       .spread = spread,
                                       .point = point,
                                       .plane = plane,
                                       .apparent_lengths = apparent_lengths};
