/* compose/labels.c - applies the options "labels", "mask", "label-table" and "show". A label map becomes one
 * more volume of the scene, or a mask over its volumes, or the bare volume itself is shown as a label map. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compose/composer.h"
#include "compose/shown_labels.h"
#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "scene/geometry/lengths.h"
#include "scene/label/label_table.h"
#include "text/plain.h"
#include "text/stem.h"
#include "volume/load_beside.h"

/* The number of label layers in the volume's file. Components of the file's array that are neither time steps
 * nor channels are layers. */
static size_t layers_of(const hl_volume *volume) {
  hl_volume_selection read = {.struct_size = sizeof read};
  if (hl_volume_get_selection(volume, &read) == HL_OK && (read.times > 1 || read.channels > 1)) return 1;
  for (size_t n = 0; n < hl_volume_array_count(volume); n++) {
    hl_volume_array array = {.struct_size = sizeof array};
    if (hl_volume_get_array(volume, n, &array) == HL_OK && array.chosen) return array.components;
  }
  return 1;
}

/* Names the only label of a map after the map's file, if the label has no name. The name of a mask's file
 * often tells which object the mask marks. */
static void name_after_file(const char *file, hl_label_layers *layers, hl_label *labels, size_t count) {
  size_t length;
  const char *stem = hl_stem(file, &length);
  if (count != 1 || (labels[0].name != NULL && labels[0].name[0] != '\0') || length == 0) return;
  snprintf(layers->stem, sizeof layers->stem, "%.*s", (int)fmin((double)length, 200), stem);
  labels[0].name = layers->stem;
}

/* Loads the next layer and its labels. reading: the options for reading the file; a layer is read as a
 * component of the file. scene: the scene whose first volume the labels lie over; null if the labels lie over
 * no volume. The scene's unit of lengths becomes the layer's unit. */
static hl_status load_layer(hl_context *context, const char *file, const char *table,
                            const hl_volume_load_options *reading, const hl_scene_description *scene,
                            hl_label_layers *layers, hl_error *error) {
  const hl_scene_volume *over = scene != NULL && scene->volume_count > 0 ? &scene->volumes[0] : NULL;
  hl_volume_load_options options = *reading;
  if (options.time < 0 && options.channel < 0) options.component = (int)layers->count;
  hl_scene_volume *made = &layers->volumes[layers->count];
  hl_scene_volume_defaults(made);
  const int none = made->component;
  hl_status status = hl_volume_load_beside(
      context, file, over != NULL ? over->volume : NULL, over != NULL ? over->spacing : options.spacing,
      over != NULL ? over->file_space : NULL, &options, &made->volume, error);
  if (status != HL_OK) return status;
  layers->count++;
  made->file = file;
  if (scene != NULL) made->scale = hl_scene_file_scale(scene, made->volume);
  made->array = options.array, made->series = options.series;
  made->component = layers_of(made->volume) < 2 ? none : options.component;
  made->time = options.time, made->channel = options.channel, made->level = options.level;
  memcpy(made->spacing, options.spacing, sizeof made->spacing);
  made->file_space = options.file_space;
  hl_label *labels = NULL;
  status = hl_labels_of_volume(context, made->volume, table, &labels, &made->label_count, error);
  made->labels = labels;
  if (status == HL_OK && layers->count == 1) name_after_file(file, layers, labels, made->label_count);
  return status;
}

/* Loads the layers that have labels, and shows the labels that the list names. */
static hl_status load_layers(const hl_composer *composer, const char *path, const char *table,
                             const hl_volume_load_options *reading, const hl_scene_description *scene,
                             hl_shown_list *show, hl_label_layers *layers) {
  for (size_t count = 1; layers->count < count;) {
    hl_status status = load_layer(composer->context, path, table, reading, scene, layers, composer->error);
    if (status != HL_OK) return status;
    count = layers_of(layers->volumes[0].volume);
    if (count > HL_MOST_LABEL_LAYERS)
      return hl_fail(composer->error, HL_ERROR_UNSUPPORTED, "'%.300s': has %zu layers, at most %d are read",
                     path, count, HL_MOST_LABEL_LAYERS);
    hl_scene_volume *layer = &layers->volumes[layers->count - 1];
    hl_show_labels(show, (hl_label *)layer->labels, layer->label_count);
  }
  hl_tell_of_shadowed_labels(composer->context, show, layers);
  return HL_OK;
}

static void release_layers(hl_context *context, hl_label_layers *layers) {
  for (size_t n = 0; n < layers->count; n++) {
    hl_labels_release(context, (hl_label *)layers->volumes[n].labels);
    hl_volume_release(layers->volumes[n].volume);
  }
}

/* Replaces *scene by a new scene, made of the description. */
static hl_status make(const hl_composer *composer, const hl_scene_description *description,
                      hl_scene **scene) {
  hl_scene *made = NULL;
  hl_status status = hl_scene_create(composer->context, description, &made, composer->error);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = made;
  return HL_OK;
}

/* Replaces *scene by a scene of its first `kept` volumes, followed by the layers. */
static hl_status add_layers(const hl_composer *composer, const hl_label_layers *layers, size_t kept,
                            hl_scene **scene) {
  hl_scene_description description = *hl_scene_describe(*scene);
  hl_scene_volume *volumes = hl_allocate(composer->context, kept + layers->count, sizeof *volumes);
  if (volumes == NULL)
    return hl_fail_memory(composer->error, (kept + layers->count) * sizeof *volumes, "the scene's volumes");
  if (kept > 0) memcpy(volumes, description.volumes, kept * sizeof *volumes);
  description.volume_count = kept;
  for (size_t n = 0; n < layers->count; n++)
    if (layers->volumes[n].label_count > 0) volumes[description.volume_count++] = layers->volumes[n];
  description.volumes = volumes;
  hl_status status = make(composer, &description, scene);
  if (status == HL_OK && composer->bare) {
    description = *hl_scene_describe(*scene); /* the new scene's description has transfer functions made from
                                               * the labels, by which the camera is placed */
    status = hl_camera_reframe(&description, &description.camera, composer->error);
    if (status == HL_OK) status = make(composer, &description, scene);
  }
  hl_release(composer->context, volumes);
  return status;
}

/* The options for reading the file of labels. itself: whether the label map replaces the scene's only volume,
 * which is bare. If so, the map is read with the options by which this volume was read; if not, the map is
 * converted to the anatomical space of the scene's first volume. */
static hl_volume_load_options reading_of(const hl_scene_description *description, bool itself) {
  hl_volume_load_options reading;
  hl_volume_info info = {.struct_size = sizeof info};
  hl_volume_load_options_defaults(&reading);
  const hl_scene_volume *first = description->volume_count > 0 ? &description->volumes[0] : NULL;
  if (first != NULL && itself) {
    reading.array = first->array, reading.series = first->series;
    reading.time = first->time, reading.channel = first->channel, reading.level = first->level;
    memcpy(reading.spacing, first->spacing, sizeof reading.spacing);
    reading.file_space = first->file_space;
  } else if (first != NULL && hl_volume_get_info(first->volume, &info) == HL_OK) {
    reading.space = info.space;
  }
  return reading;
}

/* The fraction of opacity that "rest:FRACTION" in "show" gives the matter outside a mask's labels; 0 if
 * "show" has no such item. */
static double rest_of(hl_shown_list *show) {
  double rest = 0;
  for (size_t s = 0; s < show->count; s++) {
    if (!show->labels[s].rest) continue;
    show->labels[s].found = true;
    rest = show->labels[s].opacity;
  }
  return rest;
}

/* Makes a scene in which the volumes have the mask. Volumes that are label maps get no mask. */
static hl_status put_on_mask(const hl_composer *composer, const hl_mask *mask, hl_scene **scene) {
  hl_scene_description description = *hl_scene_describe(*scene);
  hl_scene_volume *volumes = hl_allocate(composer->context, description.volume_count, sizeof *volumes);
  if (volumes == NULL)
    return hl_fail_memory(composer->error, description.volume_count * sizeof *volumes, "the scene's volumes");
  memcpy(volumes, description.volumes, description.volume_count * sizeof *volumes);
  for (size_t v = 0; v < description.volume_count; v++)
    if (volumes[v].label_count == 0) volumes[v].mask = *mask;
  description.volumes = volumes;
  hl_status status = make(composer, &description, scene);
  hl_release(composer->context, volumes);
  return status;
}

/* Warns if the layers have no labels, so that the picture shows nothing of them. */
static void tell_of_no_labels(const hl_composer *composer, const char *path, const hl_label_layers *layers) {
  size_t labels = 0;
  for (size_t n = 0; n < layers->count; n++) labels += layers->volumes[n].label_count;
  if (labels == 0)
    hl_log(composer->context, HL_LOG_WARNING, "no voxel of '%.300s' has a label: all its numbers are 0",
           path);
}

/* Moves the visible labels to the front of the list, and returns the number of visible labels. Without the
 * hidden labels in the list, their matter belongs to the rest. */
static size_t keep_shown(hl_label *labels, size_t count) {
  size_t kept = 0;
  for (size_t n = 0; n < count; n++)
    if (labels[n].visible) labels[kept++] = labels[n];
  return kept;
}

/* Returns whether a label's colour comes from a file, and was not chosen by the label's number. */
static bool has_own_color(const hl_label *label) {
  double distinct[3];
  hl_label_distinct_color(label->value, distinct);
  return memcmp(distinct, label->color, sizeof distinct) != 0;
}

/* Logs which option gives matter the colours that a file gives the mask's labels. Nothing is logged if the
 * list gives any label a colour, or if no visible label has a colour from a file. */
static void tell_of_own_colors(const hl_composer *composer, const hl_shown_list *show, const hl_mask *mask) {
  const char *item = "all";
  bool own = false;
  for (size_t n = 0; n < mask->label_count; n++) {
    if (mask->labels[n].tint > 0) return;
    own = own || has_own_color(&mask->labels[n]);
  }
  for (size_t s = show->count; s-- > 0;)
    if (!show->labels[s].rest) item = show->labels[s].name;
  if (own)
    hl_log(composer->context, HL_LOG_INFO,
           "the matter within the mask keeps its colours: --show %s=own gives it the label's own", item);
}

/* Applies "mask": puts the file's label map over the scene's volumes as a mask. */
static hl_status add_mask(const hl_composer *composer, hl_shown_list *show, hl_label_layers *layers,
                          hl_scene **scene) {
  const hl_scene_description *description = hl_scene_describe(*scene);
  const char *path = composer->asked[HL_ASK_MASK].text;
  const double rest = rest_of(show);
  show->of_mask = true;
  if (description->volume_count == 0)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT, "--mask is for volumes: the scene has none");
  const hl_volume_load_options reading = reading_of(description, false);
  hl_status status = load_layers(composer, path, composer->asked[HL_ASK_LABEL_TABLE].text, &reading,
                                 description, show, layers);
  if (status == HL_OK) status = hl_check_shown(show, layers, composer->error);
  if (status != HL_OK) return status;
  tell_of_no_labels(composer, path, layers);
  if (layers->count > 1)
    return hl_fail(composer->error, HL_ERROR_UNSUPPORTED,
                   "'%.300s': has %zu overlapping layers, a mask takes one: save it as one", path,
                   layers->count);
  const hl_scene_volume *map = &layers->volumes[0];
  const hl_mask mask = {.volume = map->volume,
                        .file = path,
                        .component = map->component,
                        .labels = map->labels,
                        .label_count = keep_shown((hl_label *)map->labels, map->label_count),
                        .rest = rest};
  tell_of_own_colors(composer, show, &mask);
  return put_on_mask(composer, &mask, scene);
}

/* Applies "labels": adds the label map of a file, or makes the bare volume itself a label map. */
static hl_status add_map(const hl_composer *composer, hl_shown_list *show, hl_label_layers *layers,
                         hl_scene **scene) {
  const hl_asked *asked = composer->asked;
  const hl_scene_description *description = hl_scene_describe(*scene);
  const bool itself = !asked[HL_ASK_LABELS].given;
  const char *path = asked[HL_ASK_LABELS].text;
  if (itself && composer->bare && description->volume_count == 1) path = description->volumes[0].file;
  if (path == NULL)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--%s is for a label map: give its file as --labels FILE, or alone as INPUT",
                   asked[HL_ASK_SHOW].given ? "show" : "label-table");
  hl_volume_load_options reading = reading_of(description, itself);
  if (itself && description->volumes[0].label_count == 0)
    hl_log(
        composer->context, HL_LOG_WARNING,
        "'%.300s' does not look like a label map, and --%s takes it as one: a label map over a scan is given "
        "by --labels FILE",
        path, asked[HL_ASK_SHOW].given ? "show" : "label-table");
  hl_let_rest_be_all(show);
  hl_status status = load_layers(composer, path, asked[HL_ASK_LABEL_TABLE].text, &reading,
                                 itself ? NULL : description, show, layers);
  if (status == HL_OK) status = hl_check_shown(show, layers, composer->error);
  if (status != HL_OK) return status;
  tell_of_no_labels(composer, path, layers);
  return add_layers(composer, layers, itself ? 0 : description->volume_count, scene);
}

/* Returns whether the scene's only volume was read without options that select a part of its file. */
static bool is_read_plainly(const hl_scene_volume *volume) {
  hl_scene_volume plain;
  hl_scene_volume_defaults(&plain);
  return volume->array == NULL && volume->series == NULL && volume->component == plain.component &&
         volume->time == plain.time && volume->channel == plain.channel && volume->level == plain.level &&
         !(volume->spacing[0] > 0) && volume->file_space == NULL;
}

/* Returns whether the scene's only volume is a bare label map whose file has further layers of labels. The
 * further layers are then shown, too. */
static bool is_layered(const hl_composer *composer, const hl_scene_description *description) {
  const hl_scene_volume *only = description->volume_count == 1 ? &description->volumes[0] : NULL;
  if (!composer->bare || (composer->flags & HL_COMPOSE_CHANGED) != 0 || only == NULL || only->file == NULL ||
      only->label_count == 0 || hl_plain_is_stream(only->file) || !is_read_plainly(only) ||
      hl_volume_segment_count(only->volume) == 0)
    return false;
  size_t layers = layers_of(only->volume);
  return layers > 1 && layers <= HL_MOST_LABEL_LAYERS;
}

bool hl_asks_for_labels(const hl_composer *composer, const hl_scene_description *description) {
  const hl_asked *asked = composer->asked;
  return asked[HL_ASK_LABELS].given || asked[HL_ASK_MASK].given || asked[HL_ASK_LABEL_TABLE].given ||
         asked[HL_ASK_SHOW].given || is_layered(composer, description);
}

hl_status hl_compose_labels(const hl_composer *composer, hl_scene **scene) {
  const hl_asked *mask = &composer->asked[HL_ASK_MASK];
  if (composer->asked[HL_ASK_LABELS].given && mask->given)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--mask and --labels exclude each other: --show belongs to one of them");
  hl_shown_list *show = hl_allocate_zeroed(composer->context, 1, sizeof *show);
  hl_label_layers *layers = hl_allocate_zeroed(composer->context, 1, sizeof *layers);
  hl_status status = show != NULL && layers != NULL
                         ? hl_read_shown(&composer->asked[HL_ASK_SHOW], show, composer->error)
                         : hl_fail_memory(composer->error, sizeof *show + sizeof *layers, "labels");
  if (status == HL_OK)
    status = mask->given ? add_mask(composer, show, layers, scene) : add_map(composer, show, layers, scene);
  if (layers != NULL) release_layers(composer->context, layers);
  hl_release(composer->context, layers);
  hl_release(composer->context, show);
  return status;
}

/* Makes a scene of the layers that have labels. */
static hl_status make_of_layers(const hl_composer *composer, const hl_label_layers *layers,
                                hl_scene **scene) {
  hl_scene_volume volumes[HL_MOST_LABEL_LAYERS];
  hl_scene_description description;
  hl_scene_description_defaults(&description);
  for (size_t n = 0; n < layers->count; n++)
    if (layers->volumes[n].label_count > 0) volumes[description.volume_count++] = layers->volumes[n];
  description.volumes = volumes;
  return make(composer, &description, scene);
}

hl_status hl_scene_for_label_map(hl_context *context, const char *path, const hl_volume_load_options *reading,
                                 const hl_option *options, size_t option_count, hl_scene **scene,
                                 hl_error *error) {
  HL_DOOR;
  hl_asked asked[HL_ASK_COUNT];
  hl_volume_load_options plain;
  hl_volume_load_options_defaults(&plain);
  if (context == NULL || path == NULL || scene == NULL || (options == NULL && option_count > 0))
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_scene_for_label_map: null context, path, options or scene");
  *scene = NULL;
  hl_status status = hl_options_read(options, option_count, asked, error);
  if (status != HL_OK) return status;
  const hl_composer composer = {.context = context, .asked = asked, .error = error};
  hl_shown_list *show = hl_allocate_zeroed(context, 1, sizeof *show);
  hl_label_layers *layers = hl_allocate_zeroed(context, 1, sizeof *layers);
  status = show != NULL && layers != NULL ? hl_read_shown(&asked[HL_ASK_SHOW], show, error)
                                          : hl_fail_memory(error, sizeof *show + sizeof *layers, "labels");
  if (status == HL_OK)
    status = load_layers(&composer, path, asked[HL_ASK_LABEL_TABLE].text, reading != NULL ? reading : &plain,
                         NULL, show, layers);
  if (status == HL_OK) status = make_of_layers(&composer, layers, scene);
  if (layers != NULL) release_layers(context, layers);
  hl_release(context, layers);
  hl_release(context, show);
  return status;
}
