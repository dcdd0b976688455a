/* fetch/copies.h - a folder with copies of files from servers, which only the user can read.
 *
 * A copy holds the server's bytes. Lines after them state the URL, the number of bytes, and the condition
 * under which the server is to send the file again. Copies appear whole or not at all. */
#ifndef HL_FETCH_COPIES_H
#define HL_FETCH_COPIES_H

#include "curl.h"

enum { COPIES_PATH_BYTES = 4096 };

/* Makes the folder. If its copies have more than `limit` bytes together, removes those that were not used for
 * longest. */
hl_status copies_open(const char *folder, uint64_t limit, hl_error *error);

/* Opens the copy of a URL. *file: {-1, 0} if there is none. condition: [FETCH_CONDITION_BYTES]. */
void copies_find(const char *folder, const char *url, hl_fetched_file *file, char *condition);

/* Notes that a copy was used. */
void copies_touch(const char *folder, const char *url);

/* Makes an empty file with a new name, into which the server's bytes are to be written. path:
 * [COPIES_PATH_BYTES]. */
hl_status copies_begin(const char *folder, char *path, hl_error *error);

/* Turns a file of copies_begin() into the copy of a URL, and opens it. */
hl_status copies_keep(const char *folder, const char *url, const char *condition, const char *path,
                      hl_fetched_file *file, hl_error *error);

#endif
