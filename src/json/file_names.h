/* json/file_names.h - finds names of files relative to the folder of the scene's text that contains them. */
#ifndef HL_JSON_FILE_NAMES_H
#define HL_JSON_FILE_NAMES_H

#include <limits.h>
#include <stdbool.h>

/* Finds a folder's absolute path without links, ending in '/'. "" is the current folder. Returns false if
 * there is no such folder. */
bool hl_json_find_folder(const char *folder, char found[PATH_MAX]);

/* Finds the name of a file relative to a folder, which hl_json_find_folder() gave. The name is written to
 * `name`. If the file is not in the folder or in one of its subfolders, the result is `file` itself. The file
 * may be a link, and need not exist. */
const char *hl_json_name_from(const char *folder, const char *file, char name[PATH_MAX]);

#endif
