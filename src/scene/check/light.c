/* scene/check/light.c - checks a light by itself: its shape, its texture and its emission image. */
#include <math.h>
#include <stdio.h>

#include "core/vector.h"
#include "scene/check/check.h"
#include "scene/light/light_kind.h"

/* Checks the texture of a light. The light's rays must cross the texture's screen. */
static hl_status check_texture(const hl_checker *parent, const hl_light *light) {
  const hl_light_texture *texture = &light->texture;
  hl_checker check = {parent->error, ""};
  hl_status status;
  if (texture->pixels == NULL) return HL_OK;
  snprintf(check.place, sizeof check.place, "%s/texture", parent->place);
  if ((status = hl_check_pixels(&check, texture->pixels, texture->width, texture->height)) != HL_OK)
    return status;
  if ((status = hl_check_point(&check, "screen/center", texture->screen_center)) != HL_OK) return status;
  if ((status = hl_check_direction(&check, "screen/right", texture->screen_right)) != HL_OK) return status;
  if ((status = hl_check_direction(&check, "screen/up", texture->screen_up)) != HL_OK) return status;
  vec3 right = vec3_normalise(vec3_of(texture->screen_right)),
       up = vec3_normalise(vec3_of(texture->screen_up));
  vec3 normal = vec3_cross(right, up), center = vec3_of(texture->screen_center);
  if (!(vec3_length(normal) > 1e-4))
    return hl_check_refuse(&check, "screen/up", "lies along right: give two directions that span the screen");
  vec3 way = hl_light_kind(light)->parallel ? vec3_of(light->direction)
                                            : vec3_subtract(center, hl_light_shape(light).centre);
  if (!(fabs(vec3_dot(vec3_normalise(normal), vec3_normalise(way))) > 1e-4))
    return hl_check_refuse(&check, "screen/center",
                           "the light's rays run along the screen, not through it: turn or move the screen");
  return HL_OK;
}

/* Checks the emission image of a light. The light must have a surface that can carry the image. */
static hl_status check_emission(const hl_checker *parent, const hl_light *light) {
  const hl_light_emission *emission = &light->emission;
  hl_checker check = {parent->error, ""};
  hl_status status;
  if (emission->pixels == NULL) return HL_OK;
  snprintf(check.place, sizeof check.place, "%s/emission", parent->place);
  if ((status = hl_check_pixels(&check, emission->pixels, emission->width, emission->height)) != HL_OK)
    return status;
  if ((status = hl_check_direction(&check, "up", emission->up)) != HL_OK) return status;
  if (light->texture.pixels != NULL)
    return hl_check_refuse(
        parent, "emission",
        "is beside a texture: a light has an image of its own or projects one, use two lights");
  if (!hl_light_shape(light).has_surface)
    return hl_check_refuse(parent, "emission",
                           "is on a light without a surface: give it a radius, an angle or two edges");
  return HL_OK;
}

hl_status hl_light_check(const hl_light *light, size_t index, hl_error *error) {
  hl_checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "/lights/%zu", index);
  hl_status status = hl_check_key(&check, HL_SETTINGS_LIGHT, "type", light);
  if (status == HL_OK) status = hl_check_settings(&check, HL_SETTINGS_LIGHT, light, (int)light->type);
  if (status == HL_OK && hl_light_kind(light)->check != NULL)
    status = hl_light_kind(light)->check(&check, light);
  if (status == HL_OK) status = check_texture(&check, light);
  return status == HL_OK ? check_emission(&check, light) : status;
}
