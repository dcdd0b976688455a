/* film/film.c - makes the scenes of a film's frames.
 *
 * The scene's text is parsed once. For each frame, the keys' values are written into a copy of the parsed
 * text. The library reads and checks this copy like any other scene. The camera of the read scene is then
 * turned. */
#define _GNU_SOURCE
#include "film.h"
#include "elementary/elementary.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jansson.h>

#include "keys.h"
#include "text/plain_json.h"

enum turn { TURN_AZIMUTH, TURN_ELEVATION, TURN_ROLL, TURN_ZOOM, TURN_COUNT };
static const char *const turn_paths[TURN_COUNT] = {"camera.azimuth", "camera.elevation", "camera.roll",
                                                   "camera.zoom"};

struct film {
  hl_context *context;
  const hl_scene *scene; /* the scene of the film; borrowed */
  json_t *text;          /* owned; the parsed text of the scene's file */
  film_key *keys;        /* owned; [key_count]; the numbers that change */
  size_t key_count;
  int turntable, frames;
};

static hl_status no_memory(hl_error *error) {
  snprintf(error->message, sizeof error->message, "out of memory for the film");
  return HL_ERROR_MEMORY;
}

/* The index of the camera's turn that a path names, or -1 if the path names a number of the scene. */
static int turn_of(const char *path) {
  for (int t = 0; t < TURN_COUNT; t++)
    if (strcmp(path, turn_paths[t]) == 0) return t;
  return -1;
}

/* Finds the light whose angle a path names, as "lights.N.azimuth" or "lights.N.elevation". Returns false if
 * the path names no such angle. */
static bool is_light_turn(const char *path, size_t *light, bool *azimuth) {
  int used = 0;
  unsigned number;
  if (sscanf(path, "lights.%4u.%n", &number, &used) != 1 || used == 0) return false;
  *light = number;
  *azimuth = strcmp(path + used, "azimuth") == 0;
  return *azimuth || strcmp(path + used, "elevation") == 0;
}

static bool is_turn(const char *path) {
  size_t light;
  bool azimuth;
  return turn_of(path) >= 0 || is_light_turn(path, &light, &azimuth);
}

/* ---- numbers in the scene's text ---- */

/* The member of an object, or the element of an array, that has a given name; null if there is none. */
static json_t *step_into(json_t *at, const char *name) {
  if (json_is_object(at)) return json_object_get(at, name);
  size_t digits = strspn(name, "0123456789");
  if (!json_is_array(at) || digits == 0 || digits > 9 || name[digits] != '\0') return NULL;
  return json_array_get(at, strtoul(name, NULL, 10));
}

/* Finds the table of the settings of an object in a scene, by the object's name, which need not end at
 * `letters`. Returns false if there is no such table. */
static bool find_table(const char *name, size_t letters, hl_setting_kind *kind) {
  static const struct {
    const char *name;
    hl_setting_kind kind;
  } tables[] = {{"image", HL_SETTINGS_IMAGE},       {"camera", HL_SETTINGS_CAMERA},
                {"lights", HL_SETTINGS_LIGHT},      {"volumes", HL_SETTINGS_VOLUME},
                {"material", HL_SETTINGS_MATERIAL}, {"transfer_function", HL_SETTINGS_TRANSFER_FUNCTION},
                {"render", HL_SETTINGS_RENDER},     {"meshes", HL_SETTINGS_MESH},
                {"sky", HL_SETTINGS_SKY},           {"iso", HL_SETTINGS_ISO},
                {"cuts", HL_SETTINGS_CUT}};
  for (size_t t = 0; t < sizeof tables / sizeof *tables; t++)
    if (strlen(tables[t].name) == letters && strncmp(tables[t].name, name, letters) == 0) {
      *kind = tables[t].kind;
      return true;
    }
  return false;
}

/* Finds the setting that the first `length` bytes of a path name. In "volumes.0.scattering.albedo.0" the
 * setting is the row with the key "scattering/albedo" in the table of volumes. Returns null if the bytes
 * name no setting. */
static const hl_setting *setting_of(const char *path, size_t length) {
  hl_setting_kind kind = HL_SETTINGS_SCENE;
  char key[128] = "";
  for (size_t at = 0; at < length; at++) { /* steps over the dot */
    const char *name = path + at;
    size_t letters = strcspn(name, "."), used = strlen(key);
    if (letters > length - at) letters = length - at;
    at += letters;
    if (find_table(name, letters, &kind)) key[0] = '\0';
    else if (strspn(name, "0123456789") < letters) {
      if (used + letters + 2 > sizeof key) return NULL;
      snprintf(key + used, sizeof key - used, "%s%.*s", used > 0 ? "/" : "", (int)letters, name);
    }
  }
  return hl_setting_find(kind, key);
}

static bool has_type(const hl_setting *setting, hl_setting_type type) {
  return setting != NULL && setting->type == type;
}

/* Returns whether a scene takes only whole numbers at a key's path, whose last part is `name`. The number
 * in the scene's text cannot answer this question, because the text may have 7 for a size of 7.0 degrees. */
static bool is_whole(const film_key *key, const char *name) {
  /* The names that are no settings: parts of a volume's file, and numbers of shapes. */
  static const char *const others[] = {"component", "time", "channel", "level", "octaves",
                                       "seed",      "n",    "l",       "m"};
  for (size_t o = 0; o < sizeof others / sizeof *others; o++)
    if (strcmp(name, others[o]) == 0) return true;
  return has_type(setting_of(key->path, strlen(key->path)), HL_SETTING_WHOLE);
}

/* Makes the value of a key at a frame as JSON: a number, which is rounded where only whole numbers are taken,
 * or three numbers. name: the last part of the key's path. */
static json_t *value_at(const film_key *key, int frame, const char *name) {
  double value[3];
  film_key_value(key, frame, value);
  if (key->components == 3) return json_pack("[f, f, f]", value[0], value[1], value[2]);
  return is_whole(key, name) ? json_integer(llround(value[0])) : json_real(value[0]);
}

/* Returns whether a setting is a colour. If `color` is false, returns whether a setting is a colour, a point
 * or a direction. */
static bool has_three(const hl_setting *setting, bool color) {
  return has_type(setting, HL_SETTING_COLOR) ||
         (!color && (has_type(setting, HL_SETTING_POINT) || has_type(setting, HL_SETTING_DIRECTION)));
}

/* Makes a part that the scene leaves out, with its defaults: three numbers, or an object without keys. The
 * part is named by the first `length` bytes of the path. Returns null if the path names no setting, or if the
 * part is a list. */
static json_t *part_with_defaults(const char *path, size_t length) {
  const hl_setting *setting = setting_of(path, length);
  if (has_three(setting, false))
    return json_pack("[f, f, f]", setting->standard[0], setting->standard[1], setting->standard[2]);
  const bool is_list = strspn(path + length + 1, "0123456789") > 0;
  return is_list || setting_of(path, strlen(path)) == NULL ? NULL : json_object();
}

/* Steps into a part of the scene that a path names before its last name. A part that its object leaves out
 * is added. length: the number of bytes of the path up to the end of `name`. */
static json_t *step_or_add(json_t *at, const char *name, const char *path, size_t length) {
  json_t *part = step_into(at, name);
  if (part != NULL || !json_is_object(at)) return part;
  part = part_with_defaults(path, length);
  return part != NULL && json_object_set_new(at, name, part) == 0 ? part : NULL;
}

/* Writes a key's value at its path. A key that is absent from its object is added, because the scene has the
 * key's default there. The library refuses unknown keys. */
static hl_status write_value(json_t *root, const film_key *key, int frame, hl_error *error) {
  char *names = strdup(key->path), *rest = names, *name;
  if (names == NULL) return no_memory(error);
  const bool has_parts = key->components == 3;
  json_t *at = root;
  while ((name = strsep(&rest, ".")) != NULL && rest != NULL && at != NULL)
    at = step_or_add(at, name, key->path, (size_t)(name - names) + strlen(name));
  json_t *before = at != NULL ? step_into(at, name) : NULL;
  bool good = has_parts ? json_is_object(at) &&
                              (has_three(setting_of(key->path, strlen(key->path)), key->is_color) ||
                               (!key->is_color && json_array_size(before) == 3))
              : before != NULL ? json_is_number(before)
                               : json_is_object(at) && name[0] != '\0';
  int written = -1;
  if (good && json_is_object(at)) written = json_object_set_new(at, name, value_at(key, frame, name));
  else if (good) written = json_array_set_new(at, strtoul(name, NULL, 10), value_at(key, frame, name));
  if (!good)
    snprintf(error->message, sizeof error->message,
             "%s: the scene has no %s there: `halflight render SCENE --print-scene` shows its keys",
             key->path,
             key->is_color ? "colour"
             : has_parts   ? "point, direction or colour"
                           : "number");
  free(names);
  if (!good) return HL_ERROR_ARGUMENT;
  return written == 0 ? HL_OK : no_memory(error);
}

static hl_status read_frame(const film *f, json_t *text, int frame, hl_scene **scene, hl_error *error) {
  hl_status status = HL_OK;
  for (size_t k = 0; status == HL_OK && k < f->key_count; k++)
    if (!is_turn(f->keys[k].path)) status = write_value(text, &f->keys[k], frame, error);
  if (status != HL_OK) return status;
  char *written = hl_plain_json_dump(text, JSON_COMPACT);
  if (written == NULL) return no_memory(error);
  status = hl_scene_from_json_like(f->context, written, strlen(written), NULL, "scene", f->scene, scene,
                                   error);
  free(written);
  return status;
}

/* ---- the camera ---- */

void film_zoom(hl_camera *camera, double factor) {
  if (camera->type == HL_CAMERA_ORTHOGRAPHIC) camera->height /= factor;
  else
    for (int k = 0; k < 3; k++)
      camera->position[k] = camera->target[k] + (camera->position[k] - camera->target[k]) / factor;
}

/* Turns the camera by the angles that the turntable and the keys give at a frame, and zooms it. */
static hl_status turn_camera(const film *f, int frame, hl_camera *camera,
                             const hl_scene_description *description, hl_error *error) {
  hl_view view;
  double *angles[] = {&view.azimuth_deg, &view.elevation_deg, &view.roll_deg};
  bool turns = f->turntable > 0;
  hl_status status = hl_view_of_camera(description, &view);
  if (status == HL_OK && f->turntable > 0) view.azimuth_deg += 360.0 * frame / f->turntable;
  for (size_t k = 0; status == HL_OK && k < f->key_count; k++) {
    int turn = turn_of(f->keys[k].path);
    double value[3];
    film_key_value(&f->keys[k], frame, value);
    if (turn == TURN_ZOOM && !(*value >= 1e-6 && *value <= 1e6)) status = HL_ERROR_ARGUMENT;
    else if (turn == TURN_ZOOM) film_zoom(camera, *value);
    else if (turn >= 0) *angles[turn] = *value, turns = true;
  }
  if (status == HL_OK && turns) status = hl_camera_turn(&view, camera);
  if (status != HL_OK && error->message[0] == '\0')
    snprintf(error->message, sizeof error->message,
             "frame %d: the camera cannot be turned so: zoom is from 1e-6 to 1e6", frame);
  return status;
}

/* ---- lights ---- */

static double dot(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/* The direction of a light that has the given angles. The direction is in the axes of the light's frame,
 * which are the axes of the world or of the camera. */
static void direction_at(const hl_light *light, const hl_camera *camera, double azimuth, double elevation,
                         double direction[3]) {
  if (light->frame == HL_LIGHT_FRAME_CAMERA) hl_light_direction_beside(azimuth, elevation, direction);
  else hl_light_direction(camera, azimuth, elevation, direction);
}

/* Finds the angles of a light from its direction, as the inverse of direction_at(). The directions at (0, 0),
 * (90, 0) and (0, 90) degrees are perpendicular, and so are the axes of the angles. */
static void angles_of(const hl_light *light, const hl_camera *camera, double *azimuth, double *elevation) {
  double ahead[3], aside[3], above[3];
  direction_at(light, camera, 0, 0, ahead);
  direction_at(light, camera, 90, 0, aside);
  direction_at(light, camera, 0, 90, above);
  double up = dot(light->direction, above), x = dot(light->direction, aside),
         z = dot(light->direction, ahead);
  const double degrees = 180 / 3.14159265358979323846;
  *azimuth = hl_atan2(x, z) * degrees;
  *elevation = hl_atan2(up, hl_hypot(x, z)) * degrees;
}

static hl_status turn_lights(const film *f, int frame, hl_light *lights, const hl_scene_description *scene,
                             hl_error *error) {
  for (size_t k = 0; k < f->key_count; k++) {
    size_t number;
    bool azimuth;
    double angles[2], value[3];
    if (!is_light_turn(f->keys[k].path, &number, &azimuth)) continue;
    if (number >= scene->light_count || lights[number].type != HL_LIGHT_DIRECTIONAL) {
      snprintf(error->message, sizeof error->message,
               "%s: the scene has no directional light there: of others move the position", f->keys[k].path);
      return HL_ERROR_ARGUMENT;
    }
    angles_of(&lights[number], &scene->camera, &angles[0], &angles[1]);
    film_key_value(&f->keys[k], frame, value);
    angles[azimuth ? 0 : 1] = *value;
    direction_at(&lights[number], &scene->camera, angles[0], angles[1], lights[number].direction);
  }
  return HL_OK;
}

static bool film_turns(const film *f) {
  bool turns = f->turntable > 0;
  for (size_t k = 0; k < f->key_count; k++) turns |= is_turn(f->keys[k].path);
  return turns;
}

hl_status film_scene(const film *f, int frame, hl_scene **scene, hl_error *error) {
  json_t *text = json_deep_copy(f->text);
  hl_scene *read = NULL;
  *scene = NULL;
  hl_status status = text != NULL ? read_frame(f, text, frame, &read, error) : no_memory(error);
  json_decref(text);
  if (status != HL_OK) return status;
  if (!film_turns(f)) {
    *scene = read;
    return HL_OK;
  }
  hl_scene_description description = *hl_scene_describe(read);
  hl_light *lights = calloc(description.light_count + 1, sizeof *lights);
  status = lights != NULL ? turn_camera(f, frame, &description.camera, hl_scene_describe(read), error)
                          : no_memory(error);
  if (status == HL_OK && description.light_count > 0)
    memcpy(lights, description.lights, description.light_count * sizeof *lights);
  description.lights = lights;
  if (status == HL_OK) status = turn_lights(f, frame, lights, &description, error);
  if (status == HL_OK) status = hl_scene_create(f->context, &description, scene, error);
  free(lights);
  hl_scene_release(read);
  return status;
}

/* ---- the film ---- */

/* Returns whether the values of a key are directions, because the key's setting is a direction. */
static bool is_direction(const film_key *key) {
  return key->components == 3 && has_type(setting_of(key->path, strlen(key->path)), HL_SETTING_DIRECTION);
}

static hl_status read_keys(film *f, const film_options *options, hl_error *error) {
  hl_status status = HL_OK;
  f->keys = calloc(options->key_count + 1, sizeof *f->keys);
  if (f->keys == NULL) return no_memory(error);
  for (; status == HL_OK && f->key_count < options->key_count; f->key_count++) {
    status = film_key_read(options->keys[f->key_count], options->frames_per_second, &f->keys[f->key_count],
                           error);
    f->keys[f->key_count].smooth = options->smooth;
    f->keys[f->key_count].turns = is_direction(&f->keys[f->key_count]);
    if (status == HL_OK && is_turn(f->keys[f->key_count].path) && f->keys[f->key_count].components != 1) {
      snprintf(error->message, sizeof error->message, "%s: a turn is a single number",
               f->keys[f->key_count].path);
      status = HL_ERROR_ARGUMENT;
    }
    for (size_t k = 0; status == HL_OK && k < f->key_count; k++)
      if (strcmp(f->keys[k].path, f->keys[f->key_count].path) == 0) {
        snprintf(error->message, sizeof error->message, "%s: it has two keys: join them by commas",
                 f->keys[k].path);
        status = HL_ERROR_ARGUMENT;
      }
  }
  return status;
}

static int count_frames(const film *f, const film_options *options) {
  if (options->frames > 0) return options->frames;
  int frames = options->turntable;
  for (size_t k = 0; k < f->key_count; k++) {
    int last = f->keys[k].frames[f->keys[k].count - 1] + 1;
    if (last > frames) frames = last;
  }
  return frames;
}

static hl_status parse_scene(film *f, hl_error *error) {
  char *text = NULL;
  hl_status status = hl_scene_to_json(f->context, f->scene, &text, error);
  if (status != HL_OK) return status;
  f->text = hl_plain_json_load_text(text);
  hl_text_release(f->context, text);
  return f->text != NULL ? HL_OK : no_memory(error);
}

/* Makes the scene of a frame and releases it. The function is called for the first and the last frame, so
 * that a mistake in a key is reported before any frame is rendered. */
static hl_status try_frame(const film *f, int frame, hl_error *error) {
  hl_scene *scene = NULL;
  hl_status status = film_scene(f, frame, &scene, error);
  hl_scene_release(scene);
  return status;
}

hl_status film_create(const film_options *options, film **result, hl_error *error) {
  film *f = calloc(1, sizeof *f);
  *result = NULL;
  if (f == NULL) return no_memory(error);
  *f = (film){.context = options->context, .scene = options->scene, .turntable = options->turntable};
  hl_status status = read_keys(f, options, error);
  if (status == HL_OK) f->frames = count_frames(f, options);
  if (f->turntable == FILM_WHOLE_TURN) f->turntable = f->frames;
  if (status == HL_OK && (f->frames < 1 || f->frames > FILM_MOST_FRAMES)) {
    snprintf(error->message, sizeof error->message, "a film has 1 to %d frames", (int)FILM_MOST_FRAMES);
    status = HL_ERROR_ARGUMENT;
  }
  if (status == HL_OK) status = parse_scene(f, error);
  if (status == HL_OK) status = try_frame(f, 0, error);
  if (status == HL_OK) status = try_frame(f, f->frames - 1, error);
  if (status == HL_OK) *result = f;
  else film_destroy(f);
  return status;
}

void film_destroy(film *f) {
  if (f == NULL) return;
  for (size_t k = 0; k < f->key_count; k++) film_key_release(&f->keys[k]);
  free(f->keys);
  json_decref(f->text);
  free(f);
}

int film_frames(const film *f) { return f->frames; }
