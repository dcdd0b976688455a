/* scene/nearest.h - the known name that is spelled most like an unknown one, for errors. */
#ifndef HL_SCENE_NEAREST_H
#define HL_SCENE_NEAREST_H

#include <stddef.h>

/* The nearest of the null-terminated names; null if none is near enough to be meant. */
const char *hl_nearest_name(const char *name, const char *const *names);

/* The end of an error about an unknown name: the nearest known name as a question, or all known names. */
void hl_suggest_name(const char *name, const char *const *names, char *text, size_t size);

#endif
