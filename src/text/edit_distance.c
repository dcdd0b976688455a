/* text/edit_distance.c - computes the optimal string alignment distance (Damerau 1964), in which each part of
 * a text is edited at most once. */
#define _GNU_SOURCE /* for strnlen() */
#include "text/edit_distance.h"

#include <stdbool.h>
#include <stdio.h>
#include <string.h>

/* Returns whether two letters differ by more than their case. */
static bool differ(char a, char b) {
  if (a >= 'A' && a <= 'Z') a += 'a' - 'A';
  if (b >= 'A' && b <= 'Z') b += 'a' - 'A';
  return a != b;
}

static int least(int a, int b) { return a < b ? a : b; }

/* The least number of edits between two names, by dynamic programming. Only three rows of the table of
 * distances are in memory at a time. */
int hl_edit_distance(const char *a, const char *b) {
  int rows[3][HL_EDIT_LONGEST + 1];
  int length_a = (int)strnlen(a, HL_EDIT_LONGEST), length_b = (int)strnlen(b, HL_EDIT_LONGEST);
  int *before = rows[0], *last = rows[1], *row = rows[2];
  for (int j = 0; j <= length_b; j++) last[j] = j;
  for (int i = 1; i <= length_a; i++) {
    row[0] = i;
    for (int j = 1; j <= length_b; j++) {
      int replace = last[j - 1] + differ(a[i - 1], b[j - 1]);
      row[j] = least(replace, least(last[j], row[j - 1]) + 1);
      if (i > 1 && j > 1 && !differ(a[i - 1], b[j - 2]) && !differ(a[i - 2], b[j - 1]))
        row[j] = least(row[j], before[j - 2] + 1);
    }
    int *spare = before;
    before = last;
    last = row;
    row = spare;
  }
  return last[length_b];
}

/* ---- names for error lines ---- */

const char *hl_nearest_name(const char *name, const char *const *names) {
  const char *nearest = NULL;
  int length = (int)strnlen(name, HL_EDIT_LONGEST),
      allowed = length * 2 / 5; /* a name is suggested if at most two fifths of its letters are wrong */
  int best = 1 + (allowed < 2 && length > 2 ? 2 : allowed);
  for (size_t n = 0; names[n] != NULL; n++) {
    int distance = hl_edit_distance(name, names[n]);
    if (distance >= best) continue;
    best = distance;
    nearest = names[n];
  }
  return nearest;
}

const char *hl_nearest_candidate(const char *text, const char *(*candidate)(const void *data, size_t index),
                                 const void *data) {
  size_t length = strlen(text);
  const char *best = NULL, *name;
  size_t best_distance = 2 + length / 4; /* names at greater distances are not suggested, because such
                                          * suggestions would only confuse users */
  if (length > HL_EDIT_LONGEST) return NULL;
  for (size_t i = 0; (name = candidate(data, i)) != NULL; i++) {
    bool part_of_it = length >= 3 && strstr(name, text) != NULL;
    size_t distance = part_of_it ? 1 : (size_t)hl_edit_distance(text, name);
    if (distance < best_distance && 2 * distance < strlen(name)) {
      best = name;
      best_distance = distance;
    }
  }
  return best;
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
