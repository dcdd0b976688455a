/* cli/info/volume.c - prints the properties of a volume as text and as JSON: its arrays, channels, labels,
 * range and histogram. */
#include "volume.h"
#include "elementary/elementary.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "labels.h"
#include "picture.h"

/* Prints the file's arrays, and the array and the component from which the volume was read. */
static void print_json_arrays(json_writer *json, const hl_volume *volume) {
  hl_volume_array array = {.struct_size = sizeof array}, chosen = {.components = 1};
  json_open_array(json, "arrays");
  for (size_t n = 0; hl_volume_get_array(volume, n, &array) == HL_OK; n++) {
    json_open_object(json, NULL);
    json_text(json, "name", array.name);
    json_text(json, "type", hl_voxel_type_name(array.type));
    json_whole_number(json, "components", array.components);
    json_bool(json, "of_cells", array.of_cells != 0);
    json_bool(json, "chosen", array.chosen != 0);
    json_close(json);
    if (array.chosen) chosen = array;
  }
  json_close(json);
  json_whole_number(json, "components", chosen.components);
  const char *word = hl_component_name(chosen.component);
  if (word != NULL) json_text(json, "component", word);
  else json_whole_number(json, "component", (uint64_t)chosen.component);
}

/* Prints the numbers of time steps, channels and resolutions in the file, and the ones that were read. */
static void print_json_selection(json_writer *json, const hl_volume *volume) {
  hl_volume_selection selection = {.struct_size = sizeof selection};
  if (hl_volume_get_selection(volume, &selection) != HL_OK) return;
  json_whole_number(json, "times", selection.times);
  json_whole_number(json, "time", (uint64_t)selection.time);
  json_whole_number(json, "channels", selection.channels);
  json_whole_number(json, "channel", (uint64_t)selection.channel);
  json_whole_number(json, "levels", selection.levels);
  json_whole_number(json, "level", (uint64_t)selection.level);
}

static void print_selection(const hl_volume *volume) {
  hl_volume_selection s = {.struct_size = sizeof s};
  if (hl_volume_get_selection(volume, &s) != HL_OK) return;
  if (s.times > 1) printf("  times       %zu: time %d is shown\n", s.times, s.time);
  if (s.channels > 1) printf("  channels    %zu: channel %d is shown\n", s.channels, s.channel);
  if (s.levels > 1) printf("  levels      %zu: level %d is shown\n", s.levels, s.level);
}

static void print_json_series(json_writer *json, const hl_volume *volume) {
  hl_volume_series series = {.struct_size = sizeof series};
  if (hl_volume_series_count(volume) == 0) return;
  json_open_array(json, "series");
  for (size_t n = 0; hl_volume_get_series(volume, n, &series) == HL_OK; n++) {
    const uint64_t dimensions[3] = {series.dimensions[0], series.dimensions[1], series.dimensions[2]};
    json_open_object(json, NULL);
    json_text(json, "uid", series.uid);
    if (isfinite(series.number)) json_number(json, "number", series.number);
    json_text(json, "modality", series.modality);
    json_text(json, "description", series.description);
    json_whole_numbers(json, "dimensions", dimensions, 3);
    json_bool(json, "chosen", series.chosen != 0);
    json_close(json);
  }
  json_close(json);
}

static void print_series(const hl_volume *volume) {
  hl_volume_series s = {.struct_size = sizeof s};
  size_t count = hl_volume_series_count(volume);
  for (size_t n = 0; hl_volume_get_series(volume, n, &s) == HL_OK; n++) {
    printf("  %s  ", n == 0 ? "series    " : "          ");
    if (isfinite(s.number)) printf("%.0f: ", s.number);
    printf("%s%s\"%s\", %zu x %zu x %zu%s\n", s.modality, s.modality[0] != '\0' ? " " : "", s.description,
           s.dimensions[0], s.dimensions[1], s.dimensions[2], s.chosen && count > 1 ? ": is shown" : "");
  }
}

/* A colour as "#rrggbb". */
static const char *color_text(const double srgb[3], char text[8]) {
  int c[3];
  for (int n = 0; n < 3; n++) c[n] = (int)lround(255 * fmin(fmax(srgb[n], 0), 1));
  snprintf(text, 8, "#%02x%02x%02x", c[0] & 255, c[1] & 255, c[2] & 255);
  return text;
}

/* Returns whether the file describes a channel. */
static bool is_told(const hl_volume_channel *channel) {
  return channel->name[0] != '\0' || channel->has_color || isfinite(channel->window[0]);
}

static void print_json_channels(json_writer *json, const hl_volume *volume) {
  hl_volume_channel channel = {.struct_size = sizeof channel};
  char color[8];
  bool any = false;
  for (size_t n = 0; !any && hl_volume_get_channel(volume, n, &channel) == HL_OK; n++)
    any = is_told(&channel);
  if (!any) return;
  json_open_array(json, "channel_list");
  for (size_t n = 0; hl_volume_get_channel(volume, n, &channel) == HL_OK; n++) {
    json_open_object(json, NULL);
    json_text(json, "name", channel.name);
    if (channel.has_color) json_text(json, "color", color_text(channel.srgb, color));
    if (isfinite(channel.window[0])) json_numbers(json, "window", channel.window, 2);
    json_bool(json, "chosen", channel.chosen != 0);
    json_close(json);
  }
  json_close(json);
}

static void print_channels(const hl_volume *volume) {
  hl_volume_channel channel = {.struct_size = sizeof channel};
  char color[8];
  for (size_t n = 0; hl_volume_get_channel(volume, n, &channel) == HL_OK; n++) {
    if (!is_told(&channel)) continue;
    printf("  channel %-3zu %s", n, channel.name);
    if (channel.has_color)
      printf("%s%s", channel.name[0] != '\0' ? ", " : "", color_text(channel.srgb, color));
    if (isfinite(channel.window[0]))
      printf(", shown from %.9g to %.9g", channel.window[0], channel.window[1]);
    printf("\n");
  }
}

static void print_json_segments(json_writer *json, const hl_volume *volume) {
  hl_volume_segment segment = {.struct_size = sizeof segment};
  char color[8];
  if (hl_volume_segment_count(volume) == 0) return;
  json_open_array(json, "segments");
  for (size_t n = 0; hl_volume_get_segment(volume, n, &segment) == HL_OK; n++) {
    json_open_object(json, NULL);
    json_signed_number(json, "value", segment.value);
    json_text(json, "name", segment.name);
    json_whole_number(json, "layer", (uint64_t)segment.layer);
    if (segment.has_color) json_text(json, "color", color_text(segment.srgb, color));
    json_close(json);
  }
  json_close(json);
}

static void print_segments(const hl_volume *volume) {
  hl_volume_segment segment = {.struct_size = sizeof segment};
  char color[8];
  int layers = 0;
  for (size_t n = 0; hl_volume_get_segment(volume, n, &segment) == HL_OK; n++)
    layers = segment.layer > layers ? segment.layer : layers;
  for (size_t n = 0; hl_volume_get_segment(volume, n, &segment) == HL_OK; n++) {
    printf("  %s  %" PRId64 ": %s%s%s", n == 0 ? "segments  " : "          ", segment.value, segment.name,
           segment.name[0] != '\0' && segment.has_color ? ", " : "",
           segment.has_color ? color_text(segment.srgb, color) : "");
    if (layers > 0) printf(", layer %d", segment.layer);
    printf("\n");
  }
}

static void print_label_maps(json_writer *json, const char *path, const hl_volume *volume) {
  const char *name;
  if (hl_volume_label_map(volume, 0) == NULL) return;
  if (json != NULL) json_open_array(json, "label_maps");
  for (size_t n = 0; (name = hl_volume_label_map(volume, n)) != NULL; n++) {
    if (json != NULL) json_text(json, NULL, name);
    else printf("  label map   %s/%s: a volume of its own\n", path, name);
  }
  if (json != NULL) json_close(json);
}

/* Returns whether the list of arrays can be left out, because the file has a single array, whose type and
 * time steps are printed on lines of their own. */
static bool is_plain(const hl_volume *volume, const hl_volume_array *array) {
  hl_volume_selection s = {.struct_size = sizeof s};
  bool steps = hl_volume_get_selection(volume, &s) == HL_OK && array->components == s.times;
  return array->name[0] == '\0' && (array->components == 1 || steps);
}

static void print_arrays(const hl_volume *volume) {
  hl_volume_array array = {.struct_size = sizeof array};
  size_t count = hl_volume_array_count(volume);
  for (size_t n = 0; hl_volume_get_array(volume, n, &array) == HL_OK; n++) {
    if (count == 1 && is_plain(volume, &array)) return;
    printf("  %s  %s%s%s", n == 0 ? "arrays    " : "          ", array.name,
           array.name[0] != '\0' ? ", " : "", hl_voxel_type_name(array.type));
    if (array.components > 1) printf(", %zu components", array.components);
    printf("%s%s", array.of_cells ? ", of cells" : "", array.type == 0 ? ", not read" : "");
    if (array.chosen && array.component == HL_COMPONENT_MAGNITUDE) printf(": the magnitude is shown");
    else if (array.chosen && array.component == HL_COMPONENT_COLOR) printf(": colours, opacity from alpha");
    else if (array.chosen && array.component == HL_COMPONENT_LUMINANCE)
      printf(": colours, opacity from their luminance");
    else if (array.chosen && array.components > 1) printf(": component %d is shown", array.component);
    else if (array.chosen && count > 1) printf(": is shown");
    printf("\n");
  }
}

/* The percentiles that are printed. Between them lie the values that a range of percentiles would show. */
static const double percents[] = {1, 50, 99, 99.9};
enum { PERCENTS = sizeof percents / sizeof *percents };

static void print_json_percentiles(json_writer *json, const double percentiles[PERCENTS]) {
  json_open_object(json, "percentiles");
  for (int n = 0; n < PERCENTS; n++) {
    char name[16];
    snprintf(name, sizeof name, "%g%%", percents[n]);
    json_number(json, name, percentiles[n]);
  }
  json_close(json);
}

static void print_percentiles(const double percentiles[PERCENTS]) {
  printf("  percentiles ");
  for (int n = 0; n < PERCENTS; n++) printf("%s%g%% %.6g", n > 0 ? ", " : "", percents[n], percentiles[n]);
  printf("\n");
}

enum { RANGE_BYTES = 2 * HL_NUMBER_TEXT_BYTES + 8 };

/* Prints the range of data values as JSON, with all digits. */
static void print_json_range(json_writer *json, const hl_volume *volume) {
  char ends[2][HL_NUMBER_TEXT_BYTES], text[RANGE_BYTES];
  if (hl_volume_write_range(volume, 0, ends[0]) != HL_OK ||
      hl_volume_write_range(volume, 1, ends[1]) != HL_OK)
    return;
  snprintf(text, sizeof text, "[%s, %s]", ends[0], ends[1]);
  json_written(json, "range", text);
}

static void print_json_field_error(json_writer *json, const hl_volume *volume) {
  hl_volume_field_error field_error = {.struct_size = sizeof field_error};
  if (hl_volume_get_field_error(volume, &field_error) != HL_OK) return;
  json_open_object(json, "field_error");
  json_number(json, "value", field_error.value);
  json_number(json, "of_range", field_error.of_range);
  json_text(json, "kind", field_error.kind);
  json_text(json, "source", field_error.source);
  json_close(json);
}

static void print_field_error(const hl_volume *volume) {
  hl_volume_field_error e = {.struct_size = sizeof e};
  if (hl_volume_get_field_error(volume, &e) != HL_OK) return;
  info_print_difference("", e.value, e.of_range, e.kind, e.source);
}

static void print_json(json_writer *json, const char *path, const hl_volume *volume, const char *unit,
                       const hl_volume_info *info, const double percentiles[PERCENTS], const char *kind,
                       const char *next) {
  uint64_t dimensions[3] = {info->dimensions[0], info->dimensions[1], info->dimensions[2]};
  json_open_object(json, NULL);
  json_text(json, "file", path);
  json_whole_numbers(json, "dimensions", dimensions, 3);
  json_text(json, "type", hl_voxel_type_name(info->type));
  json_numbers(json, "spacing", info->spacing, 3);
  json_numbers(json, "origin", info->origin, 3);
  json_open_array(json, "direction");
  for (int row = 0; row < 3; row++) json_numbers(json, NULL, info->direction[row], 3);
  json_close(json);
  double low[3], high[3];
  hl_volume_world_box(info, low, high);
  json_open_object(json, "world_box");
  json_numbers(json, "min", low, 3);
  json_numbers(json, "max", high, 3);
  json_close(json);
  json_text(json, "space", hl_space_name(info->space));
  json_text(json, "unit", unit);
  print_json_range(json, volume);
  json_number(json, "mean", info->mean);
  print_json_percentiles(json, percentiles);
  json_whole_number(json, "nonfinite_count", info->nonfinite_count);
  print_json_field_error(json, volume);
  print_json_arrays(json, volume);
  print_json_selection(json, volume);
  print_json_channels(json, volume);
  print_json_series(json, volume);
  print_json_segments(json, volume);
  print_label_maps(json, path, volume);
  json_text(json, "taken_for", kind);
  json_text(json, "next_look", next);
  json_whole_numbers(json, "histogram", info->histogram, HL_HISTOGRAM_BINS);
}

/* Prints a histogram of sixteen bars. The lengths of the bars are logarithmic, because the voxels of air are
 * often a thousand times more numerous than all others. */
static void print_histogram(const hl_volume_info *info) {
  enum { BARS = 16, LONGEST = 40, BINS = HL_HISTOGRAM_BINS / BARS };
  uint64_t count[BARS] = {0}, most = 0, total = 0;
  for (int i = 0; i < HL_HISTOGRAM_BINS; i++) count[i / BINS] += info->histogram[i];
  for (int i = 0; i < BARS; i++) {
    most = count[i] > most ? count[i] : most;
    total += count[i];
  }
  if (total == 0) return;
  double step = (info->range[1] - info->range[0]) / BARS;
  printf("  histogram   (bars are logarithmic)\n");
  for (int i = 0; i < BARS; i++) {
    static const char bar[] = "########################################";
    int length = (int)lround(LONGEST * hl_log1p((double)count[i]) / hl_log1p((double)most));
    printf("  %11.5g  %-*.*s %12" PRIu64 " %7.3f %%\n", info->range[0] + i * step, LONGEST, length, bar,
           count[i], 100 * (double)count[i] / (double)total);
  }
  printf("  %11.5g\n", info->range[1]);
}

/* The text of the volume's least or greatest data value; whole numbers have all their digits. end: 0 for the
 * least value, 1 for the greatest. */
static const char *value_text(const hl_volume *volume, int end, double value,
                              char text[HL_NUMBER_TEXT_BYTES]) {
  bool whole = value == floor(value) && fabs(value) <= 0x1p64;
  if (whole && fabs(value) >= 0x1p53 && hl_volume_write_range(volume, end, text) == HL_OK) return text;
  snprintf(text, HL_NUMBER_TEXT_BYTES, whole ? "%.20g" : "%.9g", value);
  return text;
}

/* Returns whether data of this kind (hl_volume_guess()) may be a scan of a body. */
static bool may_be_body(const char *kind) {
  return strncmp(kind, "scanned", strlen("scanned")) == 0 || strcmp(kind, "vessels") == 0;
}

static void print_text(const char *path, const hl_volume *volume, const char *unit,
                       const hl_volume_info *info, const double percentiles[PERCENTS], const char *kind,
                       const char *next) {
  const double(*d)[3] = info->direction;
  uint64_t voxels = (uint64_t)info->dimensions[0] * info->dimensions[1] * info->dimensions[2];
  printf("%s\n", path);
  printf("  dimensions  %zu x %zu x %zu (%" PRIu64 " voxels)\n", info->dimensions[0], info->dimensions[1],
         info->dimensions[2], voxels);
  printf("  type        %s\n", hl_voxel_type_name(info->type));
  print_arrays(volume);
  print_selection(volume);
  print_channels(volume);
  print_series(volume);
  print_segments(volume);
  print_label_maps(NULL, path, volume);
  printf("  spacing     %.9g, %.9g, %.9g\n", info->spacing[0], info->spacing[1], info->spacing[2]);
  printf("  unit        %s\n",
         unit != NULL ? unit : "not told by the file: --unit mm, or another one, states it");
  printf("  origin      %.9g, %.9g, %.9g\n", info->origin[0], info->origin[1], info->origin[2]);
  for (int axis = 0; axis < 3; axis++)
    printf("  %s      %c: %.9g, %.9g, %.9g\n", axis == 0 ? "axes  " : "      ", "ijk"[axis], d[0][axis],
           d[1][axis], d[2][axis]);
  double low[3], high[3];
  hl_volume_world_box(info, low, high);
  printf("  world box   x %.9g to %.9g, y %.9g to %.9g, z %.9g to %.9g\n", low[0], high[0], low[1], high[1],
         low[2], high[2]);
  if (info->space != HL_SPACE_UNKNOWN) printf("  space       %s\n", hl_space_name(info->space));
  else if (may_be_body(kind))
    printf(
        "  space       not told by the file: --space RAS, or other letters, states the directions of a "
        "body\n");
  char least[HL_NUMBER_TEXT_BYTES], greatest[HL_NUMBER_TEXT_BYTES];
  printf("  range       %s to %s, mean %.9g\n", value_text(volume, 0, info->range[0], least),
         value_text(volume, 1, info->range[1], greatest), info->mean);
  print_percentiles(percentiles);
  if (info->nonfinite_count > 0)
    printf("  not finite  %" PRIu64 " voxels, rendered as transparent\n", info->nonfinite_count);
  print_field_error(volume);
  printf("  taken for   %s: render chooses its look from this file; --print-scene keeps it\n", kind);
  printf("  next best   --look %s\n", next);
  print_histogram(info);
}

int info_tell_volume(cli_host *host, json_writer *json, const char *path, hl_volume *volume, const char *unit,
                     bool labels, const char *table) {
  if (unit == NULL) unit = hl_volume_unit(volume);
  const char *kind = NULL, *next = NULL;
  hl_volume_info info = {.struct_size = sizeof info};
  hl_error error = {0};
  double percentiles[PERCENTS];
  if (hl_volume_get_info(volume, &info) != HL_OK)
    return fail(EXIT_CODE_FAILURE, "%s: the library does not tell what it read", path);
  hl_status status = hl_volume_guess(volume, path, &kind, &error);
  if (status == HL_OK) status = hl_volume_next_look(volume, path, &next, &error);
  if (status == HL_OK) status = hl_volume_percentiles(volume, percents, PERCENTS, percentiles, &error);
  if (status != HL_OK) return host_fail(host, PHASE_RUN, status, &error);
  if (json != NULL) print_json(json, path, volume, unit, &info, percentiles, kind, next);
  else print_text(path, volume, unit, &info, percentiles, kind, next);
  if (labels && (table != NULL || strcmp(kind, "labels") == 0))
    status = info_tell_labels(host->context, json, volume, unit, table, &error);
  if (json != NULL) json_close(json);
  return status == HL_OK ? EXIT_CODE_OK : host_fail(host, PHASE_READ, status, &error);
}
