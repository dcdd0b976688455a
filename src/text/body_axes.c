/* text/body_axes.c - see body_axes.h. */
#include "text/body_axes.h"

#include <string.h>

bool hl_body_axes_read(const char *text, int axis[3], double sign[3]) {
  static const char letters[] = "RLAPSIrlapsi"; /* along x, against x, along y, ... */
  bool found[3] = {false};
  if (strlen(text) != 3) return false;
  for (int n = 0; n < 3; n++) {
    const char *place = strchr(letters, text[n]);
    if (place == NULL) return false;
    const int number = (int)(place - letters) % 6;
    axis[n] = number / 2;
    sign[n] = number % 2 == 0 ? 1 : -1;
    if (found[axis[n]]) return false;
    found[axis[n]] = true;
  }
  return true;
}
