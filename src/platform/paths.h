/* platform/paths.h - how the system's names of files begin. */
#ifndef HL_PLATFORM_PATHS_H
#define HL_PLATFORM_PATHS_H

#include <stdbool.h>

/* Whether a name begins at the root of a file system, or of a drive, and not at the current folder. */
bool hl_path_is_absolute(const char *path);

/* The folder of large temporary files, where the user names none. */
const char *hl_temporary_folder(void);

#endif
