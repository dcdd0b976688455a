/* scene/check/check.c - checks whether a description of a scene is possible.
 *
 * In: a description that was not checked yet. Out: HL_OK, or the first fault as one line: the JSON pointer of
 * the field, the bad value, and how to mend it. hl_scene_create() checks a description before it copies
 * anything. So renderers never get a NaN, a zero direction or an unknown enumerator. */
#include "scene/check/check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/vector.h"
#include "scene/geometry/placement.h"
#include "scene/light/light_kind.h"
#include "scene/light/sky.h"
#include "scene/marks.h"
#include "volume/in_bricks.h"

static hl_status check_camera(const hl_camera *camera, hl_error *error) {
  hl_checker check = {error, "/camera"};
  hl_status status = hl_check_key(&check, HL_SETTINGS_CAMERA, "type", camera);
  for (const char *const *key = (const char *const[]){"position", "target", "up", NULL};
       *key != NULL && status == HL_OK; key++)
    status = hl_check_key(&check, HL_SETTINGS_CAMERA, *key, camera);
  if (status != HL_OK) return status;
  vec3 position = vec3_of(camera->position), target = vec3_of(camera->target);
  double distance = vec3_length(vec3_subtract(target, position));
  double size = fmax(vec3_length(position), vec3_length(target));
  if (!(distance > 1e-12 * size) || distance < 1e-100)
    return hl_check_refuse(
        &check, "target",
        "is where the eye is: move the target or the position, so that there is a line of sight");
  return hl_check_settings(&check, HL_SETTINGS_CAMERA, camera, (int)camera->type);
}

/* ---- checks of several parts together: distances beside voxels, brightness ---- */

/* Checks that a light is not too bright at a distance as short as a voxel. Derived: a light that falls with
 * the square of the distance has the brightness intensity / d^2 at the distance d. */
static hl_status check_brightness(const hl_checker *check, const hl_light *light,
                                  const hl_frame_space *space) {
  double brightness = fmax(fmax(light->color[0], light->color[1]), light->color[2]) * light->intensity;
  if (light->falloff == HL_FALLOFF_INVERSE_SQUARE) brightness /= space->unit * space->unit;
  if (brightness <= HL_LIMIT_BRIGHTNESS) return HL_OK;
  return hl_fail(check->error, HL_ERROR_INPUT,
                 "%s/intensity: makes the light's color %.3g%s: use an intensity with which it is "
                 "at most 1e20",
                 check->place, brightness,
                 light->falloff == HL_FALLOFF_INVERSE_SQUARE ? " at the distance of a voxel's edge" : "");
}

/* Checks the places and lengths of one light. Positions in the camera's axes are relative to the camera's
 * target, which is checked separately. */
static hl_status check_light_reach(const hl_light *light, size_t index, const hl_frame_space *world,
                                   hl_error *error) {
  const hl_frame_space beside = {{0, 0, 0}, world->unit},
                       *space = light->frame == HL_LIGHT_FRAME_CAMERA ? &beside : world;
  hl_checker check = {error, ""};
  snprintf(check.place, sizeof check.place, "/lights/%zu", index);
  hl_status status = check_brightness(&check, light, space);
  if (status == HL_OK) status = hl_light_kind(light)->check_reach(&check, light, space);
  if (status != HL_OK || light->texture.pixels == NULL) return status;
  status = hl_check_distance(&check, "texture/screen/center", light->texture.screen_center, space);
  if (status == HL_OK)
    status = hl_check_reach(&check, "texture/screen/right", vec3_length(vec3_of(light->texture.screen_right)),
                            space);
  if (status == HL_OK)
    status = hl_check_reach(&check, "texture/screen/up", vec3_length(vec3_of(light->texture.screen_up)),
                            space);
  return status;
}

static hl_status check_scales(const hl_scene_description *d, hl_error *error) {
  const hl_frame_space space = hl_scene_frame_space(d);
  hl_checker camera = {error, "/camera"};
  hl_status status = hl_check_distance(&camera, "position", d->camera.position, &space);
  for (size_t l = 0; status == HL_OK && l < d->light_count; l++)
    if (d->lights[l].frame == HL_LIGHT_FRAME_CAMERA)
      status = hl_check_distance(&camera, "target", d->camera.target, &space);
  if (status == HL_OK && d->camera.type == HL_CAMERA_ORTHOGRAPHIC)
    status = hl_check_reach(&camera, "height", d->camera.height, &space);
  for (size_t l = 0; status == HL_OK && l < d->light_count; l++)
    status = check_light_reach(&d->lights[l], l, &space, error);
  return status;
}

/* Checks that a scene can use a volume's transfer function of two numbers: the picture is no maximum
 * projection, and the other volume exists and is not drawn by its labels. */
static hl_status check_second(const hl_scene_description *d, size_t v, hl_error *error) {
  const hl_function_plane *plane = &d->volumes[v].transfer_function.plane;
  if (plane->second == HL_SECOND_NONE || d->volumes[v].label_count > 0) return HL_OK;
  if (d->render.compositing == HL_COMPOSITING_MAXIMUM)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "/volumes/%zu/transfer_function/second: maximum projections go by one number: remove it, "
                   "or render with light",
                   v);
  if (plane->second != HL_SECOND_VOLUME) return HL_OK;
  const hl_scene_volume *other = hl_scene_volume_named(d, plane->volume);
  if (other == NULL)
    return hl_fail(error, HL_ERROR_INPUT,
                   "/volumes/%zu/transfer_function/second/volume: no volume is called \"%.80s\": give a "
                   "volume of the scene this name",
                   v, plane->volume);
  if (other->label_count > 0)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "/volumes/%zu/transfer_function/second/volume: \"%.80s\" is drawn by its labels, and has "
                   "no values: name a volume without labels, or use it as a mask",
                   v, plane->volume);
  return HL_OK;
}

/* Checks that the scene can use a field in bricks: the scene must not splat the field, and if the field has
 * several levels, the scene's kernel must be "bspline" or "interpolating". */
static hl_status check_bricks(const hl_scene_description *d, size_t v, hl_error *error) {
  const hl_kernel kernel = d->render.kernel;
  if (d->volumes[v].volume->bricks == NULL) return HL_OK;
  if (hl_volume_has_levels(d->volumes[v].volume) && kernel != HL_KERNEL_BSPLINE &&
      kernel != HL_KERNEL_INTERPOLATING)
    return hl_fail(error, HL_ERROR_UNSUPPORTED,
                   "/render/kernel: volume %zu is a field at levels, made of B-splines: use \"bspline\" or "
                   "\"interpolating\", which are the same there, or save it as voxels",
                   v);
  if (d->render.reconstruction == HL_RECONSTRUCTION_SPLAT)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "/render/reconstruction: volume %zu is a field in bricks, which has no voxels to splat: use "
        "\"gather\"",
        v);
  return HL_OK;
}

hl_status hl_description_check(const hl_scene_description *d, hl_error *error) {
  hl_checker root = {error, ""};
  hl_status status = hl_settings_check(HL_SETTINGS_IMAGE, d, 0, "/image", error);
  if (status == HL_OK) status = check_camera(&d->camera, error);
  if (status == HL_OK) status = hl_check_settings(&root, HL_SETTINGS_SCENE, d, 0);
  if (status == HL_OK) status = hl_sky_check(&d->sky, error);
  if (status == HL_OK) status = hl_check_count(&root, "lights", d->lights, d->light_count, HL_LIMIT_LIGHTS);
  if (status == HL_OK)
    status = hl_check_count(&root, "volumes", d->volumes, d->volume_count, HL_LIMIT_VOLUMES);
  if (status == HL_OK) status = hl_check_count(&root, "meshes", d->meshes, d->mesh_count, HL_LIMIT_MESHES);
  if (status == HL_OK) status = hl_cuts_check(&root, d->cuts, d->cut_count);
  if (status == HL_OK) status = hl_marks_check(d->marks, d->mark_count, error);
  if (status != HL_OK) return status;
  if (d->volume_count + d->mesh_count == 0)
    return hl_check_refuse(&root, "volumes", "is empty: name at least one volume or mesh");
  for (size_t l = 0; l < d->light_count && status == HL_OK; l++)
    status = hl_light_check(&d->lights[l], l, error);
  for (size_t v = 0; v < d->volume_count && status == HL_OK; v++)
    status = hl_scene_volume_check(&d->volumes[v], v, error);
  for (size_t m = 0; m < d->mesh_count && status == HL_OK; m++)
    status = hl_scene_mesh_check(&d->meshes[m], m, error);
  if (status == HL_OK) status = check_scales(d, error);
  if (status == HL_OK && d->mesh_count > 0 && d->render.compositing == HL_COMPOSITING_MAXIMUM)
    status = hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "/meshes: are not in maximum projections: remove them, or render with light");
  for (size_t v = 0; v < d->volume_count && status == HL_OK; v++)
    if (d->volumes[v].iso_count > 0 && d->render.compositing == HL_COMPOSITING_MAXIMUM)
      status = hl_fail(error, HL_ERROR_UNSUPPORTED,
                       "/volumes/%zu/iso: is not in maximum projections: remove it, or render with light", v);
  for (size_t v = 0; v < d->volume_count && status == HL_OK; v++) status = check_second(d, v, error);
  for (size_t v = 0; v < d->volume_count && status == HL_OK; v++) status = check_bricks(d, v, error);
  return status == HL_OK ? hl_settings_check(HL_SETTINGS_RENDER, &d->render, 0, "/render", error) : status;
}

hl_status hl_layers_check(const hl_layers *layers, const hl_scene_description *scene, hl_error *error) {
  size_t light_count = scene->light_count;
  if (layers == NULL) return HL_OK;
  if (scene->render.compositing == HL_COMPOSITING_MAXIMUM)
    return hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "/render/compositing: a maximum projection has no layers: use \"light\", or ask for no layers");
  if (layers->struct_size != sizeof *layers)
    return hl_fail(error, HL_ERROR_ARGUMENT, "layers->struct_size is %zu, expected %zu", layers->struct_size,
                   sizeof *layers);
  if (layers->light_count != 0 && layers->light_count != light_count)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "layers->light_count is %zu: the scene has %zu lights: give buffers for all "
                   "of them, null where none is wanted, or 0",
                   layers->light_count, light_count);
  if (layers->light_count != 0 && layers->lights == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "layers->lights is null, and light_count is %zu",
                   layers->light_count);
  return HL_OK;
}
