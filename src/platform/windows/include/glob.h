/* platform/windows/include/glob.h - declares the part of POSIX's <glob.h> that finds files by a pattern. */
#ifndef HL_PLATFORM_WINDOWS_GLOB_H
#define HL_PLATFORM_WINDOWS_GLOB_H

#include <stddef.h>

typedef struct {
  size_t gl_pathc;
  char **gl_pathv;
} glob_t;

enum { GLOB_NOSPACE = 1, GLOB_ABORTED, GLOB_NOMATCH };

/* Finds the files whose names fit a pattern. pattern: '*', '?' and '[...]' stand for characters within one
 * name, which may be a folder's name. The files are not sorted. flags: must be 0. on_error: must be null. */
int glob(const char *pattern, int flags, int (*on_error)(const char *, int), glob_t *found);
void globfree(glob_t *found);

#endif
