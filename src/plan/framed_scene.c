/* plan/framed_scene.c - see framed_scene.h. */
#include "plan/framed_scene.h"

#include <string.h>

#include "core/memory.h"
#include "scene/function/function_plane.h"
#include "scene/scene.h"

/* ---- the scene's lengths and positions, from the world's to the frame's ---- */

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

/* Moves a light to frame space. Derived: if light falls off with the square of the distance d, I / d^2 is (I
 * / unit^2) / (d / unit)^2. So the intensity I is divided by unit^2. */
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

/* Moves a volume to frame space, except for its clip box. The clip box stays in the world of the volume's
 * file, to which the volume's transform is applied. */
static void move_volume(const hl_frame_space *space, hl_scene_volume *volume) {
  move_point(space, volume->translate);
  volume->scale /= space->unit;
  hl_transfer_function *function = &volume->transfer_function;
  function->unit_distance /= space->unit;
  if (function->plane.second == HL_SECOND_GRADIENT)
    function->plane.second_scale = hl_plane_second_scale(&function->plane) / space->unit;
}

/* Converts gradient opacity to frame space: gradients are values per unit of length. points: room for all
 * points of the function; receives the new points. */
static void move_gradients(const hl_frame_space *space, hl_transfer_function *function,
                           hl_opacity_point *points) {
  if (function->gradient_opacity_count == 0) return;
  for (size_t p = 0; p < function->gradient_opacity_count; p++) {
    points[p] = function->gradient_opacity[p];
    points[p].value *= space->unit;
  }
  function->gradient_opacity = points;
}

static void move_cut(const hl_frame_space *space, hl_cut *cut) {
  move_point(space, cut->point);
  move_point(space, cut->min);
  move_point(space, cut->max);
  move_point(space, cut->center);
  cut->radius /= space->unit;
}

/* Converts cuts whose lengths are in the world to frame space. cuts: room for all cuts of the volume;
 * receives the converted cuts. */
static void move_cuts(const hl_frame_space *space, hl_scene_volume *volume, hl_cut *cuts) {
  if (volume->cut_count == 0) return;
  memcpy(cuts, volume->cuts, volume->cut_count * sizeof *cuts);
  for (size_t i = 0; i < volume->cut_count; i++)
    if (cuts[i].world) move_cut(space, &cuts[i]);
  volume->cuts = cuts;
}

static hl_status copy_arrays(hl_context *context, const hl_scene_description *scene, framed_scene *framed,
                             hl_error *error) {
  size_t vertices = 0, meshes = scene->mesh_count, gradients = 0, cuts = scene->cut_count;
  for (size_t i = 0; i < scene->light_count; i++) vertices += scene->lights[i].vertex_count;
  for (size_t i = 0; i < scene->volume_count; i++) {
    meshes += scene->volumes[i].iso_count;
    gradients += scene->volumes[i].transfer_function.gradient_opacity_count;
    cuts += scene->volumes[i].cut_count;
  }
  framed->volumes = hl_allocate(context, scene->volume_count, sizeof *framed->volumes);
  framed->lights = hl_allocate(context, scene->light_count, sizeof *framed->lights);
  framed->meshes = hl_allocate(context, meshes, sizeof *framed->meshes);
  framed->mesh_objects = hl_allocate(context, meshes, sizeof *framed->mesh_objects);
  framed->vertices = hl_allocate(context, vertices, sizeof *framed->vertices);
  framed->gradients = hl_allocate(context, gradients, sizeof *framed->gradients);
  framed->cuts = hl_allocate(context, cuts, sizeof *framed->cuts);
  framed->sun_parts = hl_allocate_zeroed(context, scene->light_count, sizeof *framed->sun_parts);
  framed->plane_marks = hl_allocate(context, scene->volume_count, sizeof *framed->plane_marks);
  if (framed->cuts == NULL || framed->volumes == NULL || framed->lights == NULL || framed->meshes == NULL ||
      framed->mesh_objects == NULL || framed->vertices == NULL || framed->gradients == NULL ||
      framed->sun_parts == NULL || framed->plane_marks == NULL)
    return hl_fail_memory(error, scene->volume_count * sizeof *framed->volumes, "the scene in frame space");
  const scene_order *order = framed->order;
  for (size_t i = 0; i < scene->volume_count; i++) framed->volumes[i] = scene->volumes[order->volumes[i]];
  for (size_t i = 0; i < scene->light_count; i++) framed->lights[i] = scene->lights[order->lights[i]];
  for (size_t i = 0; i < scene->mesh_count; i++) framed->meshes[i] = scene->meshes[order->meshes[i]];
  framed->scene.volumes = framed->volumes;
  framed->scene.meshes = framed->meshes;
  framed->scene.lights = framed->lights;
  framed->scene.cuts = framed->cuts;
  return HL_OK;
}

/* Copies the scene's findings about its lights and volumes (sun parts and plane marks), in the order that
 * frames use. In the scene, suns are the last lights. */
static void copy_findings(const hl_scene *scene, const drawn_scene *drawn, framed_scene *framed) {
  const hl_scene_description *d = &drawn->description;
  const scene_order *order = &drawn->order;
  const int first_sun = (int)d->light_count - scene->suns.count;
  for (size_t i = 0; i < d->light_count; i++)
    if (order->lights[i] >= first_sun)
      framed->sun_parts[i] = hl_sun_part_of_media(&scene->suns.suns[order->lights[i] - first_sun]);
  for (size_t i = 0; i < d->volume_count; i++) framed->plane_marks[i] = drawn->plane_marks[order->volumes[i]];
}

hl_status hl_framed_scene_create(hl_context *context, const hl_scene *from, framed_scene *framed,
                                 hl_error *error) {
  const drawn_scene *drawn;
  *framed = (framed_scene){.order = NULL};
  hl_status status = hl_scene_draw(from, &drawn, error);
  if (status != HL_OK) return status;
  const hl_scene_description *scene = &drawn->description;
  const scene_order *order = &drawn->order;
  const hl_frame_space space = hl_scene_frame_space(scene);
  *framed = (framed_scene){.scene = *scene, .order = order, .unit = space.unit};
  status = copy_arrays(context, scene, framed, error);
  if (status != HL_OK) return status;
  copy_findings(from, drawn, framed);
  double(*vertices)[3] = framed->vertices;
  hl_opacity_point *gradients = framed->gradients;
  hl_cut *cuts = framed->cuts;
  for (size_t i = 0; i < scene->cut_count; i++) {
    *cuts = scene->cuts[i];
    move_cut(&space, cuts++);
  }
  move_camera(&space, &framed->scene.camera);
  for (size_t i = 0; i < scene->volume_count; i++) {
    hl_scene_volume *volume = &framed->volumes[i];
    move_volume(&space, volume);
    move_gradients(&space, &volume->transfer_function, gradients);
    gradients += volume->transfer_function.gradient_opacity_count;
    move_cuts(&space, volume, cuts);
    cuts += volume->cut_count;
  }
  for (size_t i = 0; i < scene->mesh_count; i++) {
    move_point(&space, framed->meshes[i].translate);
    framed->meshes[i].scale /= space.unit;
    framed->mesh_objects[i] = (int)scene->volume_count + order->meshes[i] + 1;
  }
  for (size_t i = 0; i < scene->light_count; vertices += framed->lights[i++].vertex_count)
    move_light(&space, &framed->lights[i], vertices);
  return HL_OK;
}

void hl_framed_scene_release(hl_context *context, framed_scene *framed) {
  hl_release(context, framed->volumes);
  hl_release(context, framed->lights);
  hl_release(context, framed->meshes);
  hl_release(context, framed->mesh_objects);
  hl_release(context, framed->vertices);
  hl_release(context, framed->gradients);
  hl_release(context, framed->cuts);
  hl_release(context, framed->sun_parts);
  hl_release(context, framed->plane_marks);
}
