/* text/edit_distance.h - computes the distance between two names, for suggestions about mistyped names. */
#ifndef HL_TEXT_EDIT_DISTANCE_H
#define HL_TEXT_EDIT_DISTANCE_H

#include <stddef.h>

enum { HL_EDIT_LONGEST = 63 }; /* the greatest number of characters of a name that are compared */

/* The least number of edits that turn a into b. An edit inserts, deletes or replaces a character, or swaps
 * two neighbouring characters. */
int hl_edit_distance(const char *a, const char *b);

/* ---- The known name that is spelled most like an unknown one, for errors ---- */

/* The name in a null-terminated list that is nearest to `name`. Returns null if even the nearest name differs
 * too much. */
const char *hl_nearest_name(const char *name, const char *const *names);

/* Finds the candidate that is nearest to a text. Returns null if no candidate is near. The function
 * candidate(data, n) returns the candidate n, from 0, and null after the last candidate. A candidate that
 * contains the text counts as near. */
const char *hl_nearest_candidate(const char *text, const char *(*candidate)(const void *data, size_t index),
                                 const void *data);

/* Writes the end of an error about an unknown name: the nearest known name as a question, or all known
 * names. */
void hl_suggest_name(const char *name, const char *const *names, char *text, size_t size);

#endif
