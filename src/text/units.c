/* text/units.c - defines the units of length and their names, and chooses a unit for a length. */
#include "text/units.h"

#include <math.h>
#include <string.h>

#include "elementary/elementary.h"

/* The units of length, from the longest to the shortest. "\u00b5" is the micro sign, "\u03bc" the Greek
 * letter. */
static const hl_unit units[] = {
    {"Mpc", {"Mpc"}, 3.0856775814913673e22, 0},
    {"kpc", {"kpc"}, 3.0856775814913673e19, 0},
    {"pc", {"pc"}, 3.0856775814913673e16, 0},
    {"km", {"km", "kilometre", "kilometer"}, 1e3, 1},
    {"m", {"m", "metre", "meter"}, 1, 1},
    {"cm", {"cm", "centimetre", "centimeter"}, 1e-2, 0},
    {"mm", {"mm", "millimetre", "millimeter"}, 1e-3, 1},
    {"\u00b5m", {"um", "micrometre", "micrometer"}, 1e-6, 1},
    {"\u00b5m", {"\u00b5m", "\u03bcm", "micron"}, 1e-6, 0},
    {"nm", {"nm", "nanometre", "nanometer"}, 1e-9, 1},
    {"\u00c5", {"A", "angstrom", "\u00c5"}, 1e-10, 0},
    {"pm", {"pm", "picometre", "picometer"}, 1e-12, 1},
};
enum { UNIT_COUNT = sizeof units / sizeof *units };

const hl_unit *hl_unit_find(const char *name) {
  for (size_t u = 0; u < UNIT_COUNT; u++)
    for (int n = 0; n < 3 && units[u].names[n] != NULL; n++)
      if (strcmp(name, units[u].names[n]) == 0) return &units[u];
  return NULL;
}

double hl_length_ratio(double metres, double other_metres) {
  const double ratio = metres / other_metres, times = round(ratio), parts = round(1 / ratio);
  if (fabs(ratio - times) < 1e-9 * ratio) return times;
  return fabs(1 - parts * ratio) < 1e-9 ? 1 / parts : ratio;
}

double hl_unit_ratio(const char *from, const char *to) {
  const hl_unit *one = from != NULL ? hl_unit_find(from) : NULL,
                *other = to != NULL ? hl_unit_find(to) : NULL;
  return one != NULL && other != NULL ? hl_length_ratio(one->metres, other->metres) : 1;
}

const hl_unit *hl_unit_for(double metres) {
  const hl_unit *found = NULL;
  for (size_t u = 0; u < UNIT_COUNT; u++) {
    if (!units[u].chosen) continue;
    found = &units[u];
    if (metres >= units[u].metres * (1 - 1e-9)) break;
  }
  return found;
}

double hl_round_length(double most) {
  static const double steps[] = {5, 2, 1};
  double power = hl_pow(10, floor(hl_log10(most)));
  for (int s = 0; s < 3; s++)
    if (steps[s] * power <= most * (1 + 1e-9)) return steps[s] * power;
  return power;
}
