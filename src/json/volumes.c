/* json/volumes.c - reads one volume of a scene from JSON: its file, transform, material and transfer
 * function. */
#include <string.h>

#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "guess/analysis.h"
#include "json/parts.h"
#include "json/settings.h"
#include "json/shapes.h"
#include "scene/scene.h"
#include "text/body_axes.h"
#include "volume/load_beside.h"
#include "volume/volume.h"

#define DATA_PREFIX "data:" /* begins the names of files that lie in the context's data folder */

static const char *const volume_keys[] = {"name",        "stand_in",
                                          "file",        "shapes",
                                          "voxel_size",  "transform",
                                          "shading",     "transfer_function",
                                          "material",    "attenuation_color",
                                          "visible",     "casts_shadow",
                                          "clip",        "scraps",
                                          "legend",      "receives_shadow",
                                          "array",       "component",
                                          "time",        "channel",
                                          "level",       "spacing",
                                          "space",       "smooth",
                                          "series",      "scattering",
                                          "iso",         "labels",
                                          "label_table", "cuts",
                                          "cut_shading", "cut_casts_shadow",
                                          "mask",        NULL};

#define GIVE_COMPONENT "give a number from 0 on, \"magnitude\", \"color\" or \"luminance\""

/* The keys of a volume that are options for reading its file. */
static const char *const of_file[] = {"array",  "component", "time",  "channel", "level",
                                      "series", "spacing",   "space", "smooth"};

static hl_status read_rotate(hl_json_reader *reader, const json_t *value, hl_setting_kind kind,
                             void *target) {
  static const char *const keys[] = {"axis", "angle_deg", NULL};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "rotate");
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = hl_json_setting(reader, value, kind, "transform/rotate/axis", target);
  if (status == HL_OK) status = hl_json_setting(reader, value, kind, "transform/rotate/angle_deg", target);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* Reads the key "scale". Its value is one factor. For a volume it may also be three factors, along the axes
 * of the volume's own file. */
static hl_status read_scale(hl_json_reader *reader, const json_t *value, hl_setting_kind kind, void *target) {
  const json_t *scale = json_object_get(value, "scale");
  bool three = kind == HL_SETTINGS_VOLUME;
  if (three && json_is_array(scale))
    return hl_json_numbers(reader, value, "scale", 3, ((hl_scene_volume *)target)->axis_scale);
  if (three && scale != NULL && !json_is_number(scale))
    return hl_json_fail(reader, HL_ERROR_INPUT, "scale", "is %s: give a number or three, [x, y, z]",
                        hl_json_type_name(scale));
  return hl_json_setting(reader, value, kind, "transform/scale", target);
}

hl_status hl_json_read_transform(hl_json_reader *reader, const json_t *value, hl_setting_kind kind,
                                 void *target) {
  static const char *const keys[] = {"scale", "rotate", "translate", NULL};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "transform");
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = read_scale(reader, value, kind, target);
  if (status == HL_OK) status = read_rotate(reader, json_object_get(value, "rotate"), kind, target);
  if (status == HL_OK) status = hl_json_setting(reader, value, kind, "transform/translate", target);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static hl_status read_clip(hl_json_reader *reader, const json_t *value, hl_scene_volume *volume) {
  static const char *const keys[] = {"min", "max", NULL};
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "clip");
  hl_status status = hl_json_object(reader, value, keys);
  for (int k = 0; status == HL_OK && k < 2; k++)
    if (json_object_get(value, keys[k]) == NULL)
      status = hl_json_fail(reader, HL_ERROR_INPUT, keys[k], "is missing: give both min and max");
  if (status == HL_OK) status = hl_json_setting(reader, value, HL_SETTINGS_VOLUME, "clip/min", volume);
  if (status == HL_OK) status = hl_json_setting(reader, value, HL_SETTINGS_VOLUME, "clip/max", volume);
  volume->clipped = 1;
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* Reads an object of settings of a volume. key: the object's key. keys: the keys in the object, null at the
 * end. settings: the paths of the same settings in the table of settings, in the same order. */
static hl_status read_group(hl_json_reader *reader, const json_t *value, const char *key,
                            const char *const *keys, const char *const *settings, hl_scene_volume *volume) {
  if (value == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, key);
  hl_status status = hl_json_object(reader, value, keys);
  for (size_t k = 0; status == HL_OK && keys[k] != NULL; k++)
    status = hl_json_setting(reader, value, HL_SETTINGS_VOLUME, settings[k], volume);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

static hl_status read_scattering(hl_json_reader *reader, const json_t *value, hl_scene_volume *volume) {
  static const char *const keys[] = {"anisotropy", "albedo", "multiple", NULL};
  static const char *const settings[] = {"scattering/anisotropy", "scattering/albedo", "scattering/multiple"};
  return read_group(reader, value, "scattering", keys, settings, volume);
}

static hl_status read_scraps(hl_json_reader *reader, const json_t *value, hl_scene_volume *volume) {
  static const char *const keys[] = {"faint", "firm", "least", NULL};
  static const char *const settings[] = {"scraps/faint", "scraps/firm", "scraps/least"};
  return read_group(reader, value, "scraps", keys, settings, volume);
}

static hl_status read_legend(hl_json_reader *reader, const json_t *value, hl_scene_volume *volume) {
  static const char *const keys[] = {"low", "high", NULL};
  static const char *const settings[] = {"legend/low", "legend/high"};
  return read_group(reader, value, "legend", keys, settings, volume);
}

static bool same_text(const char *a, const char *b) {
  return a == NULL || b == NULL ? a == b : strcmp(a, b) == 0;
}

/* Finds a volume that was already made from this source; null if there is none. options: the options for
 * loading; for a file, these options and the smoothing must be the same as for the earlier volume. options is
 * null if the source is a text of shapes. */
static const hl_loaded_volume *find_loaded(const hl_volume_shelf *shelf, const char *source,
                                           const hl_volume_load_options *options, double smooth) {
  for (size_t v = 0; v < shelf->count; v++) {
    const hl_loaded_volume *loaded = &shelf->loaded[v];
    if (strcmp(loaded->source, source) != 0) continue;
    if (options == NULL) return loaded;
    bool same_step = loaded->time == options->time && loaded->channel == options->channel &&
                     loaded->level == options->level && loaded->preview_pixels == options->preview_pixels;
    if (same_text(loaded->array, options->array) && same_text(loaded->series, options->series) &&
        same_text(loaded->file_space, options->file_space) && same_step &&
        loaded->component == options->component && loaded->smooth == smooth &&
        memcmp(loaded->spacing, options->spacing, sizeof loaded->spacing) == 0)
      return loaded;
  }
  return NULL;
}

/* Adds a volume to the shelf, which then owns `source` and `volume`. */
static const hl_loaded_volume *put_on_shelf(hl_volume_shelf *shelf, char *source,
                                            const hl_volume_load_options *options, hl_volume *volume) {
  hl_loaded_volume *place = &shelf->loaded[shelf->count++];
  *place = (hl_loaded_volume){.source = source, .volume = volume, .smooth = hl_volume_smoothing(volume)};
  if (options == NULL) return place;
  place->array = options->array;
  place->series = options->series;
  place->component = options->component;
  place->time = options->time, place->channel = options->channel, place->level = options->level;
  place->preview_pixels = options->preview_pixels;
  memcpy(place->spacing, options->spacing, sizeof place->spacing);
  place->file_space = options->file_space;
  return place;
}

static hl_status shelve_mask(hl_json_reader *reader, hl_volume_shelf *shelf, const hl_mask *mask) {
  hl_volume_load_options options;
  if (mask->volume == NULL || mask->file == NULL) return HL_OK;
  char *copy = hl_copy_text(reader->context, mask->file);
  if (copy == NULL) return hl_fail_memory(reader->error, strlen(mask->file) + 1, "a path");
  hl_volume_load_options_defaults(&options);
  options.component = mask->component;
  hl_volume_retain(mask->volume);
  put_on_shelf(shelf, copy, &options, mask->volume);
  return HL_OK;
}

hl_status hl_json_shelve_known(hl_json_reader *reader, hl_volume_shelf *shelf) {
  for (size_t v = 0; v < reader->like->volume_count; v++) {
    const hl_scene_volume *known = &reader->like->volumes[v];
    hl_status status = shelve_mask(reader, shelf, &known->mask);
    if (status != HL_OK) return status;
    const char *source = known->file != NULL ? known->file : known->shapes;
    if (source == NULL) continue;
    char *copy = hl_copy_text(reader->context, source);
    if (copy == NULL) return hl_fail_memory(reader->error, strlen(source) + 1, "a path");
    hl_volume_load_options options;
    hl_volume_load_options_defaults(&options);
    options.array = known->array;
    options.series = known->series;
    options.component = known->component;
    options.time = known->time, options.channel = known->channel, options.level = known->level;
    memcpy(options.spacing, known->spacing, sizeof options.spacing);
    options.file_space = known->file_space;
    hl_volume_retain(known->volume);
    put_on_shelf(shelf, copy, &options, known->volume);
  }
  return HL_OK;
}

/* Reads the key "component": an index, or a word such as "magnitude". */
static hl_status read_component(hl_json_reader *reader, const json_t *value, int *component) {
  const json_t *given = json_object_get(value, "component");
  if (given == NULL) return HL_OK;
  if (json_is_string(given)) *component = hl_component_of_name(json_string_value(given));
  if (*component < HL_COMPONENT_DEFAULT) return HL_OK;
  if (json_is_integer(given) && json_integer_value(given) < 0)
    return hl_json_fail(reader, HL_ERROR_INPUT, "component", "is below 0: " GIVE_COMPONENT);
  if (!json_is_integer(given))
    return hl_json_fail(reader, HL_ERROR_INPUT, "component", "is %s: " GIVE_COMPONENT,
                        json_is_string(given) ? "another word" : hl_json_type_name(given));
  return hl_json_integer(reader, value, "component", component);
}

static hl_status read_index(hl_json_reader *reader, const json_t *value, const char *key, int *index) {
  const json_t *given = json_object_get(value, key);
  if (given == NULL) return HL_OK;
  hl_status status = hl_json_integer(reader, value, key, index);
  return status == HL_OK && *index < 0
             ? hl_json_fail(reader, HL_ERROR_INPUT, key, "is below 0: give a number from 0 on")
             : status;
}

/* Reads the options for loading a volume's file. */
static hl_status read_load_options(hl_json_reader *reader, const json_t *value,
                                   hl_volume_load_options *options) {
  int axis_in_body[3];
  double sign[3];
  hl_volume_load_options_defaults(options);
  hl_status status = hl_json_text(reader, value, "array", &options->array);
  if (status == HL_OK) status = hl_json_text(reader, value, "series", &options->series);
  if (status == HL_OK) status = read_component(reader, value, &options->component);
  if (status == HL_OK) status = read_index(reader, value, "time", &options->time);
  if (status == HL_OK) status = read_index(reader, value, "channel", &options->channel);
  if (status == HL_OK) status = read_index(reader, value, "level", &options->level);
  if (status == HL_OK) status = hl_json_numbers(reader, value, "spacing", 3, options->spacing);
  for (int axis = 0; status == HL_OK && axis < 3; axis++)
    if (json_object_get(value, "spacing") != NULL && !(options->spacing[axis] > 0))
      status = hl_json_fail(reader, HL_ERROR_INPUT, "spacing",
                            "has a number that is not above 0: give the distance of voxels");
  if (status == HL_OK) status = hl_json_text(reader, value, "space", &options->file_space);
  if (status == HL_OK && options->file_space != NULL &&
      !hl_body_axes_read(options->file_space, axis_in_body, sign))
    status = hl_json_fail(reader, HL_ERROR_INPUT, "space", "'%.40s': " HL_BODY_AXES_WANTED,
                          options->file_space);
  return status;
}

static bool is_data(const char *file) { return strncmp(file, DATA_PREFIX, strlen(DATA_PREFIX)) == 0; }

/* The path of a file that the scene names: in the data folder for "data:...", else relative to the scene's
 * folder. Owned by the caller (hl_release); null if memory is short. */
char *hl_json_path(const hl_json_reader *reader, const char *file) {
  bool data = is_data(file);
  return hl_path_join(reader->context, data ? reader->context->options.data_folder : reader->folder,
                      data ? file + strlen(DATA_PREFIX) : file);
}

/* Returns whether the scene neither rotates nor translates the volume. Only then do the world's axes keep the
 * anatomical meaning that the file gives them. */
static bool stays_as_it_is(const hl_scene_volume *volume) {
  return volume->rotate_angle_deg == 0 && volume->translate[0] == 0 && volume->translate[1] == 0 &&
         volume->translate[2] == 0;
}

/* Replaces a volume by its smoothed copy; *volume is null after a failure. */
static hl_status smooth_loaded(hl_json_reader *reader, double smooth, hl_volume **volume) {
  hl_volume *smoothed = NULL;
  hl_status status = hl_volume_smooth(*volume, smooth, &smoothed, reader->error);
  hl_volume_release(*volume);
  *volume = smoothed;
  if (status == HL_OK) return HL_OK;
  hl_json_enter(reader, "smooth");
  hl_json_prefix(reader, reader->place);
  return status;
}

/* Finds a mask that was already made from this file. over: the volume that it masks, whose spacing and space
 * the mask may have taken (hl_volume_load_beside()). */
static const hl_loaded_volume *find_mask(const hl_json_reader *reader, const hl_volume_shelf *shelf,
                                         const char *path, const hl_volume_load_options *options,
                                         const hl_scene_volume *over) {
  const hl_loaded_volume *plain = find_loaded(shelf, path, options, 0);
  const hl_loaded_volume *found = NULL;
  for (int taken = 1; found == NULL && taken < 4; taken++) { /* bit 0: the spacing, bit 1: the space */
    hl_volume_load_options beside = *options;
    if ((taken & 1) != 0) hl_spacing_beside(over->volume, over->spacing, beside.spacing);
    if ((taken & 2) != 0) beside.file_space = over->file_space;
    found = find_loaded(shelf, path, &beside, 0);
  }
  if (found != NULL || plain == NULL || reader->like != NULL) return found != NULL ? found : plain;
  return hl_takes_spacing_beside(plain->volume, over->volume, over->spacing) ||
                 hl_takes_space_beside(plain->volume, over->file_space)
             ? NULL
             : plain;
}

/* Loads a volume's file, or takes the volume from the shelf if it was loaded before. over: the volume that
 * the file's labels mask; null if the file is no mask. */
static hl_status load(hl_json_reader *reader, const char *file, const hl_volume_load_options *options,
                      double smooth, hl_volume_shelf *shelf, const hl_scene_volume *over,
                      hl_scene_volume *volume) {
  static const double none[3] = {0};
  if (is_data(file) && reader->context->options.data_folder == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "file", "\"%.200s\": no data folder is known: name one",
                        file);
  char *path = hl_json_path(reader, file);
  if (path == NULL) return hl_fail_memory(reader->error, strlen(file) + 1, "a path");
  const hl_loaded_volume *loaded = over != NULL ? find_mask(reader, shelf, path, options, over)
                                                : find_loaded(shelf, path, options, smooth);
  if (loaded != NULL) {
    hl_release(reader->context, path);
  } else if (reader->like != NULL) {
    hl_release(reader->context, path);
    return hl_json_fail(reader, HL_ERROR_INPUT, "file",
                        "\"%.200s\" is no volume of the open scene, or is read in another way: open it anew",
                        file);
  } else {
    hl_volume *made = NULL;
    hl_volume_load_options with_space = *options;
    if (stays_as_it_is(volume)) with_space.space = shelf->space;
    hl_status status = hl_volume_load_beside(
        reader->context, path, over != NULL ? over->volume : NULL, over != NULL ? over->spacing : none,
        over != NULL ? over->file_space : NULL, &with_space, &made, reader->error);
    if (status != HL_OK) {
      hl_release(reader->context, path);
      hl_json_enter(reader, "file");
      hl_json_prefix(reader, reader->place);
      return status;
    }
    if (smooth > 0) status = smooth_loaded(reader, smooth, &made);
    /* the scene says how a volume is smoothed, also at a finer resolution */
    if (status == HL_OK && options->preview_pixels > 0) atomic_store(&made->smoothing_chosen, true);
    if (status != HL_OK) {
      hl_release(reader->context, path);
      return status;
    }
    loaded = put_on_shelf(shelf, path, &with_space, made);
  }
  volume->volume = loaded->volume;
  if (shelf->space == HL_SPACE_UNKNOWN && stays_as_it_is(volume)) shelf->space = loaded->volume->space;
  volume->file = loaded->source;
  volume->array = options->array;
  volume->series = options->series;
  volume->component = options->component;
  volume->time = options->time, volume->channel = options->channel, volume->level = options->level;
  memcpy(volume->spacing, options->spacing, sizeof volume->spacing);
  volume->file_space = options->file_space;
  return HL_OK;
}

/* Makes a volume of shapes. If the same shapes were made before with the same voxel size, takes that volume
 * from the shelf. */
static hl_status read_shapes(hl_json_reader *reader, const json_t *value, hl_volume_shelf *shelf,
                             hl_scene_volume *volume) {
  const json_t *shapes = json_object_get(value, "shapes");
  double voxel_size = json_number_value(json_object_get(value, "voxel_size"));
  char *text = hl_json_shapes_text(reader->context, shapes, shelf->groups, voxel_size);
  const hl_loaded_volume *loaded = text != NULL ? find_loaded(shelf, text, NULL, 0) : NULL;
  hl_release(reader->context, text);
  if (loaded == NULL && reader->like != NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "shapes", "are not those of the open scene: open it anew");
  if (loaded == NULL) {
    hl_shapes_options options;
    hl_shapes_options_defaults(&options);
    options.threads = shelf->threads;
    hl_volume *made = NULL;
    hl_status status = hl_json_read_shapes(reader, value, shelf->groups, &options, &made, &voxel_size);
    if (status != HL_OK) return status;
    text = hl_json_shapes_text(reader->context, shapes, shelf->groups, voxel_size);
    if (text == NULL) {
      hl_volume_release(made);
      return hl_fail_memory(reader->error, 1000, "the text of shapes");
    }
    loaded = put_on_shelf(shelf, text, NULL, made);
  }
  volume->volume = loaded->volume;
  volume->shapes = loaded->source;
  return HL_OK;
}

/* Returns whether the range of a transfer function consists of percentiles. */
static bool is_of_percentiles(const json_t *function) {
  const json_t *range = json_object_get(function, "range");
  return range != NULL &&
         !(json_is_number(json_array_get(range, 0)) && json_is_number(json_array_get(range, 1)));
}

/* Returns whether nothing in a volume's JSON is found by the voxels, so that a first picture may have other
 * voxels. */
static bool is_said(const json_t *value) {
  static const char *const by_voxels[] = {"labels", "label_table", "scraps", "mask"};
  const json_t *function = json_object_get(value, "transfer_function");
  for (size_t n = 0; n < sizeof by_voxels / sizeof *by_voxels; n++)
    if (json_object_get(value, by_voxels[n]) != NULL) return false;
  return json_is_array(json_object_get(function, "opacity")) &&
         json_is_array(json_object_get(function, "color")) && json_object_get(function, "second") == NULL &&
         !is_of_percentiles(function);
}

/* over: as for load(). */
static hl_status read_source(hl_json_reader *reader, const json_t *value, hl_volume_shelf *shelf,
                             const hl_scene_volume *over, hl_scene_volume *volume) {
  const char *file = NULL;
  bool shapes = json_object_get(value, "shapes") != NULL;
  hl_status status = hl_json_text(reader, value, "file", &file);
  if (status != HL_OK) return status;
  if (file != NULL && shapes)
    return hl_json_fail(reader, HL_ERROR_INPUT, "shapes", "and file exclude each other: remove one");
  if (!shapes && json_object_get(value, "voxel_size") != NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "voxel_size", "is for shapes: remove it");
  for (size_t n = 0; shapes && n < sizeof of_file / sizeof *of_file; n++)
    if (json_object_get(value, of_file[n]) != NULL)
      return hl_json_fail(reader, HL_ERROR_INPUT, of_file[n], "is for files: remove it");
  if (shapes) return read_shapes(reader, value, shelf, volume);
  if (file == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "file", "is missing: name the volume's file, or give shapes");
  if (file[0] == 0) return hl_json_fail(reader, HL_ERROR_INPUT, "file", "is empty: name the volume's file");
  hl_volume_load_options options;
  double smooth = 0;
  status = read_load_options(reader, value, &options);
  if (status == HL_OK) status = hl_json_number(reader, value, "smooth", &smooth);
  if (over == NULL && is_said(value)) options.preview_pixels = reader->preview_pixels;
  return status == HL_OK ? load(reader, file, &options, smooth, shelf, over, volume) : status;
}

/* Reads the key "mask": a label map with its labels, "rest" and the keys of its file. Its labels are owned by
 * *volume (hl_labels_release). */
static hl_status read_mask(hl_json_reader *reader, const json_t *value, hl_volume_shelf *shelf,
                           hl_scene_volume *volume) {
  static const char *const keys[] = {"file", "component", "labels", "label_table", "rest", NULL};
  if (value == NULL) return HL_OK;
  hl_scene_volume map;
  hl_mask *mask = &volume->mask;
  hl_scene_volume_defaults(&map);
  size_t mark = hl_json_enter(reader, "mask");
  hl_status status = hl_json_object(reader, value, keys);
  if (status == HL_OK) status = read_source(reader, value, shelf, volume, &map);
  if (status == HL_OK && json_object_get(value, "labels") == NULL)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "labels", "is missing: give true for all, or a list");
  if (status == HL_OK) status = hl_json_read_label_list(reader, value, &map);
  if (status == HL_OK) status = hl_json_number(reader, value, "rest", &mask->rest);
  mask->volume = map.volume;
  mask->file = map.file;
  mask->component = map.component;
  mask->labels = map.labels;
  mask->label_count = map.label_count;
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

/* Returns whether a volume is made of shapes and is a solid. Orbitals are no solids, because their values are
 * signed floats. */
static bool is_solid(const hl_scene_volume *volume) {
  return volume->shapes != NULL && volume->volume->storage != HL_STORAGE_F32;
}

/* Chooses the shading of a volume for which neither shading nor a transfer function is given. Volumes that
 * look like smoke are shaded as media. */
static hl_status choose_shading(hl_json_reader *reader, const json_t *value, hl_scene_volume *volume) {
  if (json_object_get(value, "shading") != NULL || json_object_get(value, "transfer_function") != NULL ||
      volume->shapes != NULL)
    return HL_OK;
  hl_data_analysis analysis;
  hl_status status = hl_data_analyse(volume->volume, &analysis, reader->error);
  if (status != HL_OK) return hl_json_prefix(reader, reader->place), status;
  if (analysis.kind == HL_DATA_MEDIUM || analysis.kind == HL_DATA_PARTICLES)
    volume->shading = HL_SHADING_NONE;
  return HL_OK;
}

/* Returns whether a volume's file is available: whether it exists or, for a reader that opens no files,
 * whether the scene `like` has a volume of this file. */
static bool is_there(const hl_json_reader *reader, const char *file) {
  if (is_data(file) && reader->context->options.data_folder == NULL) return false;
  char *path = hl_json_path(reader, file);
  /* If there is no memory for the path, the result is true, so that the load of the file reports the
   * error. */
  bool there = path == NULL;
  for (size_t v = 0; !there && reader->like != NULL && v < reader->like->volume_count; v++)
    there = reader->like->volumes[v].file != NULL && strcmp(reader->like->volumes[v].file, path) == 0;
  if (!there && reader->like == NULL) there = hl_file_kind(reader->context, path) != 0;
  hl_release(reader->context, path);
  return there;
}

/* A volume in JSON may name a stand-in for its file. If the file is absent, *value becomes a copy of the
 * volume's JSON in which the keys of the stand-in replace the keys of the file. The copy is owned by the
 * shelf. */
static hl_status choose_stand_in(hl_json_reader *reader, const json_t **value, hl_volume_shelf *shelf) {
  const json_t *stand_in = json_object_get(*value, "stand_in");
  const char *file = NULL;
  if (stand_in == NULL) return HL_OK;
  size_t mark = hl_json_enter(reader, "stand_in");
  /* a stand-in may have all keys of a volume except its name and a stand-in */
  hl_status status = hl_json_object(reader, stand_in, volume_keys + 2);
  if (status != HL_OK) return status;
  hl_json_leave(reader, mark);
  if ((status = hl_json_text(reader, *value, "file", &file)) != HL_OK) return status;
  if (file == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "stand_in",
                        "is for a file that may be absent: name one, or remove it");
  if (is_there(reader, file)) return HL_OK;
  json_t *merged = hl_json_copy(*value);
  json_object_del(merged, "stand_in");
  json_object_del(merged, "file");
  for (size_t n = 0; n < sizeof of_file / sizeof *of_file; n++) json_object_del(merged, of_file[n]);
  if (shelf->stood_in == NULL) shelf->stood_in = json_array();
  bool failed = json_object_update(merged, (json_t *)stand_in) != 0;
  if (json_array_append_new(shelf->stood_in, merged) != 0 || failed)
    return hl_fail_memory(reader->error, 1000, "a stand-in");
  const char *folder = reader->context->options.data_folder;
  hl_log(reader->context, HL_LOG_WARNING, "%s: %s/file: %s is not there%s%s: its stand-in is shown",
         reader->name, reader->place, file, folder != NULL ? ", the data folder is " : "",
         folder != NULL ? folder : "");
  *value = merged;
  return HL_OK;
}

hl_status hl_json_read_volume(hl_json_reader *reader, const json_t *value, hl_volume_shelf *shelf,
                              hl_scene_volume *volume) {
  hl_scene_volume_defaults(volume);
  hl_status status = hl_json_object(reader, value, volume_keys);
  if (status == HL_OK) status = choose_stand_in(reader, &value, shelf);
  if (status == HL_OK) status = hl_json_text(reader, value, "name", &volume->name);
  if (status == HL_OK)
    status = hl_json_read_transform(reader, json_object_get(value, "transform"), HL_SETTINGS_VOLUME, volume);
  if (status == HL_OK)
    status = hl_json_settings_member(reader, json_object_get(value, "material"), "material",
                                     HL_SETTINGS_MATERIAL, &volume->material);
  if (status == HL_OK) status = hl_json_settings(reader, value, HL_SETTINGS_VOLUME, 0, volume);
  if (status == HL_OK) status = read_clip(reader, json_object_get(value, "clip"), volume);
  if (status == HL_OK)
    status = hl_json_read_cuts(reader, json_object_get(value, "cuts"), &volume->cuts, &volume->cut_count);
  if (status == HL_OK) status = read_scattering(reader, json_object_get(value, "scattering"), volume);
  if (status == HL_OK) status = read_scraps(reader, json_object_get(value, "scraps"), volume);
  if (status == HL_OK) status = read_legend(reader, json_object_get(value, "legend"), volume);
  if (status == HL_OK) status = read_source(reader, value, shelf, NULL, volume);
  if (status == HL_OK) status = hl_json_read_labels(reader, value, volume);
  if (status == HL_OK) status = read_mask(reader, json_object_get(value, "mask"), shelf, volume);
  if (status == HL_OK && volume->label_count == 0) status = choose_shading(reader, value, volume);
  if (status != HL_OK || volume->label_count > 0) return status;
  if ((status = hl_json_read_iso(reader, json_object_get(value, "iso"), volume)) != HL_OK) return status;
  if (volume->iso_count > 0 && json_object_get(value, "transfer_function") == NULL)
    return hl_json_clear_function(reader, volume->volume, &volume->transfer_function);
  hl_function_subject subject = {volume->volume, is_solid(volume), shelf->projected};
  return hl_json_read_transfer_function(reader, json_object_get(value, "transfer_function"), subject,
                                        &volume->transfer_function);
}
