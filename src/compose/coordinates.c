/* compose/coordinates.c - see coordinates.h. */
#include "compose/coordinates.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/error.h"
#include "text/plain.h"
#include "text/units.h"

/* Reads the name of a unit, if the text begins with a name. Returns false if no unit has the name. */
static bool read_unit(const char **text, hl_coordinate *coordinate) {
  char name[16] = "";
  const size_t length = strcspn(*text, ":,");
  if (length == 0) return true;
  if (length >= sizeof name) return false;
  memcpy(name, *text, length);
  *text += length;
  const hl_unit *unit = strcmp(name, "u") == 0 ? NULL : hl_unit_find(name);
  coordinate->metres = unit != NULL ? unit->metres : 0;
  return unit != NULL || strcmp(name, "u") == 0;
}

bool hl_read_coordinate(const char **text, hl_coordinate *coordinate) {
  size_t length = strspn(*text, "0123456789+-.eE");
  char *rest;
  *coordinate = (hl_coordinate){.given = length > 0};
  if (length == 0) return true;
  coordinate->number = hl_plain_number(*text, &rest);
  if (rest != *text + length || !isfinite(coordinate->number)) return false;
  *text = rest;
  if (!read_unit(text, coordinate)) return false;
  coordinate->fraction = *text == rest;
  return !coordinate->fraction || (coordinate->number >= 0 && coordinate->number <= 1);
}

/* Reads LO:HI. */
static bool read_ends(const char **text, hl_axis_range *range) {
  hl_coordinate *low = &range->ends[0], *high = &range->ends[1];
  if (!hl_read_coordinate(text, low) || *(*text)++ != ':' || !hl_read_coordinate(text, high)) return false;
  bool comparable = low->given && high->given && low->fraction == high->fraction &&
                    low->metres == high->metres;
  return (low->given || high->given) && (!comparable || low->number < high->number);
}

static bool begins_with_axis(const char *text) { return *text >= 'x' && *text <= 'z' && text[1] == '='; }

bool hl_read_range(const char **text, hl_axis_range *range) {
  if (!begins_with_axis(*text)) return false;
  range->axis = **text - 'x';
  *text += 2;
  return read_ends(text, range);
}

bool hl_range_is_given(const hl_axis_range *range) { return range->ends[0].given || range->ends[1].given; }

bool hl_read_box(const char *text, hl_axis_range box[3]) {
  const bool in_order = !begins_with_axis(text);
  int count = 0;
  memset(box, 0, 3 * sizeof *box);
  do {
    hl_axis_range range = {.axis = count};
    if (count == 3 || !(in_order ? read_ends(&text, &range) : hl_read_range(&text, &range))) return false;
    if (hl_range_is_given(&box[range.axis])) return false;
    box[range.axis] = range;
    count++;
  } while (*text++ == ',');
  return text[-1] == '\0' && (!in_order || count == 3);
}

hl_status hl_refuse_side(const char *option, const char *text, hl_error *error) {
  static const char *const sides[3] = {"|left|right|lateral|medial|",
                                       "|front|back|anterior|posterior|ventral|dorsal|",
                                       "|top|bottom|upper|lower|superior|inferior|head|feet|"};
  char word[16];
  const int length = snprintf(word, sizeof word, "|%.*s|", (int)strcspn(text, "=:,-"), text);
  int axis = 0;
  while (axis < 3 && (length >= (int)sizeof word || strstr(sides[axis], word) == NULL)) axis++;
  if (axis == 3) return HL_OK;
  return hl_fail(
      error, HL_ERROR_ARGUMENT,
      "--%s: '%.200s' names a side: give an axis, as --%s %c=0.5: or --%s %c=:0.5 for the two halves "
      "(of a body x goes from side to side, y from front to back and z along it)",
      option, text, option, 'x' + axis, option, 'x' + axis);
}

bool hl_world_box_of(const hl_volume *volume, const char *given, hl_world_box *box) {
  hl_volume_info info = {.struct_size = sizeof info};
  if (hl_volume_get_info(volume, &info) != HL_OK) return false;
  hl_volume_world_box(&info, box->low, box->high);
  box->unit = given != NULL ? given : hl_volume_unit(volume);
  return true;
}

const char *hl_describe_box(const hl_world_box *box, const char *what, char text[HL_BOX_TEXT]) {
  const double *low = box->low, *high = box->high;
  hl_plain_print(text, HL_BOX_TEXT, "the %s goes from %.6g,%.6g,%.6g to %.6g,%.6g,%.6g %.60s", what, low[0],
                 low[1], low[2], high[0], high[1], high[2],
                 box->unit != NULL ? box->unit : "of a unit that is not known (--unit tells it)");
  return text;
}

double hl_metres_of_box(const hl_world_box *box) {
  const hl_unit *unit = box->unit != NULL ? hl_unit_find(box->unit) : NULL;
  return unit != NULL ? unit->metres : 0;
}

double hl_length_of(const hl_coordinate *coordinate, double metres) {
  if (!(metres > 0) || !(coordinate->metres > 0)) return coordinate->number;
  const double ratio = coordinate->metres / metres, times = round(ratio), parts = round(1 / ratio);
  if (fabs(ratio - times) < 1e-9 * ratio) return coordinate->number * times;
  return fabs(1 - parts * ratio) < 1e-9 ? coordinate->number / parts : coordinate->number * ratio;
}

double hl_coordinate_of(const hl_coordinate *end, double otherwise, double low, double high, double metres) {
  if (!end->given) return otherwise;
  return end->fraction ? low + end->number * (high - low) : hl_length_of(end, metres);
}
