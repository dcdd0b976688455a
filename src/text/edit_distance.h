/* text/edit_distance.h - how far apart two names are, for suggestions about mistyped ones. */
#ifndef HL_TEXT_EDIT_DISTANCE_H
#define HL_TEXT_EDIT_DISTANCE_H

#include <stddef.h>

enum { HL_EDIT_LONGEST = 63 }; /* only the first characters of a name are compared, up to this number */

/* The number of edits that turn a into b: insert, delete or replace a character, or swap two neighbours. */
int hl_edit_distance(const char *a, const char *b);

/* ---- The known name that is spelled most like an unknown one, for errors ---- */

/* The name, of a null-terminated list, that is nearest to a given name. Null if no name is near enough to be
 * meant. */
const char *hl_nearest_name(const char *name, const char *const *names);

/* Of candidate(data, 0), candidate(data, 1) and so on, up to the first null: the one that is nearest to the
 * text. A candidate that contains the text is near. Null if none is near. */
const char *hl_nearest_candidate(const char *text, const char *(*candidate)(const void *data, size_t index),
                                 const void *data);

/* Writes the end of an error about an unknown name: the nearest known name as a question, or all known
 * names. */
void hl_suggest_name(const char *name, const char *const *names, char *text, size_t size);

#endif
