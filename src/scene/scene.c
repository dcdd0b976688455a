/* scene/scene.c - sets defaults of descriptions, and makes scenes, which are checked deep copies of
 * descriptions.
 *
 * A scene owns every array and text of its copy and holds a reference to each volume.
 */
#include "scene/scene.h"

#include <string.h>

#include <halflight/compose.h>

#include "core/door.h"
#include "core/key.h"
#include "core/memory.h"
#include "scene/check/check.h"
#include "scene/function/function_plane.h"
#include "scene/geometry/placement.h"
#include "scene/light/light_kind.h"
#include "scene/marks.h"
#include "scene/settings.h"

void hl_light_defaults(hl_light *light) {
  if (light == NULL) return;
  *light = (hl_light){.emission = {.up = {0, 0, 1}}};
  hl_settings_defaults(HL_SETTINGS_LIGHT, light);
}

void hl_scene_volume_defaults(hl_scene_volume *volume) {
  if (volume == NULL) return;
  *volume = (hl_scene_volume){.component = HL_COMPONENT_DEFAULT,
                              .mask.component = HL_COMPONENT_DEFAULT,
                              .axis_scale = {1, 1, 1},
                              .time = HL_INDEX_DEFAULT,
                              .channel = HL_INDEX_DEFAULT,
                              .level = HL_INDEX_DEFAULT};
  hl_settings_defaults(HL_SETTINGS_VOLUME, volume);
  hl_settings_defaults(HL_SETTINGS_MATERIAL, &volume->material);
  hl_settings_defaults(HL_SETTINGS_TRANSFER_FUNCTION, &volume->transfer_function);
}

void hl_scene_floor_defaults(hl_scene_mesh *floor) {
  if (floor == NULL) return;
  hl_scene_mesh_defaults(floor);
  for (int c = 0; c < 3; c++) floor->color[c] = 0.5;
  floor->material.specular = 0;
  floor->cut = 0;
}

void hl_scene_mesh_defaults(hl_scene_mesh *mesh) {
  if (mesh == NULL) return;
  *mesh = (hl_scene_mesh){.mesh = NULL};
  hl_settings_defaults(HL_SETTINGS_MESH, mesh);
  hl_settings_defaults(HL_SETTINGS_MATERIAL, &mesh->material);
}

void hl_isosurface_defaults(hl_isosurface *surface) {
  if (surface == NULL) return;
  *surface = (hl_isosurface){.value = 0};
  hl_settings_defaults(HL_SETTINGS_ISO, surface);
}

void hl_cut_defaults(hl_cut *cut) {
  if (cut == NULL) return;
  *cut = (hl_cut){.type = HL_CUT_PLANE};
  hl_settings_defaults(HL_SETTINGS_CUT, cut);
}

void hl_scene_description_defaults(hl_scene_description *description) {
  if (description == NULL) return;
  *description = (hl_scene_description){.struct_size = sizeof(hl_scene_description)};
  hl_settings_defaults(HL_SETTINGS_SCENE, description);
  hl_settings_defaults(HL_SETTINGS_IMAGE, description);
  hl_settings_defaults(HL_SETTINGS_CAMERA, &description->camera);
  hl_settings_defaults(HL_SETTINGS_RENDER, &description->render);
  hl_settings_defaults(HL_SETTINGS_SKY, &description->sky);
}

static void release_volume(hl_context *context, hl_scene_volume *volume) {
  hl_release(context, (void *)volume->name);
  hl_release(context, (void *)volume->file);
  hl_release(context, (void *)volume->array);
  hl_release(context, (void *)volume->series);
  hl_release(context, (void *)volume->file_space);
  hl_release(context, (void *)volume->shapes);
  hl_transfer_function_release(context, &volume->transfer_function);
  hl_release(context, (void *)volume->iso);
  hl_release(context, (void *)volume->cuts);
  hl_volume_release(volume->volume);
  hl_release(context, (void *)volume->labels);
  hl_volume_release(volume->mask.volume);
  hl_release(context, (void *)volume->mask.file);
  hl_release(context, (void *)volume->mask.labels);
}

static void release_mesh(hl_context *context, hl_scene_mesh *mesh) {
  hl_release(context, (void *)mesh->name);
  hl_release(context, (void *)mesh->file);
  hl_mesh_release(mesh->mesh);
}

static void destroy(hl_scene *scene) {
  hl_context *context = scene->context;
  hl_scene_description *d = &scene->description;
  for (size_t v = 0; v < d->volume_count; v++) release_volume(context, (hl_scene_volume *)&d->volumes[v]);
  hl_release(context, (void *)d->volumes);
  for (size_t m = 0; m < d->mesh_count; m++) release_mesh(context, (hl_scene_mesh *)&d->meshes[m]);
  hl_release(context, (void *)d->meshes);
  hl_release(context, (void *)d->cuts);
  hl_marks_release(context, d->marks, d->mark_count);
  hl_drawn_scene_destroy(context, scene->drawn);
  hl_release(context, scene->field_errors);
  hl_placed_cuts_release(context, &scene->cut);
  hl_placed_lights_release(context, &scene->placed);
  hl_suns_release(context, &scene->suns);
  for (size_t l = 0; l < d->light_count; l++) {
    hl_release(context, (void *)d->lights[l].vertices);
    hl_light_images_release(context, (hl_light *)&d->lights[l]);
  }
  hl_release(context, (void *)d->lights);
  hl_release(context, (void *)d->sky.file);
  hl_release(context, (void *)d->sky.pixels);
  hl_release(context, (void *)d->description);
  hl_release(context, scene);
}

/* Copies an array into memory that the caller owns. The copy is null if `count` is 0. */
static hl_status copy_array(hl_context *context, const void *items, size_t count, size_t size,
                            const char *what, void **copy, hl_error *error) {
  *copy = NULL;
  if (count == 0) return HL_OK;
  *copy = hl_allocate(context, count, size);
  if (*copy == NULL) return hl_fail_memory(error, count * size, what);
  memcpy(*copy, items, count * size);
  return HL_OK;
}

static hl_status copy_text(hl_context *context, const char *text, const char **copy, hl_error *error) {
  if (text == NULL) return HL_OK;
  *copy = hl_copy_text(context, text);
  return *copy != NULL ? HL_OK : hl_fail_memory(error, strlen(text) + 1, "a name");
}

hl_status hl_transfer_function_copy(hl_context *context, const hl_transfer_function *from,
                                    hl_transfer_function *to, hl_error *error) {
  void *opacity = NULL, *color = NULL, *gradient = NULL;
  hl_status status = copy_array(context, from->opacity, from->opacity_count, sizeof *from->opacity,
                                "a transfer function", &opacity, error);
  if (status != HL_OK) return status;
  status = copy_array(context, from->color, from->color_count, sizeof *from->color, "a transfer function",
                      &color, error);
  if (status == HL_OK)
    status = copy_array(context, from->gradient_opacity, from->gradient_opacity_count,
                        sizeof *from->gradient_opacity, "gradient opacity", &gradient, error);
  *to = (hl_transfer_function){
      .unit_distance = from->unit_distance,
      .opacity = opacity,
      .opacity_count = from->opacity_count,
      .color = color,
      .color_count = from->color_count,
      .gradient_opacity = gradient,
      .gradient_opacity_count = from->gradient_opacity_count,
  };
  if (status == HL_OK) status = hl_plane_copy(context, &from->plane, &to->plane, error);
  if (status != HL_OK) hl_transfer_function_release(context, to);
  return status;
}

/* Copies a volume's transfer function. For a function of two numbers, opacity and colour become the
 * function's outline, which depends on the value alone. */
static hl_status copy_function(hl_context *context, const hl_transfer_function *from, const hl_volume *volume,
                               hl_transfer_function *to, hl_error *error) {
  hl_status status = hl_transfer_function_copy(context, from, to, error);
  if (status != HL_OK || !hl_has_plane(from)) return status;
  hl_release(context, (void *)to->opacity);
  hl_release(context, (void *)to->color);
  return hl_plane_outline(context, volume->minimum, volume->maximum, to, error);
}

/* Copies a volume. A pointer in *to is null until *to owns the memory behind the pointer, so that
 * release_volume() can be called after a failure. */
static hl_status copy_volume(hl_context *context, const hl_scene_volume *from, hl_scene_volume *to,
                             hl_error *error) {
  *to = *from;
  to->name = to->file = to->shapes = to->array = to->series = to->file_space = NULL;
  to->transfer_function = (hl_transfer_function){0};
  to->iso = NULL;
  to->cuts = NULL;
  to->labels = NULL;
  to->mask.file = NULL;
  to->mask.labels = NULL;
  hl_volume_retain(to->volume);
  hl_volume_retain(to->mask.volume);
  hl_status status = copy_text(context, from->name, &to->name, error);
  if (status == HL_OK) status = copy_text(context, from->file, &to->file, error);
  if (status == HL_OK) status = copy_text(context, from->shapes, &to->shapes, error);
  if (status == HL_OK) status = copy_text(context, from->array, &to->array, error);
  if (status == HL_OK) status = copy_text(context, from->series, &to->series, error);
  if (status == HL_OK) status = copy_text(context, from->file_space, &to->file_space, error);
  if (status == HL_OK) status = hl_labels_copy(context, from->labels, from->label_count, &to->labels, error);
  if (status == HL_OK) status = copy_text(context, from->mask.file, &to->mask.file, error);
  if (status == HL_OK)
    status = hl_labels_copy(context, from->mask.labels, from->mask.label_count, &to->mask.labels, error);
  void *iso = NULL, *cuts = NULL;
  if (status == HL_OK)
    status = copy_array(context, from->iso, from->iso_count, sizeof *from->iso, "isosurfaces", &iso, error);
  to->iso = iso;
  if (status == HL_OK)
    status = copy_array(context, from->cuts, from->cut_count, sizeof *from->cuts, "cuts", &cuts, error);
  to->cuts = cuts;
  if (status != HL_OK) return status;
  if (to->label_count > 0) return hl_labels_function(context, to, &to->transfer_function, error);
  return copy_function(context, &from->transfer_function, from->volume, &to->transfer_function, error);
}

static hl_status copy_volumes(hl_scene *scene, const hl_scene_description *from, hl_error *error) {
  hl_scene_volume *volumes = hl_allocate_zeroed(scene->context, from->volume_count, sizeof *volumes);
  if (volumes == NULL)
    return hl_fail_memory(error, from->volume_count * sizeof *volumes, "a scene's volumes");
  scene->description.volumes = volumes;
  for (size_t v = 0; v < from->volume_count; v++) {
    scene->description.volume_count = v + 1;
    hl_status status = copy_volume(scene->context, &from->volumes[v], &volumes[v], error);
    if (status != HL_OK) return status;
  }
  return HL_OK;
}

static hl_status copy_meshes(hl_scene *scene, const hl_scene_description *from, hl_error *error) {
  void *copy = NULL;
  hl_status status = copy_array(scene->context, from->meshes, from->mesh_count, sizeof *from->meshes,
                                "a scene's meshes", &copy, error);
  if (status != HL_OK) return status;
  hl_scene_mesh *meshes = copy;
  for (size_t m = 0; m < from->mesh_count; m++) {
    meshes[m].name = meshes[m].file = NULL;
    hl_mesh_retain(meshes[m].mesh);
  }
  scene->description.meshes = meshes;
  scene->description.mesh_count = from->mesh_count;
  for (size_t m = 0; m < from->mesh_count && status == HL_OK; m++) {
    status = copy_text(scene->context, from->meshes[m].name, &meshes[m].name, error);
    if (status == HL_OK) status = copy_text(scene->context, from->meshes[m].file, &meshes[m].file, error);
  }
  return status;
}

static hl_status copy_cuts(hl_scene *scene, const hl_scene_description *from, hl_error *error) {
  void *copy = NULL;
  hl_status status = copy_array(scene->context, from->cuts, from->cut_count, sizeof *from->cuts,
                                "a scene's cuts", &copy, error);
  scene->description.cuts = copy;
  return status;
}

static hl_status copy_marks(hl_scene *scene, const hl_scene_description *from, hl_error *error) {
  hl_mark *copy = NULL;
  hl_status status = hl_marks_copy(scene->context, from->marks, from->mark_count, &copy, error);
  scene->description.marks = copy;
  scene->description.mark_count = copy != NULL ? from->mark_count : 0;
  return status;
}

static void forget_images(hl_light *light) {
  light->texture.file = light->emission.file = NULL;
  light->texture.pixels = light->emission.pixels = NULL;
}

void hl_light_images_release(hl_context *context, hl_light *light) {
  hl_release(context, (void *)light->texture.file);
  hl_release(context, (void *)light->texture.pixels);
  hl_release(context, (void *)light->emission.file);
  hl_release(context, (void *)light->emission.pixels);
  forget_images(light);
}

/* The image of a light's texture or emission, or of a sky. */
typedef struct light_picture {
  const float *pixels; /* [height][width][3]; linear RGB; null if the object has no image */
  int width, height;
  const char *file; /* name of the image's file; null if the image has no file */
} light_picture;

static hl_status copy_picture(hl_context *context, light_picture from, const float **pixels,
                              const char **file, hl_error *error) {
  if (from.pixels == NULL) return HL_OK;
  void *copy = NULL;
  hl_status status = copy_array(context, from.pixels, (size_t)from.width * (size_t)from.height,
                                3 * sizeof(float), "a light's image", &copy, error);
  *pixels = copy;
  return status == HL_OK ? copy_text(context, from.file, file, error) : status;
}

/* Copies a light's images. A pointer in *to is null until *to owns the memory behind the pointer. */
static hl_status copy_images(hl_context *context, const hl_light *from, hl_light *to, hl_error *error) {
  const hl_light_texture *texture = &from->texture;
  const hl_light_emission *emission = &from->emission;
  hl_status status = copy_picture(
      context, (light_picture){texture->pixels, texture->width, texture->height, texture->file},
      &to->texture.pixels, &to->texture.file, error);
  if (status != HL_OK) return status;
  return copy_picture(context,
                      (light_picture){emission->pixels, emission->width, emission->height, emission->file},
                      &to->emission.pixels, &to->emission.file, error);
}

static hl_status copy_lights(hl_scene *scene, const hl_scene_description *from, hl_error *error) {
  void *copied = NULL;
  hl_status status = copy_array(scene->context, from->lights, from->light_count, sizeof *from->lights,
                                "a scene's lights", &copied, error);
  if (status != HL_OK) return status;
  hl_light *lights = copied;
  for (size_t l = 0; l < from->light_count; l++) {
    lights[l].vertices = NULL;
    if (!hl_light_kind(&lights[l])->outline) lights[l].vertex_count = 0;
    forget_images(&lights[l]);
  }
  scene->description.lights = lights;
  scene->description.light_count = from->light_count;
  for (size_t l = 0; l < from->light_count && status == HL_OK; l++) {
    void *vertices = NULL;
    status = copy_array(scene->context, from->lights[l].vertices, lights[l].vertex_count,
                        sizeof *from->lights[l].vertices, "a light's vertices", &vertices, error);
    lights[l].vertices = vertices;
    if (status == HL_OK) status = copy_images(scene->context, &from->lights[l], &lights[l], error);
  }
  return status;
}

/* Copies the image of a sky, if the sky is an image. */
static hl_status copy_sky(hl_scene *scene, const hl_sky *from, hl_error *error) {
  hl_sky *to = &scene->description.sky;
  to->file = NULL;
  to->pixels = NULL;
  if (from->type != HL_SKY_IMAGE) return HL_OK;
  return copy_picture(scene->context, (light_picture){from->pixels, from->width, from->height, from->file},
                      &to->pixels, &to->file, error);
}

/* Returns whether bright spots of the sky's image become lights of the scene (suns). Bright spots become suns
 * only if the scene has shadows, half-vector slicing and lit matter. */
static bool has_suns(const hl_scene_description *d) {
  return d->sky.suns && d->sky.strength > 0 && d->render.shadows != HL_SHADOWS_OFF &&
         d->render.slicing == HL_SLICING_HALF_VECTOR && d->render.compositing == HL_COMPOSITING_LIGHT;
}

/* Gives the camera another up vector if its own up vector lies along the line of sight. */
static void mend_up(hl_camera *camera) {
  vec3 right, up, forward;
  if (hl_camera_basis(camera, &right, &up, &forward)) return;
  camera->up[0] = up.x;
  camera->up[1] = up.y;
  camera->up[2] = up.z;
}

hl_status hl_scene_create(hl_context *context, const hl_scene_description *description, hl_scene **scene,
                          hl_error *error) {
  HL_DOOR;
  if (context == NULL || description == NULL || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_create: null context, description or scene");
  *scene = NULL;
  if (description->struct_size != sizeof *description)
    return hl_fail(error, HL_ERROR_ARGUMENT,
                   "hl_scene_create: struct_size is %zu, not %zu: call hl_scene_description_defaults() first",
                   description->struct_size, sizeof *description);
  hl_status status = hl_description_check(description, error);
  if (status != HL_OK) return status;
  hl_scene *made = hl_allocate_zeroed(context, 1, sizeof *made);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "a scene");
  made->context = context;
  atomic_init(&made->references, 1);
  made->description = *description;
  made->description.lights = NULL;
  made->description.volumes = NULL;
  made->description.meshes = NULL;
  made->description.mesh_count = 0;
  made->description.cuts = NULL;
  made->description.marks = NULL;
  made->description.mark_count = 0;
  made->description.description = NULL;
  made->description.sky.file = NULL;
  made->description.sky.pixels = NULL;
  made->description.light_count = made->description.volume_count = 0;
  mend_up(&made->description.camera);
  status = copy_text(context, description->description, &made->description.description, error);
  if (status == HL_OK) status = copy_lights(made, description, error);
  if (status == HL_OK) status = copy_volumes(made, description, error);
  if (status == HL_OK) status = copy_meshes(made, description, error);
  if (status == HL_OK) status = copy_cuts(made, description, error);
  if (status == HL_OK) status = copy_marks(made, description, error);
  if (status == HL_OK) status = copy_sky(made, &description->sky, error);
  const hl_sky *sky = &made->description.sky;
  if (status == HL_OK && sky->pixels != NULL)
    made->sky_mark = hl_key_mark(sky->pixels, 3 * (size_t)sky->width * (size_t)sky->height * sizeof(float));
  if (status == HL_OK && has_suns(&made->description))
    status = hl_suns_find(context, sky, &made->suns, error);
  if (status == HL_OK)
    status = hl_lights_place(context, &made->description, &made->suns, &made->placed, error);
  if (status == HL_OK) status = hl_cuts_place(context, &made->placed, &made->cut, error);
  if (status == HL_OK)
    status = hl_field_errors_write(context, &made->description, &made->field_errors, error);
  if (status == HL_OK) made->drawn = hl_drawn_scene_create(context);
  if (status == HL_OK && made->drawn == NULL) status = hl_fail_memory(error, sizeof *made->drawn, "a scene");
  if (status != HL_OK) {
    destroy(made);
    return status;
  }
  *scene = made;
  return HL_OK;
}

hl_status hl_scene_draw(const hl_scene *scene, const drawn_scene **drawn, hl_error *error) {
  *drawn = scene->drawn;
  return hl_drawn_scene_make(scene->context, &scene->description, &scene->placed, scene->drawn, error);
}

const hl_scene_description *hl_scene_describe(const hl_scene *scene) {
  return scene != NULL ? &scene->description : NULL;
}

void hl_scene_retain(hl_scene *scene) {
  if (scene != NULL) atomic_fetch_add(&scene->references, 1);
}

void hl_scene_release(hl_scene *scene) {
  if (scene != NULL && atomic_fetch_sub(&scene->references, 1) == 1) destroy(scene);
}
