/* platform/windows/include/stdlib.h - extends <stdlib.h> by POSIX's functions that take names, in UTF-8. */
#ifndef HL_PLATFORM_WINDOWS_STDLIB_H
#define HL_PLATFORM_WINDOWS_STDLIB_H

#include_next <stdlib.h>

/* Finds the absolute name of a file, with '/' between folders. resolved: [PATH_MAX], or null for a block of
 * malloc(). */
char *realpath(const char *path, char *resolved);
char *hl_posix_mkdtemp(char *path);
/* The value of a variable of the environment in UTF-8. The text stays valid until the process ends. */
char *hl_posix_getenv(const char *name);
#define mkdtemp hl_posix_mkdtemp
#define getenv  hl_posix_getenv

#endif
