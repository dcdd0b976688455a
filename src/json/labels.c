/* json/labels.c - reads the labels of a volume that is a label map from JSON.
 *
 * "labels" is either true, for all labels that the voxels have, or a list of the labels that are shown. The
 * list names each label by its number or its name, and may give its colour, its opacity and whether it is
 * visible. A missing name or colour is taken from the table that "label_table" names, or else from the
 * volume's file. If neither has a colour, a colour is chosen that differs from the colours of neighbouring
 * labels. */
#include <math.h>
#include <string.h>

#include "core/memory.h"
#include "json/parts.h"
#include "json/settings.h"
#include "scene/label/draw_labels.h"
#include "scene/label/label_table.h"
#include "scene/scene.h"

static const char *const label_keys[] = {"value",   "name", "color",    "opacity",
                                         "visible", "tint", "unlisted", NULL};

/* The labels that the volume's file or the label table describes. They are found when they are first
 * needed. */
typedef struct known_labels {
  hl_json_reader *reader;
  const hl_volume *map;
  char *table; /* owned; the path of the label table; null if there is no table */
  bool found;
  hl_label *labels; /* owned; [count]; the labels that the file or the table describes */
  size_t count;
} known_labels;

static hl_status find_known(known_labels *known) {
  if (known->found) return HL_OK;
  known->found = true;
  hl_status status = hl_labels_of_volume(known->reader->context, known->map, known->table, &known->labels,
                                         &known->count, known->reader->error);
  if (status != HL_OK) hl_json_prefix(known->reader, known->reader->place);
  return status;
}

static const hl_label *known_by_value(const known_labels *known, int64_t value) {
  for (size_t n = 0; n < known->count; n++)
    if (known->labels[n].value == value) return &known->labels[n];
  return NULL;
}

static const hl_label *known_by_name(const known_labels *known, const char *name) {
  for (size_t n = 0; n < known->count; n++)
    if (known->labels[n].name != NULL && strcmp(known->labels[n].name, name) == 0) return &known->labels[n];
  return NULL;
}

/* Takes missing properties of a label from its description in the file or table. If the object gives only a
 * name, this also finds the label's number. */
static hl_status take_known(known_labels *known, const json_t *object, const char *name, hl_label *label) {
  bool by_name = json_object_get(object, "value") == NULL;
  if (!by_name && json_object_get(object, "color") != NULL) return HL_OK;
  hl_status status = find_known(known);
  if (status != HL_OK) return status;
  const hl_label *found = by_name ? known_by_name(known, name) : known_by_value(known, label->value);
  if (found == NULL && by_name)
    return hl_json_fail(known->reader, HL_ERROR_INPUT, "name",
                        "\"%.100s\" is no label of the file: give its number as \"value\"", name);
  if (found != NULL) *label = *found;
  else hl_label_distinct_color(label->value, label->color);
  return HL_OK;
}

/* Reads the number of a label, without rounding an integer to a double. */
static hl_status read_value(hl_json_reader *reader, const json_t *object, int64_t *number) {
  const json_t *value = json_object_get(object, "value");
  double real = json_is_real(value) ? json_real_value(value) : 0.5;
  if (value == NULL) return HL_OK;
  if (!json_is_integer(value) && !(real == floor(real) && fabs(real) < 0x1p63))
    return hl_json_fail(reader, HL_ERROR_INPUT, "value", "is no whole number: give the label's");
  *number = json_is_integer(value) ? json_integer_value(value) : (int64_t)real;
  return HL_OK;
}

static hl_status read_label(known_labels *known, const json_t *object, hl_label *label) {
  hl_json_reader *reader = known->reader;
  const char *name = NULL;
  *label = (hl_label){.opacity = 1, .visible = 1};
  hl_status status = hl_json_object(reader, object, label_keys);
  if (status == HL_OK) status = hl_json_text(reader, object, "name", &name);
  if (status == HL_OK) status = read_value(reader, object, &label->value);
  if (status == HL_OK && name == NULL && json_object_get(object, "value") == NULL)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "value",
                          "is missing: give the label's number, or its name");
  if (status == HL_OK) status = take_known(known, object, name, label);
  if (status == HL_OK && name != NULL) label->name = name;
  if (status == HL_OK) status = hl_json_numbers(reader, object, "color", 3, label->color);
  /* in a mask, a label tints by default if the scene gives the label a colour */
  if (json_object_get(object, "color") != NULL) label->tint = 1;
  if (status == HL_OK) status = hl_json_number(reader, object, "tint", &label->tint);
  if (status == HL_OK) status = hl_json_number(reader, object, "opacity", &label->opacity);
  if (status == HL_OK) status = hl_json_flag(reader, object, "visible", &label->visible);
  return status == HL_OK ? hl_json_flag(reader, object, "unlisted", &label->unlisted) : status;
}

/* Sorts labels by number. Lists of labels are short. */
static void sort(hl_label *labels, size_t count) {
  for (size_t n = 1; n < count; n++)
    for (size_t m = n; m > 0 && labels[m - 1].value > labels[m].value; m--) {
      hl_label moved = labels[m];
      labels[m] = labels[m - 1];
      labels[m - 1] = moved;
    }
}

static hl_status read_list(known_labels *known, const json_t *list, hl_scene_volume *volume) {
  hl_json_reader *reader = known->reader;
  size_t count = json_array_size(list), mark = hl_json_enter(reader, "labels");
  hl_status status = hl_json_array(reader, list, 1, HL_MOST_LABELS);
  if (status != HL_OK) return status;
  hl_label *labels = hl_allocate(reader->context, count, sizeof *labels);
  if (labels == NULL) return hl_fail_memory(reader->error, count * sizeof *labels, "labels");
  for (size_t n = 0; status == HL_OK && n < count; n++) {
    size_t inner = hl_json_enter_index(reader, n);
    status = read_label(known, json_array_get(list, n), &labels[n]);
    if (status == HL_OK) hl_json_leave(reader, inner);
  }
  if (status == HL_OK) {
    hl_json_leave(reader, mark);
    sort(labels, count);
    status = hl_labels_copy(reader->context, labels, count, &volume->labels, reader->error);
    volume->label_count = count;
  }
  hl_release(reader->context, labels);
  return status;
}

static hl_status read_any(known_labels *known, const json_t *value, hl_scene_volume *volume) {
  hl_json_reader *reader = known->reader;
  if (json_is_array(value)) return read_list(known, value, volume);
  if (!json_is_true(value))
    return hl_json_fail(reader, HL_ERROR_INPUT, "labels",
                        "is %s: give true for all labels, or a list of them",
                        json_is_false(value) ? "false" : hl_json_type_name(value));
  hl_status status = find_known(known);
  if (status == HL_OK && known->count == 0)
    status = hl_json_fail(reader, HL_ERROR_INPUT, "labels", "the volume has no label but 0, the background");
  if (status != HL_OK) return status;
  volume->labels = known->labels;
  volume->label_count = known->count;
  known->labels = NULL;
  return HL_OK;
}

hl_status hl_json_read_label_list(hl_json_reader *reader, const json_t *object, hl_scene_volume *volume) {
  const json_t *value = json_object_get(object, "labels");
  const char *table = NULL;
  hl_status status = hl_json_text(reader, object, "label_table", &table);
  if (status != HL_OK) return status;
  if (value == NULL)
    return table == NULL
               ? HL_OK
               : hl_json_fail(reader, HL_ERROR_INPUT, "label_table", "is for labels: give \"labels\"");
  /* A reader that takes volumes from an earlier scene opens no file, and thus no label table. */
  if (table != NULL && reader->like != NULL) table = NULL;
  known_labels known = {reader, volume->volume, NULL, false, NULL, 0};
  if (table != NULL && (known.table = hl_json_path(reader, table)) == NULL)
    return hl_fail_memory(reader->error, strlen(table) + 1, "a path");
  status = read_any(&known, value, volume);
  hl_labels_release(reader->context, known.labels);
  hl_release(reader->context, known.table);
  return status;
}

hl_status hl_json_read_labels(hl_json_reader *reader, const json_t *object, hl_scene_volume *volume) {
  if (json_object_get(object, "labels") != NULL && json_object_get(object, "transfer_function") != NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, "transfer_function",
                        "and labels exclude each other: remove one");
  hl_status status = hl_json_read_label_list(reader, object, volume);
  if (status != HL_OK || volume->label_count == 0) return status;
  return hl_labels_function(reader->context, volume, &volume->transfer_function, reader->error);
}
