/* cli/render_colors.c - looks (--look), and transfer functions by --tf, --colormap, --range and --threshold.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "input.h"
#include "render.h"
#include "suggest.h"

static const char *preset_name(const void *data, size_t index) {
  (void)data;
  return hl_preset_name(index);
}

static const char *colormap_name(const void *data, size_t index) {
  (void)data;
  return hl_colormap_name(index);
}

static bool is_known(const char *name, const char *(*known)(const void *, size_t)) {
  const char *candidate;
  for (size_t i = 0; (candidate = known(NULL, i)) != NULL; i++)
    if (strcmp(candidate, name) == 0) return true;
  return false;
}

static int refuse_name(const char *option, const char *name, const char *kind, const char *topic,
                       const char *(*known)(const void *, size_t)) {
  const char *meant = nearest_name(name, known, NULL);
  if (meant != NULL)
    return fail(EXIT_CODE_USAGE, "--%s: '%s' is no %s: did you mean %s?", option, name, kind, meant);
  return fail(EXIT_CODE_USAGE, "--%s: '%s' is no %s: see 'halflight help %s'", option, name, kind, topic);
}

/* ---- names ---- */

void render_volume_name(const hl_scene_volume *volume, size_t index, char *name, size_t size) {
  if (volume->name != NULL) {
    snprintf(name, size, "%s", volume->name);
  } else if (volume->file != NULL) {
    const char *base = base_name(volume->file), *dot = strchr(base + (base[0] == '.'), '.');
    snprintf(name, size, "%.*s", dot != NULL ? (int)(dot - base) : (int)strlen(base), base);
  } else {
    snprintf(name, size, "volume%zu", index + 1);
  }
}

const char *render_after_name(const char *text) {
  const char *equals = strchr(text, '=');
  return equals == NULL || access(text, F_OK) == 0 ? NULL : equals + 1;
}

bool render_is_for(const char *text, const char *name) {
  const char *rest = render_after_name(text);
  size_t length = strlen(name);
  return rest == NULL || (length == (size_t)(rest - text) - 1 && memcmp(name, text, length) == 0);
}

static bool is_for_any(const char *text, const hl_scene_description *description) {
  for (size_t v = 0; v < description->volume_count; v++) {
    char own[256];
    render_volume_name(&description->volumes[v], v, own, sizeof own);
    if (render_is_for(text, own)) return true;
  }
  return false;
}

static void list_names(const hl_scene_description *description, char *names, size_t size) {
  size_t used = 0;
  names[0] = '\0';
  for (size_t v = 0; v < description->volume_count && used < size; v++) {
    char own[256];
    render_volume_name(&description->volumes[v], v, own, sizeof own);
    used += (size_t)snprintf(names + used, size - used, "%s%s", v > 0 ? ", " : "", own);
  }
}

/* many: the option may be given several times for one volume. */
static int check_names(const char *option, const cli_value *given, bool many,
                       const hl_scene_description *description) {
  char names[600];
  list_names(description, names, sizeof names);
  for (int n = 0; n < given->count; n++) {
    const char *text = given->texts[n];
    if (render_after_name(text) == NULL && given->count > 1 && !many)
      return fail(EXIT_CODE_USAGE,
                  "--%s: '%s' beside another --%s: say whose each is, NAME=... (volumes: %s)", option, text,
                  option, names);
    if (render_after_name(text) != NULL && !is_for_any(text, description))
      return fail(EXIT_CODE_USAGE, "--%s: '%s': no volume has the name before '=': there is %s", option, text,
                  names);
  }
  return EXIT_CODE_OK;
}

int render_check_names(const cli_value *values, const hl_scene_description *description) {
  int exit_code = check_names("tf", &values[RENDER_TF], false, description);
  if (exit_code == EXIT_CODE_OK)
    exit_code = check_names("colormap", &values[RENDER_COLORMAP], false, description);
  return exit_code == EXIT_CODE_OK ? check_names("iso", &values[RENDER_ISO], true, description) : exit_code;
}

/* The value that a repeatable option gives one volume, the last one if there are several; null: none. */
static const char *said_of(const cli_value *given, const hl_scene_volume *volume, size_t index) {
  char own[256];
  const char *chosen = NULL;
  render_volume_name(volume, index, own, sizeof own);
  for (int n = 0; n < given->count; n++) {
    const char *text = given->texts[n], *rest = render_after_name(text);
    if (render_is_for(text, own)) chosen = rest != NULL ? rest : text;
  }
  return chosen;
}

/* ---- functions ---- */

static int load_function(cli_host *host, const char *name, const hl_volume *volume,
                         hl_transfer_function *function) {
  hl_error error = {0};
  hl_status status;
  if (is_known(name, preset_name))
    status = hl_transfer_function_preset(host->context, name, volume, function, &error);
  else if (strpbrk(name, "./") != NULL || access(name, F_OK) == 0)
    status = hl_transfer_function_load_for(host->context, name, volume, function, &error);
  else return refuse_name("tf", name, "preset or file", "presets", preset_name);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}

/* Makes values clear below the threshold and nearly opaque, over a voxel's edge, from it on. A ramp below the
 * threshold lets surfaces be shaded without stairs. It is a twentieth of the volume's range wide, but at most
 * half the way from the least value to the threshold. */
static int make_opaque_from(const cli_host *host, const hl_volume *volume, double threshold,
                            hl_transfer_function *function) {
  enum { POINTS = 2 };
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume, &info) != HL_OK)
    return fail(EXIT_CODE_FAILURE, "--threshold: the volume is not known");
  if (!host->quiet && (threshold > info.range[1] || threshold <= info.range[0]))
    warn("--threshold %.9g: the volume's values go from %.9g to %.9g: %s", threshold, info.range[0],
         info.range[1], threshold > info.range[1] ? "nothing is opaque" : "everything is");
  hl_opacity_point *points = realloc((void *)function->opacity, POINTS * sizeof *points);
  if (points == NULL) return fail(EXIT_CODE_FAILURE, "out of memory for a transfer function");
  double ramp = (info.range[1] - info.range[0]) / 20;
  if (threshold > info.range[0]) ramp = fmin(ramp, (threshold - info.range[0]) / 2);
  ramp = fmax(ramp, fabs(threshold) * 1e-9);
  points[0] = (hl_opacity_point){threshold - ramp, 0};
  points[1] = (hl_opacity_point){threshold, 0.95};
  function->opacity = points;
  function->opacity_count = POINTS;
  function->gradient_opacity_count = 0;
  function->unit_distance = fmin(fmin(info.spacing[0], info.spacing[1]), info.spacing[2]);
  return EXIT_CODE_OK;
}

static void *copy_points(const void *points, size_t bytes) {
  void *copy = malloc(bytes + 1);
  if (copy != NULL && bytes > 0) memcpy(copy, points, bytes);
  return copy;
}

/* Copies the points; the copies are owned by the caller (render_release_function). */
static int copy_function(const hl_transfer_function *from, hl_transfer_function *to) {
  *to = *from;
  to->opacity = copy_points(from->opacity, from->opacity_count * sizeof *from->opacity);
  to->color = copy_points(from->color, from->color_count * sizeof *from->color);
  to->gradient_opacity = copy_points(from->gradient_opacity,
                                     from->gradient_opacity_count * sizeof *from->gradient_opacity);
  bool plane = render_copy_plane(&from->plane, &to->plane);
  return to->opacity != NULL && to->color != NULL && to->gradient_opacity != NULL && plane
             ? EXIT_CODE_OK
             : fail(EXIT_CODE_FAILURE, "out of memory for a transfer function");
}

void render_release_function(hl_transfer_function *function) {
  free((void *)function->opacity);
  free((void *)function->color);
  free((void *)function->gradient_opacity);
  render_release_plane(&function->plane);
}

/* Gives a function the points of `loaded`. Its own opacity is kept if `loaded` has none. */
static int replace(const hl_transfer_function *loaded, hl_transfer_function *function) {
  hl_transfer_function old = *function, copy;
  hl_transfer_function both = *loaded;
  if (loaded->opacity == NULL && loaded->plane.second == HL_SECOND_NONE) {
    both.unit_distance = old.unit_distance;
    both.opacity = old.opacity;
    both.opacity_count = old.opacity_count;
    both.gradient_opacity = old.gradient_opacity;
    both.gradient_opacity_count = old.gradient_opacity_count;
  }
  int exit_code = copy_function(&both, &copy);
  render_release_function(&old);
  *function = copy;
  return exit_code;
}

/* What --range and --range-scale say of a volume. */
typedef struct value_range {
  bool given;
  double ends[2];
  hl_range_scale scale;
} value_range;

static int find_range(cli_host *host, const cli_value *values, const hl_volume *volume, value_range *range) {
  const cli_value *said = &values[RENDER_RANGE], *scale = &values[RENDER_RANGE_SCALE];
  hl_error error = {0};
  *range = (value_range){.given = said->given};
  if (scale->given) range->scale = (hl_range_scale)scale->choice;
  for (int n = 0; said->given && n < 2; n++) {
    range->ends[n] = said->number[n];
    hl_status status = said->percent[n]
                           ? hl_volume_percentiles(volume, &said->number[n], 1, &range->ends[n], &error)
                           : HL_OK;
    if (status != HL_OK) return host_fail(host, PHASE_CHANGE, status, &error);
  }
  if (said->given && !(range->ends[0] < range->ends[1]))
    return fail(EXIT_CODE_INPUT,
                "--range: '%s': these values of the volume are %.9g and %.9g: LO must be below HI",
                said->text, range->ends[0], range->ends[1]);
  return EXIT_CODE_OK;
}

/* Moves the points so that the values that have opacity become those of the range. */
static int spread(cli_host *host, const hl_volume *volume, const value_range *range,
                  hl_transfer_function *function) {
  hl_error error = {0};
  hl_transfer_function moved;
  double visible[2];
  hl_status status = hl_transfer_function_visible_range(volume, function, visible, &error);
  if (status == HL_OK)
    status = hl_transfer_function_spread(host->context, function, visible, range->ends, range->scale, &moved,
                                         &error);
  if (status != HL_OK) return host_fail(host, PHASE_CHANGE, status, &error);
  int exit_code = replace(&moved, function);
  hl_transfer_function_release(host->context, &moved);
  return exit_code;
}

/* Gives all values one colour. ramp, for maximum projections: from black at range[0] to this colour at
 * range[1]. */
static int color_plainly(const double color[3], bool ramp, const double range[2],
                         hl_transfer_function *function) {
  hl_color_point points[2] = {{range[0], {0}}, {range[1], {0}}};
  for (int c = 0; c < 3; c++) points[1].color[c] = color[c];
  const hl_transfer_function colors = {.color = ramp ? points : points + 1, .color_count = ramp ? 2 : 1};
  return replace(&colors, function);
}

/* Colours by a colormap or a colour's name. Without a range they spread over the values that are seen. */
static int color_by_name(cli_host *host, const char *name, const hl_volume *volume, value_range range,
                         bool maximum, hl_transfer_function *function) {
  hl_transfer_function colors = {0};
  hl_error error = {0};
  double color[3];
  bool known = is_known(name, colormap_name);
  if (!known && !parse_color(name, 0, 1, color))
    return refuse_name("colormap", name, "colormap and no colour", "colormaps", colormap_name);
  hl_status status = range.given ? HL_OK
                                 : hl_transfer_function_seen_range(volume, function, range.ends, &error);
  if (status == HL_OK && !known) return color_plainly(color, maximum, range.ends, function);
  if (status == HL_OK)
    status = hl_transfer_function_colormap_scaled(host->context, name, range.ends, range.scale, &colors,
                                                  &error);
  if (status != HL_OK) return host_fail(host, PHASE_CHANGE, status, &error);
  int exit_code = replace(&colors, function);
  hl_transfer_function_release(host->context, &colors);
  return exit_code;
}

bool render_recolors(const cli_value *values) {
  return values[RENDER_TF].given || values[RENDER_COLORMAP].given || values[RENDER_RANGE].given ||
         values[RENDER_THRESHOLD].given;
}

/* ---- looks ---- */

enum { LOOK_AUTO, LOOK_SURFACE, LOOK_TRANSLUCENT, LOOK_XRAY, LOOK_SMOKE, LOOK_VESSELS, LOOK_MIP };

/* The library's looks, and the maximum projection. */
const cli_choice look_choices[] = {{"auto", LOOK_AUTO},
                                   {"surface", LOOK_SURFACE},
                                   {"translucent", LOOK_TRANSLUCENT},
                                   {"xray", LOOK_XRAY},
                                   {"smoke", LOOK_SMOKE},
                                   {"vessels", LOOK_VESSELS},
                                   {"mip", LOOK_MIP},
                                   {NULL, 0}};

static bool is_mip(const cli_value *values) {
  return values[RENDER_LOOK].given && values[RENDER_LOOK].choice == LOOK_MIP;
}

bool render_channel_color(const cli_value *values, const hl_scene_description *description, size_t index,
                          char color[8]) {
  double srgb[3];
  const hl_scene_volume *volume = &description->volumes[index];
  bool alone = description->volume_count < 2, named = said_of(&values[RENDER_TF], volume, index) != NULL;
  if (alone || named || !is_mip(values) || hl_scene_channel_color(description, index, srgb) != HL_OK)
    return false;
  snprintf(color, 8, "#%02x%02x%02x", (unsigned)lround(255 * srgb[0]) & 255U,
           (unsigned)lround(255 * srgb[1]) & 255U, (unsigned)lround(255 * srgb[2]) & 255U);
  return true;
}

int render_transfer_function(cli_host *host, const cli_value *values, const hl_scene_description *description,
                             size_t index, const char *color, hl_transfer_function *function) {
  const hl_scene_volume *volume = &description->volumes[index];
  const char *named = said_of(&values[RENDER_TF], volume, index);
  const char *colormap = said_of(&values[RENDER_COLORMAP], volume, index);
  if (colormap == NULL) colormap = color;
  int exit_code = copy_function(&volume->transfer_function, function);
  if (exit_code == EXIT_CODE_OK && named != NULL) {
    hl_transfer_function loaded = {0};
    exit_code = load_function(host, named, volume->volume, &loaded);
    if (exit_code == EXIT_CODE_OK) exit_code = replace(&loaded, function);
    hl_transfer_function_release(host->context, &loaded);
  }
  if (exit_code != EXIT_CODE_OK) return exit_code;
  if (function->plane.second != HL_SECOND_NONE)
    return values[RENDER_RANGE].given || values[RENDER_THRESHOLD].given || colormap != NULL
               ? fail(EXIT_CODE_USAGE,
                      "--range, --threshold and --colormap change functions of the value alone: "
                      "change the boxes, polygons or image of this one")
               : EXIT_CODE_OK;
  value_range range;
  exit_code = find_range(host, values, volume->volume, &range);
  if (exit_code == EXIT_CODE_OK && range.given && !values[RENDER_THRESHOLD].given)
    exit_code = spread(host, volume->volume, &range, function);
  if (exit_code == EXIT_CODE_OK && values[RENDER_THRESHOLD].given)
    exit_code = make_opaque_from(host, volume->volume, values[RENDER_THRESHOLD].number[0], function);
  if (exit_code == EXIT_CODE_OK && colormap != NULL)
    exit_code = color_by_name(host, colormap, volume->volume, range, render_is_maximum(values, description),
                              function);
  return exit_code;
}

const char *render_look_name(const cli_value *values) {
  if (!values[RENDER_LOOK].given || is_mip(values)) return NULL;
  for (const cli_choice *choice = look_choices; choice->name != NULL; choice++)
    if (choice->value == values[RENDER_LOOK].choice) return choice->name;
  return NULL;
}

/* Bare volumes are made with their look; a scene's transfer functions stay in a maximum projection. */
bool render_look_recolors(const cli_value *values, bool bare) {
  return values[RENDER_LOOK].given && is_mip(values) == bare;
}

hl_status render_look_volume(cli_host *host, const cli_value *values, hl_scene_volume *volume,
                             hl_error *error) {
  hl_transfer_function function = {0};
  const char *name = render_look_name(values);
  hl_shading shading = volume->shading;
  hl_status status = name == NULL
                         ? hl_transfer_function_preset(host->context, "mip", volume->volume, &function, error)
                         : hl_transfer_function_look(host->context, name, volume->volume, &function, &shading,
                                                     error);
  if (status != HL_OK) return status;
  volume->transfer_function = function;
  if (!values[RENDER_SHADING].given && values[RENDER_LOOK].choice != LOOK_AUTO) volume->shading = shading;
  return HL_OK;
}

void render_change_look(const cli_value *values, bool bare, hl_scene_description *description) {
  if (!values[RENDER_LOOK].given) return;
  description->render.compositing = is_mip(values) ? HL_COMPOSITING_MAXIMUM : HL_COMPOSITING_LIGHT;
  for (int c = 0; c < 3 && bare && is_mip(values); c++) description->background[c] = 0;
}

bool render_is_maximum(const cli_value *values, const hl_scene_description *description) {
  if (values[RENDER_LOOK].given) return is_mip(values);
  return description->render.compositing == HL_COMPOSITING_MAXIMUM;
}

/* Options that have no effect in a picture without light. */
static const enum render_option of_light[] = {
    RENDER_LIGHT,         RENDER_LIGHT_SIZE,    RENDER_SHADOWS,
    RENDER_SOFT_METHOD,   RENDER_LIGHT_SAMPLES, RENDER_SHADOW_RESOLUTION,
    RENDER_SHADOW_LOOKUP, RENDER_AMBIENT,       RENDER_SHADING};

bool render_warn_of_no_light(const cli_value *values, const hl_scene_description *description) {
  bool maximum = description->render.compositing == HL_COMPOSITING_MAXIMUM;
  bool flat = values[RENDER_SHADING].given && values[RENDER_SHADING].choice == HL_SHADING_FLAT;
  for (size_t n = 0; n < sizeof of_light / sizeof *of_light && (maximum || flat); n++)
    if (values[of_light[n]].given && (maximum || of_light[n] != RENDER_SHADING))
      warn("--%s changes nothing: %s without light", render_options[of_light[n]].name,
           maximum ? "a maximum projection is" : "flat colours are");
  return maximum || flat;
}
