/* scene/nearest.h - the known name that a mistyped one is nearest to, for error lines. */
#ifndef HL_SCENE_NEAREST_H
#define HL_SCENE_NEAREST_H

#include <stddef.h>

#include "core/error.h"

/* name_at(0..) lists the known names, null past the last. Null if none is near enough to be meant. */
const char *hl_nearest_name(const char *name, const char *(*name_at)(size_t index));

/* "unknown KIND "NAME": did you mean "NEAREST"?" or, where none is near, all that there are. */
hl_status hl_fail_name(hl_error *error, hl_status code, const char *kind, const char *name,
                       const char *(*name_at)(size_t index));

/* Edits (insert, delete, replace, swap neighbours) that turn a into b; lengths beyond 63 are cut. */
int hl_edit_distance(const char *a, const char *b);

#endif
