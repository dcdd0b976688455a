/* compose/coordinates.c - see coordinates.h. */
#include "compose/coordinates.h"

#include <math.h>
#include <string.h>

#include "text/plain.h"

bool hl_read_coordinate(const char **text, hl_coordinate *coordinate) {
  size_t length = strspn(*text, "0123456789+-.eE");
  char *rest;
  *coordinate = (hl_coordinate){.given = length > 0};
  if (length == 0) return true;
  coordinate->number = hl_plain_number(*text, &rest);
  if (rest != *text + length || !isfinite(coordinate->number)) return false;
  *text = rest + (strncmp(rest, "mm", 2) == 0 ? 2 : *rest == 'u' ? 1 : 0);
  coordinate->fraction = *text == rest;
  return !coordinate->fraction || (coordinate->number >= 0 && coordinate->number <= 1);
}

bool hl_read_range(const char **text, hl_axis_range *range) {
  range->axis = **text >= 'x' && **text <= 'z' ? **text - 'x' : -1;
  if (range->axis < 0 || (*text)[1] != '=') return false;
  hl_coordinate *low = &range->ends[0], *high = &range->ends[1];
  *text += 2;
  if (!hl_read_coordinate(text, low) || *(*text)++ != ':' || !hl_read_coordinate(text, high)) return false;
  bool comparable = low->given && high->given && low->fraction == high->fraction;
  return (low->given || high->given) && (!comparable || low->number < high->number);
}

double hl_coordinate_of(const hl_coordinate *end, double otherwise, double low, double high) {
  if (!end->given) return otherwise;
  return end->fraction ? low + end->number * (high - low) : end->number;
}
