/* render/framed_scene.c - converts a scene's lengths and positions from the world to frame space. */
#include "render/framed_scene.h"

#include <string.h>

#include "core/memory.h"

static void move_length(const hl_frame_space *space, double length[3]) {
  for (int a = 0; a < 3; a++) length[a] /= space->unit;
}

static void move_point(const hl_frame_space *space, double point[3]) {
  const double centre[3] = {space->centre.x, space->centre.y, space->centre.z};
  for (int a = 0; a < 3; a++) point[a] = (point[a] - centre[a]) / space->unit;
}

static void move_camera(const hl_frame_space *space, hl_camera *camera) {
  move_point(space, camera->position);
  move_point(space, camera->target);
  camera->height /= space->unit;
}

/* Derived: I / d^2 is (I / unit^2) / (d / unit)^2. */
static void move_light(const hl_frame_space *space, hl_light *light, double (*vertices)[3]) {
  move_point(space, light->position);
  light->radius /= space->unit;
  move_length(space, light->edge1);
  move_length(space, light->edge2);
  for (size_t v = 0; v < light->vertex_count; v++) {
    memcpy(vertices[v], light->vertices[v], sizeof vertices[v]);
    move_point(space, vertices[v]);
  }
  light->vertices = (const double(*)[3])vertices;
  move_point(space, light->texture.screen_center);
  move_length(space, light->texture.screen_right);
  move_length(space, light->texture.screen_up);
  if (light->falloff == HL_FALLOFF_INVERSE_SQUARE) light->intensity /= space->unit * space->unit;
}

/* Leaves the clip box alone: it is in the world of the volume's file, to which the transform is applied. */
static void move_volume(const hl_frame_space *space, hl_scene_volume *volume) {
  move_point(space, volume->translate);
  volume->scale /= space->unit;
  volume->transfer_function.unit_distance /= space->unit;
}

static hl_status copy_arrays(hl_context *context, const hl_scene_description *scene, framed_scene *framed,
                             hl_error *error) {
  size_t vertices = 0;
  for (size_t i = 0; i < scene->light_count; i++) vertices += scene->lights[i].vertex_count;
  framed->volumes = hl_allocate(context, scene->volume_count, sizeof *framed->volumes);
  framed->lights = hl_allocate(context, scene->light_count, sizeof *framed->lights);
  framed->vertices = hl_allocate(context, vertices, sizeof *framed->vertices);
  if (framed->volumes == NULL || framed->lights == NULL || framed->vertices == NULL)
    return hl_fail_memory(error, scene->volume_count * sizeof *framed->volumes, "the scene in frame space");
  memcpy(framed->volumes, scene->volumes, scene->volume_count * sizeof *framed->volumes);
  if (scene->light_count > 0)
    memcpy(framed->lights, scene->lights, scene->light_count * sizeof *framed->lights);
  framed->scene.volumes = framed->volumes;
  framed->scene.lights = framed->lights;
  return HL_OK;
}

hl_status hl_framed_scene_create(hl_context *context, const hl_scene_description *scene, framed_scene *framed,
                                 hl_error *error) {
  const hl_frame_space space = hl_scene_frame_space(scene);
  *framed = (framed_scene){.scene = *scene, .unit = space.unit};
  hl_status status = copy_arrays(context, scene, framed, error);
  if (status != HL_OK) return status;
  double(*vertices)[3] = framed->vertices;
  move_camera(&space, &framed->scene.camera);
  for (size_t i = 0; i < scene->volume_count; i++) move_volume(&space, &framed->volumes[i]);
  for (size_t i = 0; i < scene->light_count; vertices += scene->lights[i++].vertex_count)
    move_light(&space, &framed->lights[i], vertices);
  return HL_OK;
}

void hl_framed_scene_release(hl_context *context, framed_scene *framed) {
  hl_release(context, framed->volumes);
  hl_release(context, framed->lights);
  hl_release(context, framed->vertices);
}
