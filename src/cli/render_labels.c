/* cli/render_labels.c - --labels, --mask, --label-table and --show of `halflight render`: a label map among
 * the volumes, over them, or the volume itself as one. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "input.h"
#include "render.h"
#include "suggest.h"
#include "text/plain.h"

/* One of the labels that --show names: NAME|NUMBER|all|rest[=COLOR][:OPACITY]. */
typedef struct shown_label {
  char name[128], whole[128]; /* whole: all of the text, which may be a name with ":" or "=" in it */
  const char *wrong;          /* what to do about it unless it is a name; null: nothing */
  bool all, colored, found;
  double color[3], opacity;
} shown_label;

enum { MOST_SHOWN = 512 };

typedef struct show_list {
  shown_label labels[MOST_SHOWN];
  size_t count;
} show_list;

static int fail_show(const char *item, const char *mend) {
  return fail(EXIT_CODE_USAGE, "--show \"%.100s\": %s", item, mend);
}

/* Reads one item, of `length` characters. */
static int read_item(const char *item, size_t length, shown_label *made) {
  *made = (shown_label){.opacity = 1};
  if (length == 0 || length >= sizeof made->name)
    return fail_show(item, "give labels by name or number, with commas between them: liver,tumour=red:0.5");
  memcpy(made->name, item, length);
  made->name[length] = 0;
  memcpy(made->whole, made->name, length + 1);
  char *colon = strrchr(made->name, ':'), *rest;
  if (colon != NULL) {
    made->opacity = hl_plain_number(colon + 1, &rest);
    if (colon[1] == 0 || *rest != 0 || !(made->opacity >= 0 && made->opacity <= 1))
      made->wrong = "give an opacity from 0 to 1 after the colon";
    *colon = 0;
  }
  char *equals = strrchr(made->name, '=');
  if (equals != NULL) {
    *equals = 0;
    made->colored = true;
    if (!parse_color(equals + 1, 0, 1, made->color)) made->wrong = "give #rrggbb or a CSS name after \"=\"";
  }
  made->all = strcmp(made->name, "all") == 0;
  return EXIT_CODE_OK;
}

static int read_show(const cli_value *value, show_list *list) {
  list->count = 0;
  for (int n = 0; n < value->count; n++)
    for (const char *item = value->texts[n]; item != NULL;) {
      const char *comma = strchr(item, ',');
      size_t length = comma != NULL ? (size_t)(comma - item) : strlen(item);
      if (list->count == MOST_SHOWN) return fail_show(item, "names too many labels");
      int exit_code = read_item(item, length, &list->labels[list->count++]);
      if (exit_code != EXIT_CODE_OK) return exit_code;
      item = comma != NULL ? comma + 1 : NULL;
    }
  return EXIT_CODE_OK;
}

static bool is_whole(const hl_label *label, const shown_label *shown) {
  return label->name != NULL && strcmp(label->name, shown->whole) == 0;
}

static bool is_named(const hl_label *label, const shown_label *shown) {
  char *rest;
  if (is_whole(label, shown)) return true;
  if (shown->wrong != NULL) return false;
  double number = hl_plain_number(shown->name, &rest);
  return shown->all || (label->name != NULL && strcmp(label->name, shown->name) == 0) ||
         (*rest == 0 && rest != shown->name && number == label->value);
}

/* Shows those labels that the list names, if it names any. "all" leaves those hidden that a table hides. */
static void apply_show(show_list *list, hl_label *labels, size_t count) {
  for (size_t n = 0; n < count && list->count > 0; n++) {
    const bool hidden = !labels[n].visible;
    labels[n].visible = 0;
    for (size_t s = 0; s < list->count; s++) {
      shown_label *shown = &list->labels[s];
      if (!is_named(&labels[n], shown) || (shown->all && hidden)) continue;
      const bool whole = is_whole(&labels[n], shown);
      shown->found = true;
      labels[n].visible = 1;
      labels[n].opacity = whole ? 1 : shown->opacity;
      if (!shown->colored || whole) continue;
      memcpy(labels[n].color, shown->color, sizeof labels[n].color);
      labels[n].tint = 1; /* in a mask */
    }
  }
}

static const char *name_of_label(const void *data, size_t index) {
  const render_label_layers *layers = data;
  for (size_t layer = 0; layer < layers->count; layer++) {
    const hl_scene_volume *volume = &layers->volumes[layer];
    if (index < volume->label_count)
      return volume->labels[index].name != NULL ? volume->labels[index].name : "";
    index -= volume->label_count;
  }
  return NULL;
}

/* The labels that there are, by name or else by value: "liver, tumour, 7"; the last words tell how many more.
 */
static void list_labels(const render_label_layers *layers, char *text, size_t size) {
  enum { LISTED = 12 };
  size_t used = 0, count = 0;
  text[0] = '\0';
  for (size_t n = 0; n < layers->count; n++)
    for (size_t l = 0; l < layers->volumes[n].label_count; l++, count++) {
      const hl_label *label = &layers->volumes[n].labels[l];
      bool named = label->name != NULL && label->name[0] != '\0';
      if (count >= LISTED || used + 100 > size) continue;
      used += (size_t)(named
                           ? snprintf(text + used, size - used, "%s%.60s", count > 0 ? ", " : "", label->name)
                           : snprintf(text + used, size - used, "%s%.20g", count > 0 ? ", " : "",
                                      label->value));
    }
  if (count > LISTED)
    snprintf(text + used, size - used, " and %zu more: see 'halflight info'", count - LISTED);
}

static int check_found(const show_list *list, const render_label_layers *layers) {
  for (size_t s = 0; s < list->count; s++) {
    if (list->labels[s].found) continue;
    if (list->labels[s].wrong != NULL) return fail_show(list->labels[s].whole, list->labels[s].wrong);
    if (list->labels[s].all) continue;
    const char *near = nearest_name(list->labels[s].name, name_of_label, layers);
    if (near != NULL)
      return fail(EXIT_CODE_USAGE, "--show: there is no label \"%.100s\": did you mean \"%.100s\"?",
                  list->labels[s].name, near);
    char known[1000];
    list_labels(layers, known, sizeof known);
    return fail(EXIT_CODE_USAGE, "--show: there is no label \"%.100s\": there is %s", list->labels[s].name,
                known[0] != '\0' ? known : "none");
  }
  return EXIT_CODE_OK;
}

/* How many layers the volume's file has: components that are neither time steps nor channels. */
static size_t layers_of(const hl_volume *volume) {
  hl_volume_selection read = {.struct_size = sizeof read};
  if (hl_volume_get_selection(volume, &read) == HL_OK && (read.times > 1 || read.channels > 1)) return 1;
  for (size_t n = 0; n < hl_volume_array_count(volume); n++) {
    hl_volume_array array = {.struct_size = sizeof array};
    if (hl_volume_get_array(volume, n, &array) == HL_OK && array.chosen) return array.components;
  }
  return 1;
}

/* Loads one layer and its labels. reading: how the file is read; the layer is its component. */
static hl_status load_layer(hl_context *context, const char *file, const char *table,
                            const hl_volume_load_options *reading, render_label_layers *layers,
                            hl_error *error) {
  hl_volume_load_options options = *reading;
  if (options.time < 0 && options.channel < 0) options.component = (int)layers->count;
  hl_scene_volume *made = &layers->volumes[layers->count];
  hl_scene_volume_defaults(made);
  const int none = made->component;
  hl_status status = hl_volume_load_with(context, file, &options, &made->volume, error);
  if (status != HL_OK) return status;
  layers->count++;
  made->file = file;
  input_name_source(&options, made);
  if (layers_of(made->volume) < 2) made->component = none;
  hl_label *labels = NULL;
  status = hl_labels_of_volume(context, made->volume, table, &labels, &made->label_count, error);
  made->labels = labels;
  return status;
}

void render_release_label_layers(hl_context *context, render_label_layers *layers) {
  for (size_t n = 0; n < layers->count; n++) {
    hl_labels_release(context, (hl_label *)layers->volumes[n].labels);
    hl_volume_release(layers->volumes[n].volume);
  }
  layers->count = 0;
}

/* Makes a scene of the scene's volumes, the first `kept` of them, and the layers. */
static hl_status add_layers(hl_context *context, const render_label_layers *layers, size_t kept, bool bare,
                            hl_scene **scene, hl_error *error) {
  hl_scene_description description = *hl_scene_describe(*scene);
  hl_scene_volume *volumes = calloc(kept + layers->count, sizeof *volumes);
  hl_scene *made = NULL;
  if (volumes == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory: %zu volumes", kept + layers->count);
    return error->code = HL_ERROR_MEMORY;
  }
  if (kept > 0) memcpy(volumes, description.volumes, kept * sizeof *volumes);
  description.volume_count = kept;
  for (size_t n = 0; n < layers->count; n++)
    if (layers->volumes[n].label_count > 0) volumes[description.volume_count++] = layers->volumes[n];
  description.volumes = volumes;
  /* smooth labels are splines' coefficients; numbers of labels, which the scene was made for, take no spline
   */
  if (bare && description.render.kernel == HL_KERNEL_LINEAR) description.render.kernel = HL_KERNEL_BSPLINE;
  hl_status status = hl_scene_create(context, &description, &made, error);
  if (status == HL_OK && bare) {
    description = *hl_scene_describe(made); /* labels have become transfer functions */
    status = render_frame_anew(&description, error);
    hl_scene *framed = NULL;
    if (status == HL_OK) status = hl_scene_create(context, &description, &framed, error);
    hl_scene_release(made);
    made = framed;
  }
  free(volumes);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = made;
  return HL_OK;
}

/* The file of --labels, or else of the scene's only, bare volume, which the label map then replaces: *kept,
 * the number of volumes that stay. Null, with a message: there is none. */
static const char *file_of_labels(const cli_value *values, bool bare, const hl_scene_description *description,
                                  size_t *kept) {
  *kept = description->volume_count;
  if (values[RENDER_LABELS].given) return values[RENDER_LABELS].text;
  if (bare && *kept == 1 && description->volumes[0].file != NULL) {
    *kept = 0;
    return description->volumes[0].file;
  }
  (void)fail(EXIT_CODE_USAGE, "--%s is for a label map: give its file as --labels FILE, or alone as INPUT",
             values[RENDER_SHOW].given ? "show" : "label-table");
  return NULL;
}

/* The anatomical space of the scene's first volume, which label maps are turned into. */
static hl_space space_of(const hl_scene_description *description, size_t kept) {
  hl_volume_info info = {.struct_size = sizeof info};
  bool known = kept > 0 && hl_volume_get_info(description->volumes[0].volume, &info) == HL_OK;
  return known ? info.space : HL_SPACE_UNKNOWN;
}

/* Loads all layers of the file, of which the list's labels show. */
static int load_layers(cli_host *host, const char *path, const char *table,
                       const hl_volume_load_options *reading, show_list *show, render_label_layers *layers) {
  hl_error error = {0};
  for (size_t count = 1; layers->count < count;) {
    hl_status status = load_layer(host->context, path, table, reading, layers, &error);
    if (status != HL_OK) return host_fail(host, PHASE_READ, status, &error);
    count = layers_of(layers->volumes[0].volume);
    if (count > RENDER_MOST_LABEL_LAYERS)
      return fail(EXIT_CODE_UNSUPPORTED, "'%s': has %zu layers, at most %d are read", path, count,
                  RENDER_MOST_LABEL_LAYERS);
    hl_scene_volume *layer = &layers->volumes[layers->count - 1];
    apply_show(show, (hl_label *)layer->labels, layer->label_count);
  }
  return EXIT_CODE_OK;
}

/* How a label map is read that is turned into an anatomical space. */
static hl_volume_load_options reading_in(hl_space space) {
  hl_volume_load_options reading;
  hl_volume_load_options_defaults(&reading);
  reading.space = space;
  return reading;
}

/* What --show says of the matter outside of a mask's labels, "rest:FACTOR"; 0 where it does not. */
static double rest_of(show_list *show) {
  double rest = 0;
  for (size_t s = 0; s < show->count; s++) {
    if (strcmp(show->labels[s].name, "rest") != 0) continue;
    show->labels[s].found = true;
    rest = show->labels[s].opacity;
  }
  return rest;
}

/* Makes a scene whose volumes have the mask; those that are label maps stay as they are. */
static hl_status put_on_mask(hl_context *context, const hl_mask *mask, hl_scene **scene, hl_error *error) {
  hl_scene_description description = *hl_scene_describe(*scene);
  hl_scene_volume *volumes = calloc(description.volume_count + 1, sizeof *volumes);
  hl_scene *made = NULL;
  if (volumes == NULL) {
    snprintf(error->message, sizeof error->message, "out of memory: %zu volumes", description.volume_count);
    return error->code = HL_ERROR_MEMORY;
  }
  memcpy(volumes, description.volumes, description.volume_count * sizeof *volumes);
  for (size_t v = 0; v < description.volume_count; v++)
    if (volumes[v].label_count == 0) volumes[v].mask = *mask;
  description.volumes = volumes;
  hl_status status = hl_scene_create(context, &description, &made, error);
  free(volumes);
  if (status != HL_OK) return status;
  hl_scene_release(*scene);
  *scene = made;
  return HL_OK;
}

/* Labels that do not show belong to the rest: the others are moved to the front. Returns how many there are.
 */
static size_t keep_shown(hl_label *labels, size_t count) {
  size_t kept = 0;
  for (size_t n = 0; n < count; n++)
    if (labels[n].visible) labels[kept++] = labels[n];
  return kept;
}

/* --mask: the label map of the file over the scene's volumes. */
static int add_mask(cli_host *host, const char *path, const char *table, show_list *show,
                    render_label_layers *layers, hl_scene **scene) {
  hl_error error = {0};
  const hl_scene_description *description = hl_scene_describe(*scene);
  const double rest = rest_of(show);
  if (description->volume_count == 0)
    return fail(EXIT_CODE_USAGE, "--mask is for volumes: the scene has none");
  const hl_volume_load_options reading = reading_in(space_of(description, 1));
  int exit_code = load_layers(host, path, table, &reading, show, layers);
  if (exit_code == EXIT_CODE_OK) exit_code = check_found(show, layers);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  if (layers->count > 1)
    return fail(EXIT_CODE_UNSUPPORTED, "'%s': has %zu overlapping layers, a mask takes one: save it as one",
                path, layers->count);
  const hl_scene_volume *map = &layers->volumes[0];
  const hl_mask mask = {.volume = map->volume,
                        .file = path,
                        .component = map->component,
                        .labels = map->labels,
                        .label_count = keep_shown((hl_label *)map->labels, map->label_count),
                        .rest = rest};
  hl_status status = put_on_mask(host->context, &mask, scene, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}

/* --labels, or the bare volume itself. */
static int add_map(cli_host *host, const cli_value *values, bool bare, show_list *show,
                   render_label_layers *layers, hl_scene **scene) {
  const cli_value *table = &values[RENDER_LABEL_TABLE];
  const hl_scene_description *description = hl_scene_describe(*scene);
  hl_error error = {0};
  size_t kept;
  const char *path = file_of_labels(values, bare, description, &kept);
  if (path == NULL) return EXIT_CODE_USAGE;
  hl_volume_load_options reading = reading_in(space_of(description, kept));
  if (render_is_label_map(values))
    input_load_options(&values[RENDER_ARRAY], &values[RENDER_SPACING], &reading);
  int exit_code = load_layers(host, path, table->given ? table->text : NULL, &reading, show, layers);
  if (exit_code == EXIT_CODE_OK) exit_code = check_found(show, layers);
  if (exit_code != EXIT_CODE_OK) return exit_code;
  hl_status status = add_layers(host->context, layers, kept, bare, scene, &error);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}

bool render_is_label_map(const cli_value *values) {
  return !values[RENDER_LABELS].given && !values[RENDER_MASK].given &&
         (values[RENDER_LABEL_TABLE].given || values[RENDER_SHOW].given);
}

int render_load_label_map(cli_host *host, const cli_value *values, const char *path,
                          const hl_volume_load_options *reading, render_label_layers *layers) {
  const cli_value *table = &values[RENDER_LABEL_TABLE];
  show_list *show = calloc(1, sizeof *show);
  int exit_code = show != NULL ? read_show(&values[RENDER_SHOW], show)
                               : fail(EXIT_CODE_FAILURE, "out of memory for labels");
  if (exit_code == EXIT_CODE_OK)
    exit_code = load_layers(host, path, table->given ? table->text : NULL, reading, show, layers);
  free(show);
  return exit_code;
}

/* Whether the scene's only volume comes from a file that names its segments, and no option asks for another
 * look: it is then shown as they are. */
static bool is_segmented(cli_host *host, const cli_value *values, const hl_scene *scene) {
  const hl_scene_description *description = scene != NULL ? hl_scene_describe(scene) : NULL;
  if (description == NULL || description->volume_count != 1 || description->volumes[0].file == NULL ||
      strcmp(description->volumes[0].file, "-") == 0)
    return false;
  for (int option = RENDER_ARRAY; option <= RENDER_ISO; option++)
    if (values[option].given) return false;
  const hl_volume *volume = description->volumes[0].volume;
  if (hl_volume_segment_count(volume) == 0 || layers_of(volume) > RENDER_MOST_LABEL_LAYERS) return false;
  hl_label *labels = NULL;
  size_t count = 0;
  if (hl_labels_of_volume(host->context, volume, NULL, &labels, &count, NULL) != HL_OK) return false;
  hl_labels_release(host->context, labels);
  return true;
}

int render_add_labels(cli_host *host, const cli_value *values, bool bare, hl_scene **scene) {
  const cli_value *table = &values[RENDER_LABEL_TABLE], *mask = &values[RENDER_MASK];
  bool labels = values[RENDER_LABELS].given;
  if (!labels && !mask->given && !table->given && !values[RENDER_SHOW].given &&
      !(bare && is_segmented(host, values, *scene)))
    return EXIT_CODE_OK;
  if (labels && mask->given)
    return fail(EXIT_CODE_USAGE, "--mask and --labels exclude each other: --show belongs to one of them");
  show_list *show = calloc(1, sizeof *show);
  render_label_layers *layers = calloc(1, sizeof *layers);
  int exit_code = show != NULL && layers != NULL ? read_show(&values[RENDER_SHOW], show)
                                                 : fail(EXIT_CODE_FAILURE, "out of memory for labels");
  if (exit_code == EXIT_CODE_OK)
    exit_code = mask->given
                    ? add_mask(host, mask->text, table->given ? table->text : NULL, show, layers, scene)
                    : add_map(host, values, bare, show, layers, scene);
  if (layers != NULL) render_release_label_layers(host->context, layers);
  free(layers);
  free(show);
  return exit_code;
}
