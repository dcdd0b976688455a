/* platform/posix/paths.c - see platform/paths.h. */
#include "platform/paths.h"

bool hl_path_is_absolute(const char *path) { return path[0] == '/'; }

const char *hl_temporary_folder(void) { return "/var/tmp"; }
