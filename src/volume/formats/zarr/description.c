/* volume/formats/zarr/description.c - reads OME-Zarr's descriptions of channels, labels and label maps. */
#include "volume/formats/zarr/description.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "volume/io/text.h"

hl_status hl_zarr_name_labels(const json_t *ome, hl_volume *volume, hl_error *error) {
  const json_t *described = json_object_get(ome, "image-label");
  const json_t *lists[2] = {json_object_get(described, "colors"), json_object_get(described, "properties")};
  size_t most = json_array_size(lists[0]) + json_array_size(lists[1]), count = 0;
  if (most == 0) return HL_OK;
  if (most > HL_MOST_SEGMENTS) most = HL_MOST_SEGMENTS;
  hl_segment *segments = hl_allocate_zeroed(volume->context, most, sizeof *segments);
  if (segments == NULL) return hl_fail_memory(error, most * sizeof *segments, "the names of labels");
  for (int list = 0; list < 2; list++)
    for (size_t n = 0; n < json_array_size(lists[list]); n++) {
      const json_t *entry = json_array_get(lists[list], n), *number = json_object_get(entry, "label-value");
      const json_t *rgba = json_object_get(entry, "rgba");
      size_t at = 0;
      if (!json_is_number(number)) continue;
      int64_t value = json_is_integer(number) ? json_integer_value(number) : 0;
      if (json_is_real(number) && fabs(json_real_value(number)) < 0x1p63)
        value = (int64_t)json_real_value(number);
      while (at < count && segments[at].value != value) at++;
      if (at == most) continue;
      if (at == count) segments[count++].value = value;
      static const char *const keys[] = {"class", "name", "label"};
      for (size_t k = 0; k < 3 && segments[at].name[0] == 0; k++) {
        const char *name = json_string_value(json_object_get(entry, keys[k]));
        if (name != NULL) snprintf(segments[at].name, sizeof segments[at].name, "%s", name);
      }
      if (json_array_size(rgba) < 3) continue;
      segments[at].has_color = true;
      for (size_t c = 0; c < 3; c++) {
        double code = json_number_value(json_array_get(rgba, c)) / 255;
        segments[at].srgb[c] = code < 0 ? 0 : code > 1 ? 1 : code;
      }
    }
  volume->segments = segments;
  volume->segment_count = count;
  return HL_OK;
}

/* Reads a colour of six hexadecimal digits, such as "00FF00". */
static bool read_color(const char *text, double srgb[3]) {
  if (text == NULL || strlen(text) != 6 || strspn(text, "0123456789abcdefABCDEF") != 6) return false;
  for (int c = 0; c < 3; c++) {
    int code = 0;
    for (int n = 0; n < 2; n++) {
      char digit = text[2 * c + n];
      code = 16 * code + (digit <= '9' ? digit - '0' : (digit | 32) - 'a' + 10);
    }
    srgb[c] = code / 255.0;
  }
  return true;
}

hl_status hl_zarr_describe_channels(const json_t *ome, const char *path, hl_load_request *request,
                                    hl_error *error) {
  const json_t *channels = json_object_get(json_object_get(ome, "omero"), "channels");
  if (json_array_size(channels) == 0) return HL_OK;
  hl_status status = hl_channels_make(request, error);
  for (size_t n = 0; status == HL_OK && n < json_array_size(channels) && n < request->selection.channels;
       n++) {
    const json_t *entry = json_array_get(channels, n), *window = json_object_get(entry, "window");
    const json_t *start = json_object_get(window, "start"), *end = json_object_get(window, "end");
    const char *label = json_string_value(json_object_get(entry, "label"));
    hl_channel *channel = &request->channels[n];
    if (label != NULL) hl_channel_name(channel, label);
    channel->has_color = read_color(json_string_value(json_object_get(entry, "color")), channel->srgb);
    if (!json_is_number(start) || !json_is_number(end)) continue;
    channel->window[0] = json_number_value(start);
    channel->window[1] = json_number_value(end);
  }
  return status == HL_OK ? hl_channel_find(request, path, error) : status;
}

hl_status hl_zarr_list_label_maps(const hl_bundle *bundle, const char *folder, hl_volume *volume,
                                  hl_error *error) {
  char path[HL_ZARR_PATH_BYTES];
  json_t *attributes = NULL;
  hl_error unread = {0};
  if (!hl_zarr_join(path, folder, "labels")) return HL_OK;
  hl_status status = hl_zarr_attributes_read(bundle, path, &attributes, &unread);
  const json_t *list = status == HL_OK ? json_object_get(hl_zarr_ome(attributes), "labels") : NULL;
  size_t most = json_array_size(list) < HL_MOST_SEGMENTS ? json_array_size(list) : HL_MOST_SEGMENTS,
         count = 0;
  if (most > 0) {
    volume->label_maps = hl_allocate_zeroed(volume->context, most, sizeof *volume->label_maps);
    if (volume->label_maps == NULL)
      status = hl_fail_memory(error, most * sizeof *volume->label_maps, "labels");
  }
  for (size_t n = 0; n < most && volume->label_maps != NULL; n++) {
    const char *name = json_string_value(json_array_get(list, n));
    if (name == NULL || !hl_zarr_join(path, "labels/", name)) continue;
    if (strlen(path) > HL_LABEL_MAP_BYTES) continue;
    char shown[HL_PRINTABLE_BYTES];
    snprintf(volume->label_maps[count++], HL_LABEL_MAP_BYTES, "labels/%s", hl_text_printable(shown, name));
  }
  volume->label_map_count = count;
  json_decref(attributes);
  return status == HL_ERROR_MEMORY ? status : HL_OK;
}
