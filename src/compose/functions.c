/* compose/functions.c - changes transfer functions by the options "tf", "colormap", "range", "range-scale"
 * and "threshold". */
#include <halflight/transfer_function.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "compose/composer.h"
#include "compose/looks.h"
#include "compose/slice.h"
#include "core/context.h"
#include "core/file.h"
#include "core/memory.h"
#include "guess/analysis.h"
#include "scene/function/transfer_function.h"
#include "text/color.h"
#include "text/edit_distance.h"
#include "text/plain.h"
#include "text/stem.h"

static const char *preset_name(const void *data, size_t index) {
  (void)data;
  return hl_preset_name(index);
}

static const char *colormap_name(const void *data, size_t index) {
  (void)data;
  return hl_colormap_name(index);
}

/* Compares a text with known names, without regard to upper and lower case. Returns the name that equals the
 * text, or null if no name does. */
static const char *find_known(const char *text, const char *(*known)(const void *, size_t)) {
  const char *candidate;
  for (size_t i = 0; (candidate = known(NULL, i)) != NULL; i++)
    if (hl_plain_equal(candidate, text)) return candidate;
  return NULL;
}

/* The name "gray" stands for the colormap that ParaView, matplotlib and Fiji call so, although CSS has a
 * colour of this name. */
const char *hl_find_colormap(const char *text) {
  const bool gray = hl_plain_equal(text, "gray") || hl_plain_equal(text, "grey");
  return find_known(gray ? "grays" : text, colormap_name);
}

/* Names that other programs use, each with the name that means nearly the same in this program. */
static const char *const meanings[][2] = {
    {"jet", "turbo"},
    {"rainbow", "turbo"},
    {"hsv", "turbo"},
    {"spectral", "turbo"},
    {"parula", "viridis"},
    {"bwr", "coolwarm"},
    {"seismic", "coolwarm"},
    {"RdBu", "coolwarm"},
    {"blue-red", "coolwarm"},
    {"diverging", "coolwarm"},
    {"fire", "hot"},
    {"afmhot", "hot"},
    {"CT-Bones", "ct-bone"},
    {"bones", "ct-bone"},
    {"skull", "ct-bone"},
    {"skin", "ct-skin"},
    {"CT-Fat", "ct-skin"},
    {"CT-AAA", "ct-soft-tissue"},
    {"CT-Muscle", "ct-soft-tissue"},
    {"CT-Cardiac", "ct-soft-tissue"},
    {"muscle", "ct-soft-tissue"},
    {"MR-Default", "mr-brain"},
    {"MR-T1", "mr-brain"},
    {"MR-T2-Brain", "mr-brain"},
    {"MR-MIP", "mip"},
};

static const char *meant_by(const char *name, const char *(*known)(const void *, size_t)) {
  for (size_t n = 0; n < sizeof meanings / sizeof *meanings; n++)
    if (hl_plain_equal(name, meanings[n][0]) && find_known(meanings[n][1], known) != NULL)
      return meanings[n][1];
  return NULL;
}

static hl_status refuse_name(const char *option, const char *name, const char *kind, const char *topic,
                             const char *(*known)(const void *, size_t), hl_error *error) {
  const char *meant = meant_by(name, known);
  if (meant == NULL) meant = hl_nearest_candidate(name, known, NULL);
  if (meant != NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "--%s: '%.300s' is no %s: did you mean %s?", option, name, kind,
                   meant);
  return hl_fail(error, HL_ERROR_ARGUMENT, "--%s: '%.300s' is no %s: see 'halflight help %s'", option, name,
                 kind, topic);
}

hl_status hl_refuse_colormap(const char *option, const char *name, hl_error *error) {
  return refuse_name(option, name, "colormap", "colormaps", colormap_name, error);
}

/* ---- names ---- */

/* A volume or a mesh that the values of options can name. */
typedef struct part {
  const char *name, *file; /* may be null */
  const char *kind;        /* "volume" or "mesh" */
  size_t index;
} part;

static part part_of_volume(const hl_scene_volume *volume, size_t index) {
  return (part){volume->name, volume->file, "volume", index};
}

static part part_of_mesh(const hl_scene_mesh *mesh, size_t index) {
  return (part){mesh->name, mesh->file, "mesh", index};
}

/* The name by which "tf" NAME=... and other options call a part: its name in the scene, or the name of its
 * file without folder and extensions (length_without_size() is allowed, too), or "volume1" and so on. */
static void name_of(const part *part, char *name, size_t size) {
  if (part->name != NULL) {
    snprintf(name, size, "%s", part->name);
  } else if (part->file != NULL) {
    size_t length;
    const char *stem = hl_stem(part->file, &length);
    snprintf(name, size, "%.*s", (int)(length < size ? length : size - 1), stem);
  } else {
    snprintf(name, size, "%s%zu", part->kind, part->index + 1);
  }
}

/* The text after "NAME="; null if the text has no name, so that the value is for every volume. If the whole
 * text is the name of a file, the text has no name, even with a '=' in it. */
static const char *after_name(const hl_context *context, const char *text) {
  const char *equals = strchr(text, '=');
  return equals == NULL || hl_file_kind(context, text) != 0 ? NULL : equals + 1;
}

/* The length of a file's name without the size and type that names of files of bare voxels have: 6, the
 * length of "engine", for "engine_256x256x128_uint8". */
static size_t length_without_size(const char *name) {
  for (const char *at = strchr(name, '_'); at != NULL; at = strchr(at + 1, '_')) {
    const size_t digits = strspn(at + 1, "0123456789");
    if (at > name && digits > 0 && at[1 + digits] == 'x' && strspn(at + 2 + digits, "0123456789") > 0)
      return (size_t)(at - name);
  }
  return strlen(name);
}

/* Returns whether a value "NAME=..." names the part. *rest: the text after "NAME="; null if the value has no
 * name. */
static bool names_part(const hl_composer *composer, const char *text, part part, const char **rest) {
  char own[256];
  *rest = after_name(composer->context, text);
  if (*rest == NULL) return false;
  name_of(&part, own, sizeof own);
  const size_t length = (size_t)(*rest - text) - 1;
  return (length == strlen(own) || length == length_without_size(own)) && memcmp(own, text, length) == 0;
}

bool hl_text_is_for(const hl_composer *composer, const char *text, const hl_scene_volume *volume,
                    size_t index, const char **rest) {
  bool named = names_part(composer, text, part_of_volume(volume, index), rest);
  if (*rest != NULL) return named;
  *rest = text;
  return true;
}

static bool is_for_any(const hl_composer *composer, const char *text,
                       const hl_scene_description *description) {
  const char *rest;
  for (size_t v = 0; v < description->volume_count; v++)
    if (hl_text_is_for(composer, text, &description->volumes[v], v, &rest)) return true;
  return false;
}

/* Returns whether a value of "colormap" is for mesh number `index`: the value names the mesh, or the value
 * has no name and the picture has no volumes. *color: the text of the colour. */
static bool is_for_mesh(const hl_composer *composer, const char *text,
                        const hl_scene_description *description, size_t index, const char **color) {
  if (names_part(composer, text, part_of_mesh(&description->meshes[index], index), color)) return true;
  if (*color != NULL || description->volume_count > 0) return false;
  *color = text;
  return true;
}

static bool is_for_any_mesh(const hl_composer *composer, const char *text,
                            const hl_scene_description *description) {
  const char *rest;
  for (size_t m = 0; m < description->mesh_count; m++)
    if (is_for_mesh(composer, text, description, m, &rest)) return true;
  return false;
}

/* Adds a part's name to a text that lists names. The name is cut off where `names` has no more room. */
static void list_name(part part, char *names, size_t size) {
  char own[256];
  const size_t used = strlen(names);
  name_of(&part, own, sizeof own);
  snprintf(names + used, size - used, "%s%s", used > 0 ? ", " : "", own);
}

static void list_names(const hl_scene_description *description, bool with_meshes, char *names, size_t size) {
  names[0] = '\0';
  for (size_t v = 0; v < description->volume_count; v++)
    list_name(part_of_volume(&description->volumes[v], v), names, size);
  for (size_t m = 0; with_meshes && m < description->mesh_count; m++)
    list_name(part_of_mesh(&description->meshes[m], m), names, size);
}

hl_status hl_check_volume_name(const hl_composer *composer, hl_ask option, const char *text,
                               const hl_scene_description *description) {
  char names[600];
  if (is_for_any(composer, text, description)) return HL_OK;
  list_names(description, false, names, sizeof names);
  return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                 "--%s: '%.200s': no volume has the name before '=': there is %s",
                 hl_option_rows[option].name, text, names);
}

/* Refuses values with a NAME= that no volume has. many: the option may be given several times for one
 * volume. */
static hl_status check_names(const hl_composer *composer, hl_ask option, bool many,
                             const hl_scene_description *description) {
  char names[600];
  const hl_asked *given = &composer->asked[option];
  const char *name = hl_option_rows[option].name;
  list_names(description, false, names, sizeof names);
  for (int n = 0; n < given->count; n++) {
    const char *text = given->texts[n];
    const bool named = after_name(composer->context, text) != NULL;
    if (!named && given->count > 1 && !many)
      return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                     "--%s: '%.200s' beside another --%s: say whose each is, NAME=... (volumes: %s)", name,
                     text, name, names);
    if (option == HL_ASK_COLORMAP && is_for_any_mesh(composer, text, description)) continue;
    if (named && !is_for_any(composer, text, description)) {
      bool meshes = option == HL_ASK_COLORMAP && description->mesh_count > 0;
      list_names(description, meshes, names, sizeof names);
      return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                     "--%s: '%.200s': no volume%s has the name before '=': there is %s", name, text,
                     meshes ? " or mesh" : "", names);
    }
  }
  return HL_OK;
}

hl_status hl_check_volume_names(const hl_composer *composer, const hl_scene_description *description) {
  hl_status status = check_names(composer, HL_ASK_TF, false, description);
  if (status == HL_OK) status = check_names(composer, HL_ASK_COLORMAP, false, description);
  if (status == HL_OK) status = check_names(composer, HL_ASK_RANGE, false, description);
  if (status == HL_OK) status = check_names(composer, HL_ASK_THRESHOLD, false, description);
  return status == HL_OK ? check_names(composer, HL_ASK_ISO, true, description) : status;
}

bool hl_colors_meshes(const hl_composer *composer, const hl_scene_description *description) {
  const hl_asked *given = &composer->asked[HL_ASK_COLORMAP];
  for (int n = 0; n < given->count; n++)
    if (is_for_any_mesh(composer, given->texts[n], description)) return true;
  return false;
}

hl_status hl_color_meshes(const hl_composer *composer, const hl_scene_description *description,
                          hl_scene_mesh *meshes) {
  const hl_asked *given = &composer->asked[HL_ASK_COLORMAP];
  const char *color;
  for (int n = 0; n < given->count; n++)
    for (size_t m = 0; m < description->mesh_count; m++) {
      if (!is_for_mesh(composer, given->texts[n], description, m, &color) ||
          hl_parse_color(color, 0, 1, meshes[m].color) || is_for_any(composer, given->texts[n], description))
        continue;
      return hl_fail(
          composer->error, HL_ERROR_ARGUMENT,
          "--colormap: '%.200s': a mesh has one colour%s: give #rrggbb, linear R,G,B or a CSS name",
          given->texts[n], hl_find_colormap(color) != NULL ? " and no colour map" : "");
    }
  return HL_OK;
}

const char *hl_text_for(const hl_composer *composer, hl_ask option, const hl_scene_volume *volume,
                        size_t index) {
  const hl_asked *given = &composer->asked[option];
  const char *chosen = NULL, *rest;
  for (int n = 0; n < given->count; n++)
    if (hl_text_is_for(composer, given->texts[n], volume, index, &rest)) chosen = rest;
  return chosen;
}

bool hl_is_left_out(const hl_composer *composer, const hl_scene_description *description, size_t index) {
  static const hl_ask named[] = {HL_ASK_TF, HL_ASK_COLORMAP, HL_ASK_RANGE, HL_ASK_THRESHOLD, HL_ASK_ISO};
  const hl_scene_volume *volume = &description->volumes[index];
  bool values = false;
  for (size_t v = 0; v < description->volume_count; v++) values |= description->volumes[v].label_count == 0;
  if (volume->label_count == 0 || !values) return false;
  for (size_t k = 0; k < sizeof named / sizeof *named; k++) {
    const hl_asked *given = &composer->asked[named[k]];
    const char *rest;
    for (int n = 0; n < given->count; n++)
      if (hl_text_is_for(composer, given->texts[n], volume, index, &rest) && rest != given->texts[n])
        return false;
  }
  return true;
}

/* ---- colormaps in a list ---- */

/* Returns whether the value of "colormap" is a list, with a colormap or a colour for each volume. A text of
 * the form R,G,B is one colour, and no list. */
static bool is_list(const hl_composer *composer, const hl_asked *colormap) {
  double color[3];
  return colormap->count == 1 && strchr(colormap->text, ',') != NULL &&
         after_name(composer->context, colormap->text) == NULL &&
         !hl_parse_color(colormap->text, 0, 1, color);
}

static size_t count_items(const char *list) {
  size_t count = 1;
  for (; (list = strchr(list, ',')) != NULL; list++) count++;
  return count;
}

/* Copies the item of a list that belongs to volume number `index`. */
static hl_status copy_item(const hl_composer *composer, const hl_scene_description *description,
                           const char *list, size_t index, char *item, size_t size) {
  const size_t count = count_items(list);
  if (count != description->volume_count) {
    char names[600];
    list_names(description, false, names, sizeof names);
    return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                   "--colormap: '%.200s' has %zu names, and the picture has %zu volume%s (%s): give one name "
                   "for all, or as many as there are volumes",
                   list, count, description->volume_count, description->volume_count == 1 ? "" : "s", names);
  }
  for (; index > 0; index--) list = strchr(list, ',') + 1;
  const size_t length = strcspn(list, ",");
  snprintf(item, size, "%.*s", (int)(length < size ? length : size - 1), list);
  return HL_OK;
}

bool hl_has_colormap(const hl_composer *composer, const hl_scene_description *description, size_t index) {
  const hl_asked *colormap = &composer->asked[HL_ASK_COLORMAP];
  const char *text = hl_text_for(composer, HL_ASK_COLORMAP, &description->volumes[index], index);
  char item[256];
  if (text == NULL || !is_list(composer, colormap)) return text != NULL && hl_find_colormap(text) != NULL;
  return count_items(text) == description->volume_count &&
         copy_item(composer, description, text, index, item, sizeof item) == HL_OK &&
         hl_find_colormap(item) != NULL;
}

/* ---- functions ---- */

/* Logs that a preset for CT is fitted to values that are not Hounsfield units, such as values of MR. */
static void tell_of_units(const hl_composer *composer, const char *preset, const hl_volume *volume) {
  if (strncmp(preset, "ct-", 3) == 0 && !hl_is_hounsfield(volume))
    hl_log(composer->context, HL_LOG_INFO,
           "--tf %s is made for CT in Hounsfield units, which this file's values are not: it is fitted to "
           "their histogram (for MR there is --tf mr-brain)",
           preset);
}

/* Loads a function from its file. */
static hl_status load_named(const hl_composer *composer, const char *name, const hl_volume *volume,
                            hl_transfer_function *function) {
  if (strpbrk(name, "./") != NULL || hl_file_kind(composer->context, name) != 0)
    return hl_transfer_function_load_for(composer->context, name, volume, function, composer->error);
  return refuse_name("tf", name, "preset or file", "presets", preset_name, composer->error);
}

/* Loads the function that "tf" names. Functions of a preset are made for lengths in the volume's file, and
 * are scaled with the volume. */
static hl_status load_function(const hl_composer *composer, const char *name, const hl_scene_volume *volume,
                               hl_transfer_function *function) {
  const char *preset = find_known(name, preset_name);
  if (preset == NULL) return load_named(composer, name, volume->volume, function);
  tell_of_units(composer, preset, volume->volume);
  hl_status status = hl_transfer_function_preset(composer->context, preset, volume->volume, function,
                                                 composer->error);
  function->unit_distance *= fabs(volume->scale);
  return status;
}

/* Makes values below the threshold transparent. Values from the threshold on become nearly opaque: light is
 * absorbed within the length of a voxel's edge. Opacity rises on a ramp below the threshold, so that surfaces
 * are shaded without stairs. The ramp is a twentieth of the volume's range wide, but at most half the way
 * from the least value to the threshold. */
static hl_status make_opaque_from(const hl_composer *composer, const hl_scene_volume *volume,
                                  double threshold, hl_transfer_function *function) {
  enum { POINTS = 2 };
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume->volume, &info) != HL_OK)
    return hl_fail(composer->error, HL_ERROR_INTERNAL, "--threshold: the volume is not known");
  if (threshold > info.range[1] || threshold <= info.range[0])
    hl_log(composer->context, HL_LOG_WARNING,
           "--threshold %.9g: the volume's values go from %.9g to %.9g: %s", threshold, info.range[0],
           info.range[1], threshold > info.range[1] ? "nothing is opaque" : "everything is");
  hl_opacity_point *points = hl_reallocate(composer->context, (void *)function->opacity, POINTS,
                                           sizeof *points);
  if (points == NULL) return hl_fail_memory(composer->error, POINTS * sizeof *points, "a transfer function");
  double ramp = (info.range[1] - info.range[0]) / 20;
  if (threshold > info.range[0]) ramp = fmin(ramp, (threshold - info.range[0]) / 2);
  ramp = fmax(ramp, fabs(threshold) * 1e-9);
  points[0] = (hl_opacity_point){threshold - ramp, 0};
  points[1] = (hl_opacity_point){threshold, 0.95};
  function->opacity = points;
  function->opacity_count = POINTS;
  function->gradient_opacity_count = 0;
  function->unit_distance = fmin(fmin(info.spacing[0], info.spacing[1]), info.spacing[2]) *
                            fabs(volume->scale);
  return HL_OK;
}

/* Gives a function the points of the loaded function. If the loaded function has no opacity, the function
 * keeps its own. */
static hl_status replace(const hl_composer *composer, const hl_transfer_function *loaded,
                         hl_transfer_function *function) {
  hl_transfer_function both = *loaded, copy = {0};
  if (loaded->opacity == NULL && loaded->plane.second == HL_SECOND_NONE) {
    both.unit_distance = function->unit_distance;
    both.opacity = function->opacity;
    both.opacity_count = function->opacity_count;
    both.gradient_opacity = function->gradient_opacity;
    both.gradient_opacity_count = function->gradient_opacity_count;
  }
  hl_status status = hl_transfer_function_copy(composer->context, &both, &copy, composer->error);
  if (status != HL_OK) return status;
  hl_transfer_function_release(composer->context, function);
  *function = copy;
  return HL_OK;
}

/* The range that "range" and "range-scale" give a volume. */
typedef struct value_range {
  bool given;
  double ends[2];
  hl_range_scale scale;
} value_range;

/* Finds the range of a volume. text: the value of "range" for the volume, without NAME=; null if "range" has
 * no value for the volume. */
static hl_status find_range(const hl_composer *composer, const hl_volume *volume, const char *text,
                            value_range *range) {
  const hl_asked *scale = &composer->asked[HL_ASK_RANGE_SCALE];
  hl_asked said;
  *range = (value_range){.given = text != NULL};
  if (scale->given) range->scale = (hl_range_scale)scale->choice;
  if (text == NULL || !hl_row_numbers(&hl_option_rows[HL_ASK_RANGE], text, &said)) return HL_OK;
  for (int n = 0; n < 2; n++) {
    range->ends[n] = said.number[n];
    hl_status status = said.percent[n] ? hl_volume_percentiles(volume, &said.number[n], 1, &range->ends[n],
                                                               composer->error)
                                       : HL_OK;
    if (status != HL_OK) return hl_blame_options(status);
  }
  if (!(range->ends[0] < range->ends[1]))
    return hl_fail(composer->error, HL_ERROR_INPUT,
                   "--range: '%s': these values of the volume are %.9g and %.9g: LO must be below HI", text,
                   range->ends[0], range->ends[1]);
  return HL_OK;
}

/* Spreads a function over the range that "range" gives. */
static hl_status spread(const hl_composer *composer, const hl_volume *volume, const value_range *range,
                        hl_spread_use use, hl_transfer_function *function) {
  hl_transfer_function moved = {0};
  hl_status status = hl_transfer_function_spread_over(composer->context, volume, function, range->ends,
                                                      range->scale, use, &moved, composer->error);
  if (status == HL_OK) status = replace(composer, &moved, function);
  hl_transfer_function_release(composer->context, &moved);
  return hl_blame_options(status);
}

/* The use of a single colour that an option gives a volume. */
typedef enum plain_color {
  PLAIN_EVEN,  /* all values have the colour */
  PLAIN_RAMP,  /* in a maximum projection: the colours go from black to the given colour */
  PLAIN_BESIDE /* in one of several maximum projections: the colours go from the background's colour to the
                * given colour */
} plain_color;

/* Gives all values one colour. */
static hl_status color_plainly(const hl_composer *composer, const double color[3], plain_color use,
                               const double range[2], hl_transfer_function *function) {
  hl_color_point points[HL_RAMP_POINTS];
  const size_t count = hl_projection_ramp(composer, color, range, use == PLAIN_BESIDE, points);
  const hl_transfer_function colors = {.color = use == PLAIN_EVEN ? &points[count - 1] : points,
                                       .color_count = use == PLAIN_EVEN ? 1 : count};
  return replace(composer, &colors, function);
}

/* Gives a function the colours of a colormap, or a colour by its name. Without a range the colours spread
 * over the visible values. */
static hl_status color_by_name(const hl_composer *composer, const char *name, const hl_volume *volume,
                               value_range range, plain_color use, hl_transfer_function *function) {
  hl_transfer_function colors = {0};
  double color[3];
  const char *map = hl_find_colormap(name);
  if (map == NULL && !hl_parse_color(name, 0, 1, color))
    return refuse_name("colormap", name, "colormap and no colour", "colormaps", colormap_name,
                       composer->error);
  hl_status status = range.given
                         ? HL_OK
                         : hl_transfer_function_seen_range(volume, function, range.ends, composer->error);
  if (status == HL_OK && map == NULL) return color_plainly(composer, color, use, range.ends, function);
  if (status == HL_OK)
    status = hl_transfer_function_colormap_scaled(composer->context, map, range.ends, range.scale, &colors,
                                                  composer->error);
  if (status == HL_OK) status = replace(composer, &colors, function);
  hl_transfer_function_release(composer->context, &colors);
  return hl_blame_options(status);
}

bool hl_asks_for_functions(const hl_asked *asked) {
  return asked[HL_ASK_TF].given || asked[HL_ASK_COLORMAP].given || asked[HL_ASK_RANGE].given ||
         asked[HL_ASK_THRESHOLD].given;
}

/* The values of options that change one volume's transfer function, without NAME=; each is null if no value
 * is for the volume. */
typedef struct function_changes {
  const char *range, *threshold, *colormap;
  bool windows_faces; /* whether "range" is the window of cut faces */
  bool is_beside;     /* whether other volumes are in the scene */
} function_changes;

/* Applies "range", "threshold" and "colormap", in this order. stated: receives the ends of "range"; 0 and 0
 * if "range" is not given. */
static hl_status change_function(const hl_composer *composer, const hl_scene_volume *described,
                                 const function_changes *changes, bool maximum,
                                 hl_transfer_function *function, double stated[2]) {
  const hl_volume *volume = described->volume;
  const char *colormap = changes->colormap;
  const bool mapped = colormap != NULL && hl_find_colormap(colormap) != NULL;
  const hl_spread_use use = maximum ? HL_SPREAD_PROJECTION : mapped ? HL_SPREAD_COLORMAP : HL_SPREAD_ALONE;
  value_range range;
  hl_asked threshold;
  hl_status status = find_range(composer, volume, changes->range, &range);
  memcpy(stated, range.ends, sizeof range.ends);
  if (status == HL_OK && changes->windows_faces)
    return hl_window_faces(composer, volume, range.ends, function);
  if (status == HL_OK && range.given && changes->threshold == NULL)
    status = spread(composer, volume, &range, use, function);
  if (status == HL_OK && changes->threshold != NULL &&
      hl_row_numbers(&hl_option_rows[HL_ASK_THRESHOLD], changes->threshold, &threshold))
    status = make_opaque_from(composer, described, threshold.number[0], function);
  if (status == HL_OK && colormap != NULL)
    status = color_by_name(composer, colormap, volume, range,
                           !maximum             ? PLAIN_EVEN
                           : changes->is_beside ? PLAIN_BESIDE
                                                : PLAIN_RAMP,
                           function);
  return status;
}

hl_status hl_compose_function(const hl_composer *composer, const hl_scene_description *description,
                              size_t index, const char *color, hl_transfer_function *function,
                              double range[2]) {
  const hl_asked *asked = composer->asked;
  const hl_scene_volume *volume = &description->volumes[index];
  const char *named = hl_text_for(composer, HL_ASK_TF, volume, index);
  function_changes changes = {hl_text_for(composer, HL_ASK_RANGE, volume, index),
                              hl_text_for(composer, HL_ASK_THRESHOLD, volume, index),
                              hl_text_for(composer, HL_ASK_COLORMAP, volume, index), false,
                              description->volume_count > 1};
  char item[256];
  hl_status status = HL_OK;
  range[0] = range[1] = 0;
  if (is_list(composer, &asked[HL_ASK_COLORMAP])) {
    status = copy_item(composer, description, changes.colormap, index, item, sizeof item);
    changes.colormap = item[0] != '\0' ? item : NULL; /* the list ",hot" gives the first volume no colormap */
  }
  if (changes.colormap == NULL) changes.colormap = color;
  char window[HL_SLICE_TEXT];
  const bool slice = asked[HL_ASK_SLICE].given;
  if (slice && named == NULL && changes.range == NULL && hl_slice_range(volume->volume, window))
    changes.range = window;
  if (status == HL_OK)
    status = hl_transfer_function_copy(composer->context, &volume->transfer_function, function,
                                       composer->error);
  if (status == HL_OK && named != NULL) {
    hl_transfer_function loaded = {0};
    status = load_function(composer, named, volume, &loaded);
    if (status == HL_OK) status = replace(composer, &loaded, function);
    hl_transfer_function_release(composer->context, &loaded);
  }
  if (status == HL_OK && changes.range != NULL)
    status = hl_windows_faces(composer, description, index, &changes.windows_faces);
  if (status != HL_OK) return status;
  if (function->plane.second == HL_SECOND_NONE)
    return change_function(composer, volume, &changes, slice || hl_is_maximum(composer, description),
                           function, range);
  if (changes.range == NULL && changes.threshold == NULL && changes.colormap == NULL) return HL_OK;
  return hl_fail(composer->error, HL_ERROR_ARGUMENT,
                 "--range, --threshold and --colormap change functions of the value alone: "
                 "change the boxes, polygons or image of this one");
}
