/* fetch/copies.h - a folder of copies of files on servers, the user's alone.
 *
 * A copy is a file that holds the server's bytes and, after them, lines that name their URL, their length and
 * the condition under which the server is to send them again. Copies appear whole or not at all. */
#ifndef HL_FETCH_COPIES_H
#define HL_FETCH_COPIES_H

#include "curl.h"

enum { COPIES_PATH_BYTES = 4096 };

/* Makes the folder, and removes the copies that were not used for longest until all have at most `limit`
 * bytes. */
hl_status copies_open(const char *folder, uint64_t limit, hl_error *error);

/* Opens the copy of a URL. *file: {-1, 0} if there is none. condition: [FETCH_CONDITION_BYTES]. */
void copies_find(const char *folder, const char *url, hl_fetched_file *file, char *condition);

/* Notes that a copy was used. */
void copies_touch(const char *folder, const char *url);

/* Makes an empty file for new bytes, with a name of its own. path: [COPIES_PATH_BYTES]. */
hl_status copies_begin(const char *folder, char *path, hl_error *error);

/* Turns a file of copies_begin() into the copy of a URL, and opens it. */
hl_status copies_keep(const char *folder, const char *url, const char *condition, const char *path,
                      hl_fetched_file *file, hl_error *error);

#endif
