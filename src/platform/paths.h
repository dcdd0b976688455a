/* platform/paths.h - tests whether names of files are absolute, and finds the folder of temporary files. */
#ifndef HL_PLATFORM_PATHS_H
#define HL_PLATFORM_PATHS_H

#include <stdbool.h>

/* Returns whether a name begins at the root of a file system or of a drive, so that it does not depend on the
 * current folder. */
bool hl_path_is_absolute(const char *path);

/* The folder in which large temporary files are put if the user names no folder. */
const char *hl_temporary_folder(void);

#endif
