/* volume/info.c - returns the facts that are known about a volume: its grid, its type and range, and the
 * facts that its file states. */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/door.h"
#include "core/error.h"
#include "core/memory.h"
#include "text/json_value.h"
#include "volume/volume.h"

hl_status hl_volume_get_info(const hl_volume *volume, hl_volume_info *info) {
  HL_DOOR;
  if (volume == NULL || info == NULL || info->struct_size != sizeof *info) return HL_ERROR_ARGUMENT;
  memcpy(info->dimensions, volume->dimension, sizeof info->dimensions);
  info->type = volume->type;
  info->space = volume->space;
  const double offset[3] = {volume->index_to_world.offset.x, volume->index_to_world.offset.y,
                            volume->index_to_world.offset.z};
  memcpy(info->origin, offset, sizeof offset);
  for (int axis = 0; axis < 3; axis++) {
    vec3 step = mat3_column(volume->index_to_world.linear, axis);
    info->spacing[axis] = vec3_length(step);
    info->direction[0][axis] = step.x / info->spacing[axis];
    info->direction[1][axis] = step.y / info->spacing[axis];
    info->direction[2][axis] = step.z / info->spacing[axis];
  }
  info->range[0] = volume->minimum;
  info->range[1] = volume->maximum;
  info->mean = volume->mean;
  info->nonfinite_count = volume->nonfinite_count;
  memcpy(info->histogram, volume->histogram, sizeof info->histogram);
  return HL_OK;
}

hl_status hl_volume_write_range(const hl_volume *volume, int end, char *text) {
  HL_DOOR;
  if (volume == NULL || text == NULL || (end != 0 && end != 1)) return HL_ERROR_ARGUMENT;
  const uint64_t whole = volume->whole_range[end];
  const bool is_exact = hl_volume_is_exact(volume) && volume->value_scale == 1 && volume->value_offset == 0;
  if (is_exact && volume->type == HL_VOXEL_U64) snprintf(text, HL_NUMBER_TEXT_BYTES, "%" PRIu64, whole);
  else if (is_exact && volume->type == HL_VOXEL_I64)
    snprintf(text, HL_NUMBER_TEXT_BYTES, "%" PRId64, (int64_t)whole);
  else hl_json_number_text(end == 0 ? volume->minimum : volume->maximum, text);
  return HL_OK;
}

size_t hl_volume_array_count(const hl_volume *volume) { return volume != NULL ? volume->array_count : 0; }

hl_status hl_volume_get_array(const hl_volume *volume, size_t index, hl_volume_array *array) {
  if (volume == NULL || array == NULL || array->struct_size != sizeof *array || index >= volume->array_count)
    return HL_ERROR_ARGUMENT;
  const hl_array_entry *entry = &volume->arrays[index];
  bool chosen = index == volume->chosen_array;
  *array = (hl_volume_array){sizeof *array,
                             entry->name,
                             entry->components,
                             entry->type,
                             entry->of_cells,
                             chosen,
                             chosen ? volume->component : HL_COMPONENT_DEFAULT};
  return HL_OK;
}

size_t hl_volume_series_count(const hl_volume *volume) { return volume != NULL ? volume->series_count : 0; }

hl_status hl_volume_get_series(const hl_volume *volume, size_t index, hl_volume_series *series) {
  if (volume == NULL || series == NULL || series->struct_size != sizeof *series ||
      index >= volume->series_count)
    return HL_ERROR_ARGUMENT;
  const hl_series_entry *entry = &volume->series[index];
  const size_t *n = entry->dimensions;
  *series = (hl_volume_series){sizeof *series,
                               entry->uid,
                               entry->modality,
                               entry->description,
                               entry->number,
                               {n[0], n[1], n[2]},
                               index == volume->chosen_series};
  return HL_OK;
}

hl_status hl_volume_get_channel(const hl_volume *volume, size_t index, hl_volume_channel *channel) {
  if (volume == NULL || channel == NULL || channel->struct_size != sizeof *channel ||
      index >= volume->selection.channels)
    return HL_ERROR_ARGUMENT;
  *channel = (hl_volume_channel){.struct_size = sizeof *channel,
                                 .name = "",
                                 .window = {NAN, NAN},
                                 .chosen = index == (size_t)volume->selection.channel};
  if (volume->channels == NULL) return HL_OK;
  const hl_channel *known = &volume->channels[index];
  channel->name = known->name;
  channel->has_color = known->has_color;
  for (int c = 0; c < 3 && known->has_color; c++) channel->srgb[c] = known->srgb[c];
  if (known->window[0] < known->window[1]) memcpy(channel->window, known->window, sizeof known->window);
  return HL_OK;
}

size_t hl_volume_segment_count(const hl_volume *volume) { return volume != NULL ? volume->segment_count : 0; }

hl_status hl_volume_get_segment(const hl_volume *volume, size_t index, hl_volume_segment *segment) {
  if (volume == NULL || segment == NULL || segment->struct_size != sizeof *segment ||
      index >= volume->segment_count)
    return HL_ERROR_ARGUMENT;
  const hl_segment *known = &volume->segments[index];
  *segment = (hl_volume_segment){.struct_size = sizeof *segment,
                                 .name = known->name,
                                 .value = known->value,
                                 .layer = known->layer,
                                 .has_color = known->has_color};
  for (int c = 0; c < 3 && known->has_color; c++) segment->srgb[c] = known->srgb[c];
  return HL_OK;
}

const char *hl_volume_label_map(const hl_volume *volume, size_t index) {
  return volume != NULL && index < volume->label_map_count ? volume->label_maps[index] : NULL;
}

const char *hl_volume_unit(const hl_volume *volume) { return volume != NULL ? volume->unit : NULL; }

size_t hl_volume_absent_chunks(const hl_volume *volume, size_t *chunks) {
  HL_DOOR;
  if (chunks != NULL) *chunks = volume != NULL ? volume->absence.chunks : 0;
  return volume != NULL ? volume->absence.absent : 0;
}

hl_status hl_volume_get_selection(const hl_volume *volume, hl_volume_selection *selection) {
  if (volume == NULL || selection == NULL || selection->struct_size != sizeof *selection)
    return HL_ERROR_ARGUMENT;
  const hl_selection *read = &volume->selection;
  *selection = (hl_volume_selection){sizeof *selection,
                                     read->times,
                                     read->channels,
                                     read->levels,
                                     read->time,
                                     read->channel,
                                     read->level,
                                     read->aim,
                                     volume->resolutions.is_chosen,
                                     volume->resolutions.is_part};
  return HL_OK;
}

hl_volume_description hl_volume_own_grid(const hl_volume *volume) {
  const vec3 origin = volume->index_to_world.offset;
  hl_volume_description grid;
  hl_volume_description_defaults(&grid);
  for (int axis = 0; axis < 3; axis++) {
    const vec3 step = mat3_column(volume->index_to_world.linear, axis);
    memcpy(grid.axis[axis], (const double[3]){step.x, step.y, step.z}, sizeof grid.axis[axis]);
    grid.dimensions[axis] = volume->dimension[axis];
  }
  memcpy(grid.origin, (const double[3]){origin.x, origin.y, origin.z}, sizeof grid.origin);
  grid.space = volume->space;
  return grid;
}

/* Copies an array for a volume. *copy: set to the copy, which hl_release() releases; not changed if the array
 * is null. */
static hl_status copy_array(const hl_volume *volume, const void *array, size_t bytes, const char *subject,
                            void **copy, hl_error *error) {
  if (array == NULL || bytes == 0) return HL_OK;
  *copy = hl_allocate(volume->context, bytes, 1);
  if (*copy == NULL) return hl_fail_memory(error, bytes, subject);
  memcpy(*copy, array, bytes);
  return HL_OK;
}

hl_status hl_volume_take_about(hl_volume *volume, const hl_volume *from, hl_error *error) {
  volume->index_to_world = from->index_to_world;
  volume->unit = from->unit;
  volume->absence = from->absence;
  volume->is_anatomical = from->is_anatomical;
  volume->says_fog = from->says_fog;
  memcpy(volume->window, from->window, sizeof volume->window);
  volume->selection = from->selection;
  volume->resolutions = from->resolutions;
  volume->component = from->component;
  void *channels = NULL, *series = NULL;
  hl_status status = copy_array(volume, from->channels, from->selection.channels * sizeof *volume->channels,
                                "a volume's channels", &channels, error);
  volume->channels = channels;
  if (status != HL_OK) return status;
  status = copy_array(volume, from->series, from->series_count * sizeof *volume->series, "a volume's series",
                      &series, error);
  volume->series = series;
  volume->series_count = series != NULL ? from->series_count : 0;
  volume->chosen_series = from->chosen_series;
  return status;
}

void hl_volume_world_box(const hl_volume_info *info, double low[3], double high[3]) {
  HL_DOOR;
  if (info == NULL || low == NULL || high == NULL) return;
  for (int row = 0; row < 3; row++) {
    low[row] = high[row] = info->origin[row];
    for (int axis = 0; axis < 3; axis++) {
      double step = info->direction[row][axis] * info->spacing[axis];
      double first = -0.5 * step, last = ((double)info->dimensions[axis] - 0.5) * step;
      low[row] += fmin(first, last);
      high[row] += fmax(first, last);
    }
  }
}
