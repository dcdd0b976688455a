/* scene/light_frame.c - lights that are fixed to the camera, placed in the world.
 *
 * In: a description whose lights may be in camera axes (right, up, towards the viewer; origin at the target).
 * Out: the same with every light in the world, which is what is rendered. */
#include "scene/light_frame.h"

#include <string.h>

#include "core/memory.h"

typedef struct camera_axes {
  vec3 right, up, towards, origin;
} camera_axes;

static camera_axes axes_of(const hl_camera *camera) {
  camera_axes axes = {.origin = vec3_of(camera->target)};
  vec3 forward;
  hl_camera_basis(camera, &axes.right, &axes.up, &forward);
  axes.towards = vec3_scale(forward, -1);
  return axes;
}

static void turn(const camera_axes *axes, double v[3]) {
  vec3 world = vec3_add(vec3_add(vec3_scale(axes->right, v[0]), vec3_scale(axes->up, v[1])),
                        vec3_scale(axes->towards, v[2]));
  v[0] = world.x, v[1] = world.y, v[2] = world.z;
}

static void place(const camera_axes *axes, double point[3]) {
  turn(axes, point);
  point[0] += axes->origin.x, point[1] += axes->origin.y, point[2] += axes->origin.z;
}

vec3 hl_light_way(const hl_camera *camera, const hl_light *light) {
  double way[3];
  memcpy(way, light->direction, sizeof way);
  camera_axes axes = axes_of(camera);
  if (light->frame == HL_LIGHT_FRAME_CAMERA) turn(&axes, way);
  return vec3_of(way);
}

static void place_light(const camera_axes *axes, hl_light *light, double (*vertices)[3]) {
  turn(axes, light->direction);
  turn(axes, light->normal);
  turn(axes, light->edge1);
  turn(axes, light->edge2);
  place(axes, light->position);
  for (size_t v = 0; v < light->vertex_count; v++) place(axes, vertices[v]);
  place(axes, light->texture.screen_center);
  turn(axes, light->texture.screen_right);
  turn(axes, light->texture.screen_up);
  turn(axes, light->emission.up);
  light->frame = HL_LIGHT_FRAME_WORLD;
}

hl_status hl_lights_place(hl_context *context, const hl_scene_description *from, hl_scene_description *to,
                          hl_error *error) {
  *to = *from;
  to->light_count = 0;
  to->lights = hl_allocate_zeroed(context, from->light_count, sizeof *to->lights);
  if (to->lights == NULL)
    return hl_fail_memory(error, from->light_count * sizeof *to->lights, "a scene's lights");
  camera_axes axes = axes_of(&from->camera);
  for (; to->light_count < from->light_count; to->light_count++) {
    const hl_light *given = &from->lights[to->light_count];
    hl_light *light = (hl_light *)&to->lights[to->light_count];
    double(*vertices)[3] = hl_allocate(context, given->vertex_count, sizeof *vertices);
    if (vertices == NULL)
      return hl_fail_memory(error, given->vertex_count * sizeof *vertices, "a light's vertices");
    if (given->vertex_count > 0) memcpy(vertices, given->vertices, given->vertex_count * sizeof *vertices);
    *light = *given;
    light->vertices = (const double(*)[3])vertices;
    if (light->frame == HL_LIGHT_FRAME_CAMERA) place_light(&axes, light, vertices);
  }
  return HL_OK;
}

void hl_placed_lights_release(hl_context *context, hl_scene_description *placed) {
  for (size_t l = 0; l < placed->light_count; l++) hl_release(context, (void *)placed->lights[l].vertices);
  hl_release(context, (void *)placed->lights);
}
