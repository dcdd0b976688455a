/* cli/nearest.c - the known name nearest to a mistyped one. */
#include "options.h"

#include <string.h>

enum { LONGEST = 40 };

static size_t smallest(size_t a, size_t b) { return a < b ? a : b; }

/* Edits that turn a into b: insert, delete, replace, or swap neighbours (optimal string alignment,
 * three rows of the usual table). Texts longer than LONGEST are far from everything. */
static size_t edit_distance(const char *a, const char *b) {
  size_t a_length = strlen(a), b_length = strlen(b);
  if (a_length > LONGEST || b_length > LONGEST) return LONGEST;
  size_t rows[3][LONGEST + 1];
  for (size_t j = 0; j <= b_length; j++) rows[0][j] = j;
  for (size_t i = 1; i <= a_length; i++) {
    size_t *row = rows[i % 3];
    const size_t *above = rows[(i + 2) % 3], *above_two = rows[(i + 1) % 3];
    row[0] = i;
    for (size_t j = 1; j <= b_length; j++) {
      size_t replaced = above[j - 1] + (a[i - 1] != b[j - 1]);
      row[j] = smallest(replaced, 1 + smallest(above[j], row[j - 1]));
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = smallest(row[j], above_two[j - 2] + 1);
    }
  }
  return rows[a_length % 3][b_length];
}

const char *nearest_name(const char *text, const char *(*candidate)(const void *data, size_t index),
                         const void *data) {
  size_t length = strlen(text);
  const char *best = NULL, *name;
  size_t best_distance = 2 + length / 4; /* farther names would puzzle more than help */
  for (size_t i = 0; (name = candidate(data, i)) != NULL; i++) {
    bool part_of_it = length >= 3 && strstr(name, text) != NULL;
    size_t distance = part_of_it ? 1 : edit_distance(text, name);
    if (distance < best_distance && 2 * distance < strlen(name)) {
      best = name;
      best_distance = distance;
    }
  }
  return best;
}
