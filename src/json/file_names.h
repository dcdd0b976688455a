/* json/file_names.h - the name by which a scene's text calls a file that lies beside the text. */
#ifndef HL_JSON_FILE_NAMES_H
#define HL_JSON_FILE_NAMES_H

#include <limits.h>
#include <stdbool.h>

/* Finds a folder's absolute path without links, ending in '/'. "" is the current folder. False if there is no
 * such folder. */
bool hl_json_find_folder(const char *folder, char found[PATH_MAX]);

/* The name of a file relative to a folder from hl_json_find_folder(), written to `name`. The result is `file`
 * itself where the file is neither in the folder nor below. The file may be a link, and need not exist. */
const char *hl_json_name_from(const char *folder, const char *file, char name[PATH_MAX]);

#endif
