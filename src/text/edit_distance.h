/* text/edit_distance.h - how far apart two names are, for suggestions about mistyped ones. */
#ifndef HL_TEXT_EDIT_DISTANCE_H
#define HL_TEXT_EDIT_DISTANCE_H

enum { HL_EDIT_LONGEST = 63 }; /* longest compared beginning of a name, characters */

/* The number of edits that turn a into b: insert, delete or replace a character, or swap two neighbours. */
int hl_edit_distance(const char *a, const char *b);

#endif
