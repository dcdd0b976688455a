/* json/scene.c - reads a scene file's top level, and loads the files that it names.
 *
 * The image's size, the volumes and the meshes are read before the camera, because by default the camera
 * frames them. Floors are made after the camera is known.
 */
#include <halflight/resolutions.h>
#include <string.h>

#include "core/door.h"
#include "core/file.h"
#include "core/memory.h"
#include "guess/for_volume.h"
#include "json/parts.h"
#include "json/settings.h"
#include "json/shapes.h"
#include "scene/check/check.h"
#include "scene/marks.h"
#include "scene/scene.h"
#include "scene/settings.h"

/* The memory that is allocated while a scene is read. It is released at the end, also after a failure. */
typedef struct gathered {
  hl_scene_description description;
  hl_light *lights;         /* owned; [light_count]; the scene's lights */
  hl_scene_volume *volumes; /* owned, with their transfer functions' points; [volume_count]; the scene's
                             * volumes */
  hl_volume_shelf shelf;
  hl_mesh_shelf meshes;
  hl_light key_light;
} gathered;

static void release(hl_context *context, gathered *g) {
  for (size_t v = 0; v < g->description.volume_count; v++) {
    hl_transfer_function_release(context, &g->volumes[v].transfer_function);
    hl_release(context, (void *)g->volumes[v].iso);
    hl_release(context, (void *)g->volumes[v].cuts);
    hl_labels_release(context, (hl_label *)g->volumes[v].labels);
    hl_labels_release(context, (hl_label *)g->volumes[v].mask.labels);
  }
  for (size_t v = 0; v < g->shelf.count; v++) {
    hl_volume_release(g->shelf.loaded[v].volume);
    hl_release(context, g->shelf.loaded[v].source);
  }
  hl_release(context, g->shelf.loaded);
  hl_release(context, (void *)g->description.cuts);
  hl_marks_release(context, g->description.marks, g->description.mark_count);
  hl_json_release_meshes(context, &g->meshes);
  hl_json_release_sky(context, &g->description.sky);
  json_decref(g->shelf.stood_in);
  hl_release(context, g->volumes);
  for (size_t l = 0; g->lights != NULL && l < g->description.light_count; l++) {
    hl_release(context, (void *)g->lights[l].vertices);
    hl_light_images_release(context, &g->lights[l]);
  }
  hl_release(context, g->lights);
}

/* Checks whether settings are in their ranges. This check comes early for the settings that are needed while
 * the rest of the scene is read. */
static hl_status check_settings(hl_json_reader *reader, hl_setting_kind kind, const void *object,
                                const char *place) {
  hl_status status = hl_settings_check(kind, object, 0, place, reader->error);
  if (status == HL_ERROR_INPUT) hl_json_prefix(reader, NULL);
  return status;
}

static hl_status read_image(hl_json_reader *reader, const json_t *root, hl_scene_description *d) {
  const json_t *value = json_object_get(root, "image");
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "image");
  hl_status status = hl_json_settings_object(reader, value, HL_SETTINGS_IMAGE, -1, NULL);
  if (status == HL_OK) status = hl_json_settings(reader, value, HL_SETTINGS_IMAGE, 0, d);
  if (status == HL_OK) status = check_settings(reader, HL_SETTINGS_IMAGE, d, "/image");
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static bool has(const json_t *object, const char *key) { return json_object_get(object, key) != NULL; }

/* Refuses a key of the scene that would have no effect. */
static hl_status refuse_key(hl_json_reader *reader, const json_t *object, const char *key, const char *mend) {
  return has(object, key) ? hl_json_fail(reader, HL_ERROR_INPUT, key, "%s", mend) : HL_OK;
}

/* Places a camera so that it frames the volumes. The camera's type and field of view must have been set. */
static hl_status frame(hl_json_reader *reader, const hl_scene_description *d, hl_camera *camera) {
  hl_status status = camera->type == HL_CAMERA_PERSPECTIVE
                         ? hl_settings_check_key(HL_SETTINGS_CAMERA, "fovy_deg", camera, "/camera",
                                                 reader->error)
                         : HL_OK;
  if (status != HL_OK) return hl_json_prefix(reader, NULL), status;
  status = hl_scene_frame(d, camera, reader->error);
  if (status == HL_OK || status == HL_ERROR_MEMORY || status == HL_ERROR_CANCELLED) return status;
  return hl_json_fail(reader, status, NULL, "the volumes cannot be framed: give a position and a target");
}

static hl_status read_camera_members(hl_json_reader *reader, const json_t *value, hl_scene_description *d) {
  static const char *const with_position[] = {"target", "up"};
  hl_camera *camera = &d->camera;
  hl_status status = hl_json_settings_object(reader, value, HL_SETTINGS_CAMERA, -1, NULL);
  if (status == HL_OK) status = hl_json_setting(reader, value, HL_SETTINGS_CAMERA, "type", camera);
  if (status == HL_OK && camera->type == HL_CAMERA_PERSPECTIVE)
    status = refuse_key(reader, value, "height",
                        "is for orthographic cameras: give fovy_deg, or \"type\": \"orthographic\"");
  if (status == HL_OK && camera->type == HL_CAMERA_ORTHOGRAPHIC)
    status = refuse_key(reader, value, "fovy_deg",
                        "is for perspective cameras: give height, or \"type\": \"perspective\"");
  if (status == HL_OK && !has(value, "position"))
    for (int k = 0; status == HL_OK && k < 2; k++)
      status = refuse_key(reader, value, with_position[k],
                          "needs a position: give both, or neither to frame the volumes");
  if (status == HL_OK) status = hl_json_setting(reader, value, HL_SETTINGS_CAMERA, "fovy_deg", camera);
  const char *size = camera->type == HL_CAMERA_PERSPECTIVE ? "fovy_deg" : "height";
  bool complete = has(value, "position") && has(value, "target") && has(value, "up") && has(value, size);
  if (status == HL_OK && !complete) status = frame(reader, d, camera);
  if (status == HL_OK && has(value, "position")) memcpy(camera->up, (double[3]){0, 0, 1}, sizeof camera->up);
  return status == HL_OK ? hl_json_settings(reader, value, HL_SETTINGS_CAMERA, (int)camera->type, camera)
                         : status;
}

/* Returns whether a scene says all of its camera, so that the camera does not depend on the volumes. */
static bool has_whole_camera(const json_t *root) {
  const json_t *value = json_object_get(root, "camera");
  const char *type = json_string_value(json_object_get(value, "type"));
  const char *size = type != NULL && strcmp(type, "orthographic") == 0 ? "height" : "fovy_deg";
  return has(value, "position") && has(value, "target") && has(value, "up") && has(value, size);
}

/* Reads the camera when the image's size and the volumes are known. value: the camera's JSON; null if the
 * scene has no camera. A camera without a position frames the volumes. */
static hl_status read_camera(hl_json_reader *reader, const json_t *value, hl_scene_description *d) {
  size_t mark = hl_json_enter(reader, "camera");
  hl_status status = value != NULL ? read_camera_members(reader, value, d) : frame(reader, d, &d->camera);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static hl_status read_volumes(hl_json_reader *reader, const json_t *root, gathered *g) {
  const json_t *value = json_object_get(root, "volumes");
  bool meshes = json_array_size(json_object_get(root, "meshes")) > 0;
  if (value == NULL && meshes) return HL_OK;
  if (value == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "volumes",
                        "is missing: name at least one volume, [ { \"file\": ... } ], or meshes");
  g->shelf.groups = json_object_get(root, "groups");
  g->shelf.threads = g->description.render.threads;
  g->shelf.projected = g->description.render.compositing == HL_COMPOSITING_MAXIMUM;
  size_t mark = hl_json_enter(reader, "volumes");
  hl_status status = hl_json_array(reader, value, meshes ? 0 : 1, HL_LIMIT_VOLUMES);
  if (status != HL_OK) return status;
  size_t count = json_array_size(value);
  size_t known = reader->like != NULL ? 2 * reader->like->volume_count : 0;
  g->volumes = hl_allocate_zeroed(reader->context, count, sizeof *g->volumes);
  g->shelf.loaded = hl_allocate_zeroed(reader->context, 2 * count + known, sizeof *g->shelf.loaded);
  if (g->volumes == NULL || g->shelf.loaded == NULL)
    return hl_fail_memory(reader->error, count * sizeof *g->volumes, "a scene's volumes");
  status = known > 0 ? hl_json_shelve_known(reader, &g->shelf) : HL_OK;
  if (status != HL_OK) return status;
  g->description.volumes = g->volumes;
  for (size_t v = 0; v < count; v++) {
    g->description.volume_count = v + 1;
    size_t inner = hl_json_enter_index(reader, v);
    status = hl_json_read_volume(reader, json_array_get(value, v), &g->shelf, &g->volumes[v]);
    if (status != HL_OK) return status;
    hl_json_leave(reader, inner);
  }
  hl_json_leave(reader, mark);
  return HL_OK;
}

static hl_status read_lights(hl_json_reader *reader, const json_t *root, gathered *g) {
  const json_t *value = json_object_get(root, "lights");
  if (value == NULL) {
    hl_scene_key_light(&g->key_light);
    g->description.lights = &g->key_light;
    g->description.light_count = 1;
    return HL_OK;
  }
  size_t mark = hl_json_enter(reader, "lights");
  hl_status status = hl_json_array(reader, value, 0, HL_LIMIT_LIGHTS);
  if (status != HL_OK) return status;
  size_t count = json_array_size(value);
  g->lights = hl_allocate_zeroed(reader->context, count, sizeof *g->lights);
  if (g->lights == NULL) return hl_fail_memory(reader->error, count * sizeof *g->lights, "a scene's lights");
  g->description.lights = g->lights;
  g->description.light_count = count;
  for (size_t l = 0; l < count; l++) {
    size_t inner = hl_json_enter_index(reader, l);
    status = hl_json_read_light(reader, json_array_get(value, l), &g->lights[l]);
    if (status != HL_OK) return status;
    hl_json_leave(reader, inner);
  }
  hl_json_leave(reader, mark);
  return HL_OK;
}

/* Checks the volumes before the camera is read, because the camera may have to frame them. */
static hl_status check_volumes(hl_json_reader *reader, const hl_scene_description *d) {
  for (size_t v = 0; v < d->volume_count; v++) {
    hl_status status = hl_scene_volume_check(&d->volumes[v], v, reader->error);
    if (status == HL_OK) continue;
    if (status == HL_ERROR_INPUT) hl_json_prefix(reader, NULL);
    return status;
  }
  return HL_OK;
}

static hl_status check_cuts(hl_json_reader *reader, const hl_scene_description *d) {
  const hl_checker root = {reader->error, ""};
  hl_status status = hl_cuts_check(&root, d->cuts, d->cut_count);
  if (status == HL_ERROR_INPUT) hl_json_prefix(reader, NULL);
  return status;
}

static hl_status read_version(hl_json_reader *reader, const json_t *root) {
  int version = 0;
  if (json_object_get(root, "halflight") == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "halflight",
                        "is missing: begin with \"halflight\": 1, the format's version");
  hl_status status = hl_json_integer(reader, root, "halflight", &version);
  if (status != HL_OK || version == 1) return status;
  return hl_json_fail(reader, version > 1 ? HL_ERROR_UNSUPPORTED : HL_ERROR_INPUT, "halflight",
                      "version %d is not known: this program reads version 1", version);
}

/* Refuses files of other kinds, which lack the version that a scene begins with. */
static hl_status refuse_other_kinds(hl_json_reader *reader, const json_t *root) {
  static const char *const kinds[][2] = {
      {"panels", "are those of a figure, and no scene: halflight figure FILE makes its page"},
      {"opacity", "is that of a transfer function, and no scene: give the file as --tf FILE beside a volume"},
      {"second", "is that of a transfer function, and no scene: give the file as --tf FILE beside a volume"}};
  if (json_object_get(root, "halflight") != NULL) return HL_OK;
  for (size_t n = 0; n < sizeof kinds / sizeof *kinds; n++)
    if (json_object_get(root, kinds[n][0]) != NULL)
      return hl_json_fail(reader, HL_ERROR_INPUT, kinds[n][0], "%s", kinds[n][1]);
  return HL_OK;
}

static hl_status read_scene(hl_json_reader *reader, const json_t *root, gathered *g) {
  static const char *const others[] = {"halflight", "description", "image",   "camera", "lights",
                                       "sky",       "groups",      "volumes", "meshes", "render",
                                       "cuts",      "marks",       "$schema", NULL};
  hl_scene_description *d = &g->description;
  const char *schema = NULL;
  hl_status status = refuse_other_kinds(reader, root);
  if (status == HL_OK) status = hl_json_settings_object(reader, root, HL_SETTINGS_SCENE, -1, others);
  if (status == HL_OK) status = read_version(reader, root);
  if (status == HL_OK) status = hl_json_text(reader, root, "$schema", &schema);
  if (status == HL_OK) status = hl_json_text(reader, root, "description", &d->description);
  if (status == HL_OK) status = read_image(reader, root, d);
  if (status == HL_OK) status = hl_json_settings(reader, root, HL_SETTINGS_SCENE, 0, d);
  if (status == HL_OK)
    status = hl_json_settings_member(reader, json_object_get(root, "render"), "render", HL_SETTINGS_RENDER,
                                     &d->render);
  if (status == HL_OK) status = hl_json_check_groups(reader, json_object_get(root, "groups"));
  if (!has_whole_camera(root)) reader->preview_pixels = 0;
  if (status == HL_OK) status = read_volumes(reader, root, g);
  if (status == HL_OK) status = check_volumes(reader, d);
  if (status == HL_OK)
    status = hl_json_read_cuts(reader, json_object_get(root, "cuts"), &d->cuts, &d->cut_count);
  if (status == HL_OK) status = check_cuts(reader, d);
  if (status == HL_OK)
    status = hl_json_read_marks(reader, json_object_get(root, "marks"), &d->marks, &d->mark_count);
  if (status == HL_OK) status = hl_json_read_meshes(reader, json_object_get(root, "meshes"), &g->meshes);
  d->meshes = g->meshes.meshes;
  d->mesh_count = g->meshes.count;
  if (status == HL_OK && d->volume_count + d->mesh_count == 0)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "meshes",
                          "have nothing but a floor: add a volume or a mesh that stands on it");
  if (status == HL_OK) status = read_camera(reader, json_object_get(root, "camera"), d);
  if (status == HL_OK) status = hl_json_add_floors(reader, d, &g->meshes);
  d->mesh_count = g->meshes.count;
  if (status == HL_OK) status = hl_json_read_sky(reader, json_object_get(root, "sky"), &d->sky);
  return status == HL_OK ? read_lights(reader, root, g) : status;
}

/* Reads a scene from its text. like, preview_pixels: as for the functions below. */
static hl_status from_json(hl_context *context, const char *text, size_t length, const char *base_folder,
                           const char *name, const hl_scene *like, int preview_pixels, hl_scene **scene,
                           hl_error *error) {
  if (context == NULL || text == NULL || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_from_json: null context, text or scene");
  *scene = NULL;
  hl_json_reader reader = {.context = context,
                           .name = name != NULL ? name : "scene",
                           .folder = base_folder,
                           .error = error,
                           .like = hl_scene_describe(like),
                           .preview_pixels = preview_pixels};
  json_t *root = NULL;
  hl_status status = hl_json_parse(text, length, reader.name, &root, error);
  if (status != HL_OK) return status;
  gathered g = {0};
  hl_scene_description_defaults(&g.description);
  status = read_scene(&reader, root, &g);
  if (status == HL_OK) {
    status = hl_scene_create(context, &g.description, scene, error);
    if (status == HL_ERROR_INPUT || status == HL_ERROR_UNSUPPORTED) hl_json_prefix(&reader, NULL);
  }
  release(context, &g);
  json_decref(root);
  return status;
}

hl_status hl_scene_from_json(hl_context *context, const char *text, size_t length, const char *base_folder,
                             const char *name, hl_scene **scene, hl_error *error) {
  HL_DOOR;
  return from_json(context, text, length, base_folder, name, NULL, 0, scene, error);
}

hl_status hl_scene_from_json_like(hl_context *context, const char *text, size_t length,
                                  const char *base_folder, const char *name, const hl_scene *like,
                                  hl_scene **scene, hl_error *error) {
  HL_DOOR;
  return from_json(context, text, length, base_folder, name, like, 0, scene, error);
}

hl_status hl_scene_from_json_coarse(hl_context *context, const char *text, size_t length,
                                    const char *base_folder, const char *name, int preview_pixels,
                                    hl_scene **scene, hl_error *error) {
  HL_DOOR;
  return from_json(context, text, length, base_folder, name, NULL, preview_pixels, scene, error);
}

static hl_status load(hl_context *context, const char *path, int preview_pixels, hl_scene **scene,
                      hl_error *error) {
  if (context == NULL || path == NULL || scene == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_load: null context, path or scene");
  *scene = NULL;
  unsigned char *bytes = NULL;
  size_t length = 0;
  hl_status status = hl_file_read(context, path, HL_JSON_LIMIT, &bytes, &length, error);
  if (status != HL_OK) return status;
  char *folder = hl_path_folder(context, path);
  if (folder != NULL)
    status = from_json(context, (const char *)bytes, length, folder, path, NULL, preview_pixels, scene,
                       error);
  else status = hl_fail_memory(error, strlen(path) + 1, "a path");
  hl_release(context, folder);
  hl_release(context, bytes);
  return status;
}

hl_status hl_scene_load(hl_context *context, const char *path, hl_scene **scene, hl_error *error) {
  HL_DOOR;
  return load(context, path, 0, scene, error);
}

hl_status hl_scene_load_coarse(hl_context *context, const char *path, int preview_pixels, hl_scene **scene,
                               hl_error *error) {
  HL_DOOR;
  return load(context, path, preview_pixels, scene, error);
}
