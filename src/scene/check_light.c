/* scene/check_light.c - checks a light by itself: its shape, its texture and its emission image. */
#include <math.h>
#include <stdio.h>

#include "core/vector.h"
#include "scene/check.h"
#include "scene/light_shape.h"

/* Fractions of the polygon's diameter: how far its vertices may leave its plane, and the least width. */
static const double FLAT = 1e-3, THIN = 1e-6;

static hl_status check_polygon(const hl_checker *check, const hl_light *light) {
  hl_status status = hl_check_count(check, "vertices", light->vertices, light->vertex_count,
                                    HL_LIMIT_VERTICES);
  if (status != HL_OK) return status;
  if (light->vertex_count < 3)
    return hl_fail(check->error, HL_ERROR_INPUT, "%s/vertices: has %zu entries: give three points or more",
                   check->place, light->vertex_count);
  for (size_t v = 0; v < light->vertex_count; v++) {
    char element[32];
    snprintf(element, sizeof element, "vertices/%zu", v);
    if ((status = hl_check_point(check, element, light->vertices[v])) != HL_OK) return status;
  }
  polygon_shape shape = hl_polygon_shape(light->vertices, light->vertex_count);
  if (!(shape.area > THIN * shape.diameter * shape.diameter))
    return hl_check_refuse(
        check, "vertices",
        "span no area: move one off the line, or use a rect light with an edge of no length");
  if (hl_polygon_unevenness(&shape, light->vertices, light->vertex_count) > FLAT * shape.diameter)
    return hl_check_refuse(check, "vertices", "do not lie in one plane: move them, or use several lights");
  if (hl_polygon_crosses_itself(&shape, light->vertices, light->vertex_count))
    return hl_check_refuse(check, "vertices",
                           "go around an outline that crosses itself: give them in order around it");
  return HL_OK;
}

/* Checks the light's shape as a whole; its settings are in their ranges already. */
static hl_status check_shape(const hl_checker *check, const hl_light *light) {
  if (light->type == HL_LIGHT_POLYGON) return check_polygon(check, light);
  if (light->type == HL_LIGHT_SPOT)
    return hl_check_range(
        check, "falloff_angle_deg", light->falloff_angle_deg, 0, light->opening_angle_deg / 2,
        "give the width of the cone's smooth edge in degrees, from 0 to half the opening angle");
  if (light->type == HL_LIGHT_DIRECTIONAL && light->falloff != HL_FALLOFF_NONE)
    return hl_check_refuse(
        check, "falloff",
        "inverse_square on a directional light, which is infinitely far: use none, or a point light");
  return HL_OK;
}

/* Checks the texture; the light's rays must cross its screen. */
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
  vec3 way = light->type == HL_LIGHT_DIRECTIONAL ? vec3_of(light->direction)
                                                 : vec3_subtract(center, hl_light_centre(light));
  if (!(fabs(vec3_dot(vec3_normalise(normal), vec3_normalise(way))) > 1e-4))
    return hl_check_refuse(&check, "screen/center",
                           "the light's rays run along the screen, not through it: turn or move the screen");
  return HL_OK;
}

/* Checks the emission image; the light must have a surface that it can be on. */
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
  bool flat = light->type == HL_LIGHT_DIRECTIONAL ? !(light->angular_diameter_deg > 0) : !(light->radius > 0);
  if (light->type == HL_LIGHT_POLYGON) flat = false;
  if (light->type == HL_LIGHT_RECT) {
    vec3 edge1 = vec3_of(light->edge1), edge2 = vec3_of(light->edge2);
    flat = !(vec3_length(vec3_cross(edge1, edge2)) > THIN * vec3_length(edge1) * vec3_length(edge2));
  }
  if (flat)
    return hl_check_refuse(parent, "emission",
                           "is on a light without a surface: give it a radius, an angle or two edges");
  return HL_OK;
}

hl_status hl_light_check(const hl_light *light, size_t index, hl_error *error) {
  hl_checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "/lights/%zu", index);
  hl_status status = hl_check_key(&check, HL_SETTINGS_LIGHT, "type", light);
  if (status == HL_OK) status = hl_check_settings(&check, HL_SETTINGS_LIGHT, light, (int)light->type);
  if (status == HL_OK) status = check_shape(&check, light);
  if (status == HL_OK) status = check_texture(&check, light);
  return status == HL_OK ? check_emission(&check, light) : status;
}
