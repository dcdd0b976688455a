/* scene/nearest.c - the known name nearest to a mistyped one. */
#define _GNU_SOURCE /* strnlen */
#include "scene/nearest.h"

#include <stdio.h>
#include <string.h>

#include "text/edit_distance.h"

const char *hl_nearest_name(const char *name, const char *const *names) {
  const char *nearest = NULL;
  int length = (int)strnlen(name, HL_EDIT_LONGEST),
      allowed = length * 2 / 5; /* two letters of five may be wrong */
  int best = 1 + (allowed < 2 && length > 2 ? 2 : allowed);
  for (size_t n = 0; names[n] != NULL; n++) {
    int distance = hl_edit_distance(name, names[n]);
    if (distance >= best) continue;
    best = distance;
    nearest = names[n];
  }
  return nearest;
}

void hl_suggest_name(const char *name, const char *const *names, char *text, size_t size) {
  const char *nearest = hl_nearest_name(name, names);
  size_t used = 0;
  if (nearest != NULL) {
    snprintf(text, size, "did you mean \"%s\"?", nearest);
    return;
  }
  for (size_t n = 0; names[n] != NULL && used < size; n++)
    used += (size_t)snprintf(text + used, size - used, "%s%s", n == 0 ? "use one of " : ", ", names[n]);
}
