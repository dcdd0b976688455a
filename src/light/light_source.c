/* light/light_source.c - lights from the scene's words into frame space. */
#include "light/light_source.h"

light_source hl_light_source(const hl_light *light, const hl_render_settings *settings, vec3 centre, vec3 content) {
  light_source source = {.parallel = light->type == HL_LIGHT_DIRECTIONAL, .light = light};
  source.shadows = light->shadows == HL_SHADOWS_DEFAULT ? settings->shadows : light->shadows;
  source.soft_method = settings->soft_method;
  if (source.parallel) {
    source.direction = vec3_normalise(vec3_of(light->direction));
    source.size = 2 * tan(light->angular_diameter_deg * HL_PI / 360);
  } else {
    source.position = vec3_subtract(vec3_of(light->position), centre);
    vec3 way = vec3_subtract(content, source.position);
    source.direction = vec3_length(way) > 0 ? vec3_normalise(way) : (vec3){0, 0, 1};
    source.size = 2 * light->radius;
  }
  if (source.shadows == HL_SHADOWS_SOFT && !(source.size > 0)) source.shadows = HL_SHADOWS_HARD;
  return source;
}
