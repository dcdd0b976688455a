/* json/file_names.h - what a scene's text calls a file that lies beside the text. */
#ifndef HL_JSON_FILE_NAMES_H
#define HL_JSON_FILE_NAMES_H

#include <limits.h>
#include <stdbool.h>

/* Finds a folder's absolute path without links, with a '/' at its end. "": the current folder. False: there
 * is none. */
bool hl_json_find_folder(const char *folder, char found[PATH_MAX]);

/* The name of a file relative to such a folder, in `name`, or `file` itself, where it is neither in the
 * folder nor below. The file may be a link; it need not be there. */
const char *hl_json_name_from(const char *folder, const char *file, char name[PATH_MAX]);

#endif
