/* json/range.c - reads the range of values over which a transfer function spreads: data values or
 * percentiles, evenly or by logarithms. */
#include <stdlib.h>
#include <string.h>

#include "json/parts.h"
#include "text/plain.h"
#include "volume/volume.h"

/* Returns whether a value is a text like "99.5%". */
static bool is_percentage(const json_t *value, double *percent) {
  const char *text = json_string_value(value);
  size_t digits = text != NULL ? strspn(text, "0123456789.") : 0;
  if (digits == 0 || strcmp(text + digits, "%") != 0) return false;
  char *end = NULL;
  *percent = hl_plain_number(text, &end);
  return end == text + digits && *percent >= 0 && *percent <= 100;
}

static hl_status read_end(hl_json_reader *reader, const json_t *value, const hl_volume *volume, double *end) {
  double percent;
  if (json_is_number(value)) return *end = json_number_value(value), HL_OK;
  if (!is_percentage(value, &percent))
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL,
                        "is no number and no percentile: give a data value, or \"0%%\" to \"100%%\"");
  if (volume == NULL)
    return hl_json_fail(reader, HL_ERROR_INPUT, NULL,
                        "is a percentile, which needs a volume: use it in a scene");
  hl_status status = hl_volume_percentiles(volume, &percent, 1, end, reader->error);
  if (status != HL_OK) hl_json_prefix(reader, reader->place);
  return status;
}

static hl_status read_ends(hl_json_reader *reader, const json_t *value, const hl_volume *volume,
                           double ends[2]) {
  size_t mark = hl_json_enter(reader, "range");
  hl_status status = hl_json_array(reader, value, 2, 2);
  for (size_t n = 0; status == HL_OK && n < 2; n++) {
    size_t inner = hl_json_enter_index(reader, n);
    status = read_end(reader, json_array_get(value, n), volume, &ends[n]);
    if (status == HL_OK) hl_json_leave(reader, inner);
  }
  if (status == HL_OK && !(ends[0] < ends[1]))
    status = hl_json_fail(reader, HL_ERROR_INPUT, NULL,
                          "%.9g to %.9g is empty: give two values, the lower one first", ends[0], ends[1]);
  if (status == HL_OK) hl_json_leave(reader, mark);
  return status;
}

hl_status hl_json_read_range(hl_json_reader *reader, const json_t *value, const hl_volume *volume,
                             hl_json_range *range) {
  static const char *const scales[] = {"linear", "log", NULL};
  const json_t *ends = json_object_get(value, "range");
  int scale = HL_RANGE_LINEAR;
  *range = (hl_json_range){.given = ends != NULL || json_object_get(value, "scale") != NULL, .ends = {0, 1}};
  if (volume != NULL && volume->maximum > volume->minimum)
    range->ends[0] = volume->minimum, range->ends[1] = volume->maximum;
  hl_status status = ends != NULL ? read_ends(reader, ends, volume, range->ends) : HL_OK;
  if (status == HL_OK) status = hl_json_choice(reader, value, "scale", scales, HL_RANGE_LINEAR, &scale);
  range->scale = (hl_range_scale)scale;
  if (status == HL_OK && scale == HL_RANGE_LOG && !(range->ends[0] > 0))
    return hl_json_fail(reader, HL_ERROR_INPUT, "scale",
                        "\"log\" needs a range above 0, and %.9g to %.9g is not: give another \"range\"",
                        range->ends[0], range->ends[1]);
  return status;
}
