/* compose/shown_labels.c - see shown_labels.h. */
#include "compose/shown_labels.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/context.h"
#include "core/door.h"
#include "core/error.h"
#include "core/memory.h"
#include "elementary/elementary.h"
#include "text/color.h"
#include "text/edit_distance.h"
#include "text/plain.h"
#include "volume/io/text.h"

static hl_status fail_show(const char *item, const char *mend, hl_error *error) {
  return hl_fail(error, HL_ERROR_ARGUMENT, "--show \"%.100s\": %s", item, mend);
}

/* Reads one item, which is `length` characters long. */
static hl_status read_item(const char *item, size_t length, hl_shown_label *made, hl_error *error) {
  *made = (hl_shown_label){.opacity = 1};
  if (length == 0 || length >= sizeof made->name)
    return fail_show(item, "give labels by name or number, with commas between them: liver,tumour=red:0.5",
                     error);
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
    made->own = hl_plain_equal(equals + 1, "own");
    made->colored = !made->own;
    if (made->colored && !hl_parse_color(equals + 1, 0, 1, made->color))
      made->wrong = "give #rrggbb, a CSS name or own after \"=\"";
  }
  made->all = strcmp(made->name, "all") == 0;
  made->rest = strcmp(made->name, "rest") == 0;
  return HL_OK;
}

hl_status hl_read_shown(const hl_asked *value, hl_shown_list *list, hl_error *error) {
  list->count = 0;
  for (int n = 0; n < value->count; n++)
    for (const char *item = value->texts[n]; item != NULL;) {
      const char *comma = strchr(item, ',');
      size_t length = comma != NULL ? (size_t)(comma - item) : strlen(item);
      if (list->count == HL_MOST_SHOWN) return fail_show(item, "names too many labels", error);
      hl_status status = read_item(item, length, &list->labels[list->count++], error);
      if (status != HL_OK) return status;
      item = comma != NULL ? comma + 1 : NULL;
    }
  return HL_OK;
}

void hl_let_rest_be_all(hl_shown_list *list) {
  for (size_t s = 0; s < list->count; s++) list->labels[s].all |= list->labels[s].rest;
}

static bool is_whole(const hl_label *label, const hl_shown_label *shown) {
  return label->name != NULL && strcmp(label->name, shown->whole) == 0;
}

/* Returns whether a label has the name of the item. Unless `exactly`, the function ignores upper and lower
 * case. */
static bool has_name(const hl_label *label, const hl_shown_label *shown, bool exactly) {
  if (label->name == NULL) return false;
  return exactly ? strcmp(label->name, shown->name) == 0 : hl_plain_equal(label->name, shown->name);
}

static bool is_named(const hl_label *label, const hl_shown_label *shown, bool exactly) {
  if (shown->rest) return shown->all; /* a label whose own name is "rest" can only be named by its number */
  if (is_whole(label, shown)) return true;
  if (shown->wrong != NULL) return false;
  int64_t number;
  return shown->all || has_name(label, shown, exactly) ||
         (hl_text_whole(shown->name, &number) && number == label->value);
}

/* Shows a label as an item of the list says, if the item names the label. exactly: whether upper and lower
 * case must agree. */
static void show_label(hl_shown_label *shown, double opacity, bool exactly, hl_label *label) {
  if (!is_named(label, shown, exactly)) return;
  const bool whole = is_whole(label, shown);
  shown->found = true;
  label->visible = 1;
  label->unlisted = 0;
  label->opacity = whole ? 1 : opacity;
  if ((!shown->colored && !shown->own) || whole) return;
  if (shown->colored) memcpy(label->color, shown->color, sizeof label->color);
  label->tint = 1; /* in a mask, matter takes the label's colour */
}

/* The opacity of each of `count` bodies that the item "all" shows together. opacity: the item's opacity,
 * which is the opacity of all bodies together along a typical path. Derived: of n equal bodies that fill a
 * space, a path typically meets the cube root of n. The path crosses the skin of each body that it meets
 * twice. The fractions of light that the skins let pass are multiplied. */
static double opacity_of_each(double opacity, size_t count) {
  return opacity < 1 ? -hl_expm1(hl_log1p(-opacity) / (2 * hl_cbrt((double)count))) : opacity;
}

/* Returns whether the item "all" or "rest" shows labels that need no entry in a legend, because they are the
 * faint rest around labels that the list names. */
static bool is_faint_rest(const hl_shown_list *list, const hl_shown_label *all) {
  bool named = false;
  for (size_t s = 0; s < list->count; s++) named |= !list->labels[s].all;
  return named && all->opacity < 1;
}

void hl_show_labels(hl_shown_list *list, hl_label *labels, size_t count) {
  bool exactly[HL_MOST_SHOWN] = {false}; /* for each item, whether the name of a label equals the item's name
                                          * exactly, because atlases have names that differ only in upper and
                                          * lower case */
  size_t bodies = 0;
  if (list->count == 0) return;
  for (size_t n = 0; n < count; n++) bodies += labels[n].visible != 0;
  for (size_t s = 0; s < list->count; s++)
    for (size_t n = 0; n < count; n++) exactly[s] |= has_name(&labels[n], &list->labels[s], true);
  for (size_t n = 0; n < count; n++) {
    const bool hidden = !labels[n].visible;
    labels[n].visible = 0;
    for (size_t s = 0; s < list->count; s++) {
      hl_shown_label *all = &list->labels[s];
      if (!all->all || hidden) continue;
      show_label(all, list->of_mask ? all->opacity : opacity_of_each(all->opacity, bodies), exactly[s],
                 &labels[n]);
      labels[n].unlisted = is_faint_rest(list, all);
    }
    for (size_t s = 0; s < list->count; s++)
      if (!list->labels[s].all) show_label(&list->labels[s], list->labels[s].opacity, exactly[s], &labels[n]);
  }
}

void hl_tell_of_shadowed_labels(hl_context *context, const hl_shown_list *list,
                                const hl_label_layers *layers) {
  for (size_t s = 0; s < list->count; s++) {
    const hl_shown_label *shown = &list->labels[s];
    for (size_t n = 0; n < layers->count && (shown->all || shown->rest); n++)
      for (size_t l = 0; l < layers->volumes[n].label_count; l++) {
        const hl_label *label = &layers->volumes[n].labels[l];
        if (has_name(label, shown, false))
          hl_log(context, HL_LOG_WARNING,
                 "--show %s stands for %s: the label of the name \"%s\" is given by its number, %" PRId64,
                 shown->name,
                 shown->all ? "all labels that --show does not name" : "what lies beside the mask",
                 label->name, label->value);
      }
  }
}

static const char *name_of_label(const void *data, size_t index) {
  const hl_label_layers *layers = data;
  for (size_t layer = 0; layer < layers->count; layer++) {
    const hl_scene_volume *volume = &layers->volumes[layer];
    if (index < volume->label_count)
      return volume->labels[index].name != NULL ? volume->labels[index].name : "";
    index -= volume->label_count;
  }
  return NULL;
}

/* Writes the labels of the layers, each by its name or else by its value: "liver, tumour, 7". If not all
 * labels are written, the text ends with the number of further labels. */
static void list_labels(const hl_label_layers *layers, char *text, size_t size) {
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
                           : snprintf(text + used, size - used, "%s%" PRId64, count > 0 ? ", " : "",
                                      label->value));
    }
  if (count > LISTED)
    snprintf(text + used, size - used, " and %zu more: see 'halflight info'", count - LISTED);
}

static bool have_names(const hl_label_layers *layers) {
  bool named = false;
  for (size_t n = 0; n < layers->count; n++)
    for (size_t l = 0; l < layers->volumes[n].label_count; l++) {
      const char *name = layers->volumes[n].labels[l].name;
      named = named || (name != NULL && name[0] != '\0');
    }
  return named;
}

hl_status hl_check_shown(const hl_shown_list *list, const hl_label_layers *layers, hl_error *error) {
  for (size_t s = 0; s < list->count; s++) {
    if (list->labels[s].found) continue;
    if (list->labels[s].wrong != NULL) return fail_show(list->labels[s].whole, list->labels[s].wrong, error);
    if (list->labels[s].all) continue;
    const char *near = hl_nearest_candidate(list->labels[s].name, name_of_label, layers);
    if (near != NULL)
      return hl_fail(error, HL_ERROR_ARGUMENT,
                     "--show: there is no label \"%.100s\": did you mean \"%.100s\"?", list->labels[s].name,
                     near);
    char known[1000];
    list_labels(layers, known, sizeof known);
    int64_t number;
    if (!have_names(layers) && !hl_text_whole(list->labels[s].name, &number))
      return hl_fail(
          error, HL_ERROR_ARGUMENT,
          "--show: there is no label \"%.100s\": labels have numbers alone (%s): give one, or names by "
          "--label-table FILE",
          list->labels[s].name, known[0] != '\0' ? known : "none");
    return hl_fail(error, HL_ERROR_ARGUMENT, "--show: there is no label \"%.100s\": there is %s",
                   list->labels[s].name, known[0] != '\0' ? known : "none");
  }
  return HL_OK;
}

hl_status hl_labels_show(hl_context *context, const char *show, hl_label *labels, size_t count,
                         hl_error *error) {
  HL_DOOR;
  if (context == NULL || show == NULL || (labels == NULL && count > 0))
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_labels_show: null context, show or labels");
  const hl_asked asked = {.given = true, .text = show, .texts = {show}, .count = 1};
  hl_shown_list *list = hl_allocate_zeroed(context, 1, sizeof *list);
  hl_label_layers *layers = hl_allocate_zeroed(context, 1, sizeof *layers);
  hl_status status = list != NULL && layers != NULL
                         ? hl_read_shown(&asked, list, error)
                         : hl_fail_memory(error, sizeof *list + sizeof *layers, "labels");
  if (status == HL_OK) {
    hl_let_rest_be_all(list);
    hl_show_labels(list, labels, count);
    layers->volumes[0].labels = labels;
    layers->volumes[0].label_count = count;
    layers->count = 1;
    status = hl_check_shown(list, layers, error);
  }
  hl_release(context, layers);
  hl_release(context, list);
  return status;
}
