/* compose/color_by.c - applies the option "color-by" FILE[:ARRAY][:MAP[:LO,HI]]: each volume keeps its
 * opacities, and gets the colours of the values that another volume has at the same position. The other
 * volume is added to the scene, but is not visible. A value without FILE is an array of a scene volume's own
 * file. With "color-by-threshold", matter keeps its own colour where the other volume's values are small.
 *
 * The option's value is read from its end. If its last part is two numbers, this part is the range. If the
 * last part before the range is the name of a colormap, this part is the map. The rest is the name of a file,
 * if a file has this name. Otherwise the rest is the name of a file and of one of its arrays, or the name of
 * an array of a scene volume's file. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compose/color_by.h"
#include "compose/looks.h"
#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "scene/function/function_plane.h"
#include "scene/function/transfer_function.h"
#include "scene/geometry/lengths.h"
#include "scene/geometry/placement.h"
#include "text/edit_distance.h"
#include "text/plain.h"
#include "text/stem.h"
#include "volume/load_beside.h"

enum { NAME_BYTES = 64 };

static const char *const colormap_of_fields = "viridis";

/* The value of the option in its parts. */
typedef struct typed_coloring {
  char *text;                    /* owned; the value without its range and its map */
  const char *file;              /* the file with the colouring values; points into `text`, or is the name of
                                  * the source's file */
  const char *array;             /* points into `text`; null for the array that is read by default */
  const hl_scene_volume *source; /* the scene's volume whose file has the array; null if `file` is another
                                  * file */
  const char *map;
  double range[2]; /* the typed range; range[0] < range[1] if the value has a range */
} typed_coloring;

/* Takes the last part after ':' off a text, if the part is a range LO,HI. */
static void take_range(char *text, double range[2]) {
  char *colon = strrchr(text, ':'), *rest;
  if (colon == NULL) return;
  const double low = hl_plain_number(colon + 1, &rest);
  if (rest == colon + 1 || *rest != ',') return;
  char *second = rest + 1;
  const double high = hl_plain_number(second, &rest);
  if (rest == second || *rest != '\0' || !isfinite(low) || !isfinite(high)) return;
  range[0] = low, range[1] = high;
  *colon = '\0';
}

/* Returns whether a text ends in the name of a colormap and a single number. */
static bool is_half_range(const char *text) {
  char map[80], *rest;
  const char *colon = strrchr(text, ':'), *before = colon;
  if (colon == NULL || !isfinite(hl_plain_number(colon + 1, &rest)) || rest == colon + 1 || *rest != '\0')
    return false;
  while (before > text && before[-1] != ':') before--;
  snprintf(map, sizeof map, "%.*s", (int)fmin((double)(colon - before), sizeof map - 1), before);
  return hl_find_colormap(map) != NULL;
}

/* Takes the last part after ':' off the text, if the part is the name of a colormap. */
static void take_map(typed_coloring *typed) {
  char *colon = strrchr(typed->text, ':');
  const char *map = colon != NULL ? hl_find_colormap(colon + 1) : NULL;
  typed->map = map != NULL ? map : colormap_of_fields;
  if (map != NULL) *colon = '\0';
}

static bool is_input(const hl_composer *composer, const char *file) {
  return hl_plain_is_url(file) || hl_file_kind(composer->context, file) != 0;
}

/* Reads the text as a file, or as a file and one of its arrays. Returns false if no such file exists. */
static bool find_file(const hl_composer *composer, typed_coloring *typed) {
  typed->file = typed->text;
  if (is_input(composer, typed->text)) return true;
  for (char *colon = typed->text + strlen(typed->text); colon > typed->text; colon--) {
    if (*colon != ':') continue;
    *colon = '\0';
    typed->array = colon + 1;
    if (is_input(composer, typed->text)) return true;
    *colon = ':';
  }
  typed->array = NULL;
  return false;
}

/* Reads the text as the name of an array in the file of one of the scene's volumes of values. names:
 * [ARRAY_NAMES + 1]; receives the names of the arrays in these files, as far as it has room. */
enum { ARRAY_NAMES = 32 };
static void find_source(const hl_composer *composer, const hl_scene_description *description,
                        typed_coloring *typed, const char *names[ARRAY_NAMES + 1]) {
  size_t named = 0;
  for (size_t v = 0; v < description->volume_count && typed->source == NULL; v++) {
    const hl_scene_volume *volume = &description->volumes[v];
    if (volume->label_count > 0 || volume->file == NULL || !is_input(composer, volume->file)) continue;
    for (size_t n = 0; n < hl_volume_array_count(volume->volume); n++) {
      hl_volume_array array = {.struct_size = sizeof array};
      if (hl_volume_get_array(volume->volume, n, &array) != HL_OK || array.name == NULL || array.name[0] == 0)
        continue;
      if (strcmp(array.name, typed->text) == 0) typed->source = volume;
      if (named < ARRAY_NAMES) names[named++] = array.name;
    }
  }
  if (typed->source == NULL) return;
  typed->array = typed->text;
  typed->file = typed->source->file;
}

/* Reads the option's value. typed->text is owned by the caller, also after a failure. */
static hl_status read_coloring(const hl_composer *composer, const hl_scene_description *description,
                               const char *text, typed_coloring *typed) {
  const char *names[ARRAY_NAMES + 1] = {NULL};
  *typed = (typed_coloring){.text = hl_copy_text(composer->context, text)};
  if (typed->text == NULL) return hl_fail_memory(composer->error, strlen(text) + 1, "a name");
  take_range(typed->text, typed->range);
  if (typed->range[0] > typed->range[1])
    return hl_fail(composer->error, HL_ERROR_ARGUMENT, "--color-by: '%.200s': LO must be below HI", text);
  if (is_half_range(typed->text))
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--color-by: '%.200s' ends in half of a range: give LO,HI, as FILE:hot:0,100", text);
  take_map(typed);
  if (find_file(composer, typed)) return HL_OK;
  find_source(composer, description, typed, names);
  if (typed->source != NULL || names[0] == NULL || names[1] == NULL) return HL_OK;
  char mend[300];
  hl_suggest_name(typed->text, names, mend, sizeof mend);
  return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                 "--color-by: '%.200s' is neither a file nor an array of the input: %s", typed->text, mend);
}

/* Reads "color-by-threshold": the volumes keep their own colours where the other volume's values lie between
 * two numbers, or below a single number. */
static hl_status read_threshold(const hl_composer *composer, double own[2]) {
  const hl_asked *asked = &composer->asked[HL_ASK_COLOR_BY_THRESHOLD];
  own[0] = own[1] = 0;
  if (!asked->given) return HL_OK;
  if (!(fabs(asked->number[0]) < HL_CURVES_NO_END && fabs(asked->number[1]) < HL_CURVES_NO_END) ||
      asked->number[0] > asked->number[1])
    return hl_fail(composer->error, HL_ERROR_ARGUMENT, "--color-by-threshold: '%.200s': LO must be below HI",
                   asked->text);
  own[0] = asked->number[0] < asked->number[1] ? asked->number[0] : -HL_CURVES_NO_END;
  own[1] = asked->number[1];
  return HL_OK;
}

/* Logs that most values of the other volume lie below the typed range, so that they have the map's first
 * colour. */
static hl_status tell_of_ends(const hl_composer *composer, const typed_coloring *typed,
                              const hl_scene_volume *other) {
  const double half = 50;
  double middle = 0;
  if (!(typed->range[0] < typed->range[1]) || composer->asked[HL_ASK_COLOR_BY_THRESHOLD].given) return HL_OK;
  hl_status status = hl_volume_percentiles(other->volume, &half, 1, &middle, composer->error);
  if (status == HL_OK && middle < typed->range[0])
    hl_log(composer->context, HL_LOG_INFO,
           "values of %s below %.9g have the first colour of %s: --color-by-threshold %.9g keeps the own "
           "colour of matter there",
           other->name, typed->range[0], typed->map, typed->range[0]);
  return hl_blame_options(status);
}

/* Refuses scenes whose matter cannot have the colours of another volume. */
static hl_status check_scene(const hl_composer *composer, const hl_scene_description *description) {
  size_t colored = 0;
  if (hl_is_maximum(composer, description))
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--color-by: a maximum projection shows one volume's values: give another look, as --look "
                   "surface");
  for (size_t v = 0; v < description->volume_count; v++) {
    const hl_scene_volume *volume = &description->volumes[v];
    colored += volume->label_count == 0;
  }
  if (colored == 0)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--color-by is for volumes of values: the picture has none");
  return HL_OK;
}

/* Fails because the value's last part is not an array of the file. The error says that the last part is not a
 * colormap either. */
static hl_status refuse_part(const hl_composer *composer, const typed_coloring *typed, hl_status status,
                             const hl_error *own) {
  hl_error map = {0};
  if (status != HL_ERROR_INPUT || typed->array == NULL || typed->source != NULL)
    return hl_fail(composer->error, status, "%s", own->message);
  (void)hl_refuse_colormap("color-by", typed->array, &map);
  return hl_fail(composer->error, status, "%.300s; nor is it an array: %.600s", map.message, own->message);
}

/* Loads the other volume into *made. typed: keeps the texts of its names. name: [NAME_BYTES]. */
static hl_status load(const hl_composer *composer, const hl_scene_description *description,
                      const typed_coloring *typed, char *name, hl_scene_volume *made) {
  const hl_scene_volume *first = &description->volumes[0], *source = typed->source;
  hl_volume_load_options reading;
  hl_error own = {0};
  hl_volume_load_options_defaults(&reading);
  reading.array = typed->array;
  reading.space = first->volume->space;
  hl_scene_volume_defaults(made);
  if (source != NULL) {
    reading.series = made->series = source->series;
    reading.time = made->time = source->time;
    reading.level = made->level = source->level;
    memcpy(reading.spacing, source->spacing, sizeof reading.spacing);
    reading.file_space = source->file_space;
  }
  hl_status status = hl_volume_load_beside(composer->context, typed->file, first->volume, first->spacing,
                                           first->file_space, &reading, &made->volume, &own);
  if (status != HL_OK) return hl_blame_options(refuse_part(composer, typed, status, &own));
  size_t length = typed->array != NULL ? strlen(typed->array) : 0;
  const char *stem = typed->array != NULL ? typed->array : hl_stem(typed->file, &length);
  snprintf(name, NAME_BYTES, "%.*s", (int)fmin((double)length, NAME_BYTES - 1), stem);
  if (hl_scene_volume_named(description, name) != NULL) snprintf(name, NAME_BYTES, "color-by");
  made->file = typed->file;
  made->array = typed->array;
  made->scale = hl_scene_file_scale(description, made->volume);
  made->name = name;
  made->visible = 0;
  memcpy(made->spacing, reading.spacing, sizeof made->spacing);
  made->file_space = reading.file_space;
  return HL_OK;
}

/* Gives a volume its own opacities, and the colours of the other volume's values. */
static void color_by(const hl_scene_volume *other, const hl_transfer_function *colors,
                     const double own_between[2], hl_scene_volume *volume) {
  hl_transfer_function *function = &volume->transfer_function;
  function->plane = (hl_function_plane){.second = HL_SECOND_VOLUME,
                                        .volume = other->name,
                                        .curves = {.opacity = function->opacity,
                                                   .opacity_count = function->opacity_count,
                                                   .color = colors->color,
                                                   .color_count = colors->color_count}};
  hl_function_curves *curves = &function->plane.curves;
  if (!(own_between[0] < own_between[1])) return;
  curves->own_color = function->color;
  curves->own_color_count = function->color_count;
  memcpy(curves->own_between, own_between, sizeof curves->own_between);
}

/* Gives the isosurfaces of the volumes the colours of the other volume. */
static hl_status color_surfaces(const hl_composer *composer, size_t volumes, hl_coloring *made) {
  size_t count = 0;
  for (size_t v = 0; v < volumes; v++) count += made->volumes[v].iso_count;
  if (count == 0) return HL_OK;
  hl_isosurface *surface = made->surfaces = hl_allocate(composer->context, count, sizeof *surface);
  if (surface == NULL) return hl_fail_memory(composer->error, count * sizeof *surface, "isosurfaces");
  for (size_t v = 0; v < volumes; v++) {
    hl_scene_volume *volume = &made->volumes[v];
    if (volume->iso_count == 0) continue;
    memcpy(surface, volume->iso, volume->iso_count * sizeof *surface);
    for (size_t i = 0; i < volume->iso_count; i++) surface[i].second_color = 1;
    volume->iso = surface;
    surface += volume->iso_count;
  }
  return HL_OK;
}

hl_status hl_compose_color_by(const hl_composer *composer, hl_scene_description *description,
                              hl_coloring *made) {
  const hl_asked *asked = &composer->asked[HL_ASK_COLOR_BY];
  const size_t count = description->volume_count;
  typed_coloring typed;
  double own_between[2];
  *made = (hl_coloring){0};
  if (!asked->given && composer->asked[HL_ASK_COLOR_BY_THRESHOLD].given)
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--color-by-threshold says where --color-by colours: add --color-by FILE:MAP:LO,HI");
  if (!asked->given) return HL_OK;
  hl_status status = read_threshold(composer, own_between);
  if (status == HL_OK) status = check_scene(composer, description);
  if (status != HL_OK) return status;
  status = read_coloring(composer, description, asked->text, &typed);
  made->text = typed.text;
  if (status != HL_OK) return status;
  made->volumes = hl_allocate(composer->context, count + 1, sizeof *made->volumes);
  if (made->volumes == NULL)
    return hl_fail_memory(composer->error, (count + 1) * sizeof *made->volumes, "the scene's volumes");
  memcpy(made->volumes, description->volumes, count * sizeof *made->volumes);
  hl_scene_volume *other = &made->volumes[count];
  status = load(composer, description, &typed, made->name, other);
  if (status != HL_OK) return status;
  made->other = other->volume;
  status = tell_of_ends(composer, &typed, other);
  if (status != HL_OK) return status;
  double range[2] = {other->volume->minimum, other->volume->maximum};
  if (typed.range[0] < typed.range[1]) memcpy(range, typed.range, sizeof range);
  if (!(range[0] < range[1])) range[1] = nextafter(range[0], INFINITY);
  status = hl_transfer_function_colormap(composer->context, typed.map, range[0], range[1], &made->colors,
                                         composer->error);
  for (size_t v = 0; v < count && status == HL_OK; v++)
    if (made->volumes[v].label_count == 0 && !hl_has_plane(&made->volumes[v].transfer_function))
      color_by(other, &made->colors, own_between, &made->volumes[v]);
  if (status == HL_OK) status = color_surfaces(composer, count, made);
  description->volumes = made->volumes;
  description->volume_count = count + 1;
  return status;
}

void hl_coloring_release(hl_context *context, hl_coloring *made) {
  hl_transfer_function_release(context, &made->colors);
  hl_volume_release(made->other);
  hl_release(context, made->volumes);
  hl_release(context, made->surfaces);
  hl_release(context, made->text);
}
