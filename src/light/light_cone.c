/* light/light_cone.c - a spot light's cone from the scene's angles. */
#include "light/light_cone.h"

light_cone hl_light_cone(const light_source *source, vec3 content, double pixel) {
  const hl_light *light = source->light;
  light_cone cone = {.scale = 0};
  if (light->type != HL_LIGHT_SPOT) return cone;
  double distance = vec3_length(vec3_subtract(content, source->position));
  double edge = light->falloff_angle_deg * HL_PI / 180, opening = light->opening_angle_deg * HL_PI / 360;
  double sharpest = distance > pixel ? pixel / distance : 1, middle = opening - edge / 2;
  edge = fmax(edge, sharpest);
  double outer = cos(fmin(middle + edge / 2, HL_PI)), full = cos(fmax(middle - edge / 2, 0));
  vec3_store(cone.axis, vec3_normalise(vec3_of(light->direction)));
  cone.outer = (float)outer;
  cone.scale = (float)(1 / (full - outer));
  return cone;
}
