/* light/light_source.c - makes light sources of a scene's lights. */
#include "light/light_source.h"

#include "scene/light_shape.h"

/* Square of the size, as a fraction of its distance, up to which a light is a point: no pixel shows its
 * penumbrae. */
static const double POINT_LIKE = 1e-12;

static double trace(mat3 m) { return m.row[0].x + m.row[1].y + m.row[2].z; }

light_source hl_light_source(const hl_light *light, const hl_render_settings *settings, vec3 content) {
  light_source source = {.parallel = light->type == HL_LIGHT_DIRECTIONAL, .content = content, .light = light};
  source.shadows = light->shadows == HL_SHADOWS_DEFAULT ? settings->shadows : light->shadows;
  source.soft_method = settings->soft_method;
  source.screen_center = vec3_of(light->texture.screen_center);
  source.screen_right = vec3_of(light->texture.screen_right);
  source.screen_up = vec3_of(light->texture.screen_up);
  if (source.parallel) {
    source.direction = vec3_normalise(vec3_of(light->direction));
  } else {
    source.position = hl_light_centre(light);
    vec3 way = vec3_subtract(light->texture.pixels != NULL ? source.screen_center : content, source.position);
    if (light->type == HL_LIGHT_SPOT) way = vec3_of(light->direction);
    source.direction = vec3_length(way) > 0 ? vec3_normalise(way) : (vec3){0, 0, 1};
  }
  source.spread = hl_light_spread(light, source.direction);
  double distance = source.parallel ? 1 : vec3_length(vec3_subtract(content, source.position));
  if (source.shadows == HL_SHADOWS_SOFT && !(trace(source.spread) > POINT_LIKE * distance * distance))
    source.shadows = HL_SHADOWS_HARD;
  return source;
}

light_source hl_light_in_sector(const light_source *whole, const light_sectors *sectors, int sector) {
  light_source source = *whole;
  source.sectors = sectors;
  source.sector = sector;
  source.direction = sectors->axis[sector];
  double distance = vec3_length(vec3_subtract(whole->content, whole->position));
  source.content = vec3_add(whole->position, vec3_scale(source.direction, distance > 0 ? distance : 1));
  source.spread = hl_light_spread(whole->light, source.direction);
  return source;
}
