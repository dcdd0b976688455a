/* scene/label/label_list.c - lists the labels that the voxels of a label map have. The labels' names and
 * colours come from a table or from the map's file. */
#include <math.h>
#include <string.h>

#include <halflight/scene.h>

#include "core/context.h"
#include "core/door.h"
#include "core/memory.h"
#include "scene/function/transfer_function.h"
#include "scene/label/label_table.h"
#include "scene/scene.h"
#include "volume/store/gathered.h"

/* The labels that were found in a map so far, in rising order. */
typedef struct found_labels {
  int64_t *values; /* owned; [HL_MOST_LABELS]; the numbers of the labels */
  size_t count;
} found_labels;

const hl_label *hl_label_of_value(const hl_label *labels, size_t count, double value) {
  size_t low = 0, high = count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if ((double)labels[middle].value < value) low = middle + 1;
    else high = middle;
  }
  return low < count && (double)labels[low].value == value ? &labels[low] : NULL;
}

double hl_mask_factor(const hl_mask *mask, vec3 place) {
  const double near[3] = {floor(place.x + 0.5), floor(place.y + 0.5), floor(place.z + 0.5)};
  for (int a = 0; a < 3; a++)
    if (!(near[a] >= 0 && near[a] < (double)mask->volume->dimension[a])) return mask->rest;
  const double value = hl_volume_value_within(mask->volume, (size_t)near[0], (size_t)near[1],
                                              (size_t)near[2]);
  const hl_label *label = hl_label_of_value(mask->labels, mask->label_count, value);
  if (label == NULL) return mask->rest;
  return label->visible ? label->opacity : 0;
}

/* Adds a label to a list if the list does not have the label yet. Returns false if the list is full. */
static bool add_value(found_labels *found, int64_t value) {
  size_t low = 0, high = found->count;
  while (low < high) {
    size_t middle = low + (high - low) / 2;
    if (found->values[middle] < value) low = middle + 1;
    else high = middle;
  }
  if (low < found->count && found->values[low] == value) return true;
  if (found->count == HL_MOST_LABELS) return false;
  memmove(found->values + low + 1, found->values + low, (found->count - low) * sizeof *found->values);
  found->values[low] = value;
  found->count++;
  return true;
}

static hl_status fail_value(double value, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT,
                 "the voxel value %.17g is no label: label maps hold whole numbers of 64 bits with a sign",
                 value);
}

/* Collects the values of a map's voxels. Neighbours in a row mostly have the same label, so a value is looked
 * up only if it differs from the value of the voxel before it. */
static hl_status find_values(const hl_volume *map, found_labels *found, hl_error *error) {
  for (size_t k = 0; k < map->dimension[2]; k++)
    for (size_t j = 0; j < map->dimension[1]; j++) {
      const hl_number_row row = hl_volume_numbers(map, j, k, NULL);
      for (size_t i = 0; i < map->dimension[0]; i++) {
        int64_t value;
        if (i > 0 && hl_row_repeats(row, i, i - 1)) continue;
        if (!hl_row_whole(map, row, i, &value))
          return fail_value(map->value_scale * hl_row_number(row, i) + map->value_offset, error);
        if (value != 0 && !add_value(found, value))
          return hl_fail(error, HL_ERROR_UNSUPPORTED,
                         "the volume has more than %d values: it is no label map", HL_MOST_LABELS);
      }
    }
  return HL_OK;
}

static const hl_segment *segment_of(const hl_volume *map, int64_t value) {
  for (size_t n = 0; n < map->segment_count; n++)
    if (map->segments[n].value == value &&
        (map->segments[n].layer == map->component || map->component < 0 || map->array_count == 0))
      return &map->segments[n];
  return NULL;
}

static const hl_label *row_of(const hl_label_list *table, int64_t value) {
  for (size_t n = 0; n < table->count; n++)
    if (table->labels[n].value == value) return &table->labels[n];
  return NULL;
}

/* Gives one label a name and a colour. Name and colour come from the table if the table has the label, else
 * from the map's file. */
static void describe(const hl_volume *map, const hl_label_list *table, int64_t value, hl_label *label) {
  *label = (hl_label){.value = value, .opacity = 1, .visible = 1};
  hl_label_distinct_color(value, label->color);
  const hl_segment *segment = segment_of(map, value);
  if (segment != NULL) {
    label->name = segment->name;
    for (int c = 0; c < 3 && segment->has_color; c++) label->color[c] = hl_srgb_decode(segment->srgb[c]);
  }
  const hl_label *row = row_of(table, value);
  if (row != NULL) *label = *row;
}

/* Copies labels and their names into one block. */
static hl_status copy_labels(hl_context *context, const hl_label *labels, size_t count, hl_label **copy,
                             hl_error *error) {
  size_t bytes = 0;
  for (size_t n = 0; n < count; n++) bytes += labels[n].name == NULL ? 0 : strlen(labels[n].name) + 1;
  hl_label *made = hl_allocate(context, 1, count * sizeof *made + bytes + 1);
  if (made == NULL) return hl_fail_memory(error, count * sizeof *made + bytes, "labels");
  char *at = (char *)(made + count);
  for (size_t n = 0; n < count; n++) {
    made[n] = labels[n];
    if (labels[n].name == NULL) continue;
    size_t length = strlen(labels[n].name) + 1;
    made[n].name = memcpy(at, labels[n].name, length);
    at += length;
  }
  *copy = made;
  return HL_OK;
}

hl_status hl_labels_copy(hl_context *context, const hl_label *labels, size_t count, const hl_label **copy,
                         hl_error *error) {
  hl_label *made = NULL;
  if (count == 0) return HL_OK;
  hl_status status = copy_labels(context, labels, count, &made, error);
  *copy = made;
  return status;
}

hl_status hl_labels_of_volume(hl_context *context, const hl_volume *map, const char *table, hl_label **labels,
                              size_t *count, hl_error *error) {
  HL_DOOR;
  if (context == NULL || map == NULL || labels == NULL || count == NULL)
    return hl_fail(error, HL_ERROR_ARGUMENT, "hl_labels_of_volume: null context, volume, labels or count");
  hl_label_list rows = {0};
  found_labels found = {.values = hl_allocate(context, HL_MOST_LABELS, sizeof *found.values)};
  hl_volume *whole = NULL;
  hl_status status = HL_OK;
  *labels = NULL;
  *count = 0;
  if (found.values == NULL) return hl_fail_memory(error, HL_MOST_LABELS * sizeof *found.values, "labels");
  if (table != NULL) status = hl_label_table_load(context, table, &rows, error);
  if (status == HL_OK) status = hl_volume_in_memory(map, &whole, error);
  if (status == HL_OK) status = find_values(whole, &found, error);
  hl_label *made = status == HL_OK ? hl_allocate(context, found.count + 1, sizeof *made) : NULL;
  if (status == HL_OK && made == NULL) status = hl_fail_memory(error, found.count * sizeof *made, "labels");
  for (size_t n = 0; status == HL_OK && n < found.count; n++) describe(map, &rows, found.values[n], &made[n]);
  if (status == HL_OK) status = copy_labels(context, made, found.count, labels, error);
  if (status == HL_OK) *count = found.count;
  hl_release(context, made);
  hl_release(context, found.values);
  hl_label_list_release(context, &rows);
  return status;
}

void hl_labels_release(hl_context *context, hl_label *labels) {
  if (context != NULL) hl_release(context, labels);
}
