/* text/stem.h - finds the name that a volume or a mesh gets from its file's name. */
#ifndef HL_TEXT_STEM_H
#define HL_TEXT_STEM_H

#include <stddef.h>
#include <string.h>

/* Finds the part of a path without folder and extensions, which often names the file's content: "head" in
 * scans/head.nii.gz. Returns the part's begin; *length: the part's length, 0 if the path has no such part. */
static inline const char *hl_stem(const char *path, size_t *length) {
  const char *slash = strrchr(path, '/'), *base = slash != NULL ? slash + 1 : path;
  const char *dot = base[0] != '\0' ? strchr(base + 1, '.') : NULL;
  *length = dot != NULL ? (size_t)(dot - base) : strlen(base);
  return base;
}

#endif
