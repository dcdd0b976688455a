/* fetch/copies.h - keeps a folder of copies of files on servers, and of parts of such files. Only the user
 * can read the folder.
 *
 * A copy is a file that holds the server's bytes and, after them, lines that describe these bytes: the key (a
 * URL and, for a part of a file, '#' and the range), the condition under which the server should send the
 * bytes again, the number of bytes, and their position in the server's file. A copy appears in the folder
 * only when it is complete. */
#ifndef HL_FETCH_COPIES_H
#define HL_FETCH_COPIES_H

#include "curl.h"

enum { COPIES_PATH_BYTES = 4096, COPIES_KEY_BYTES = FETCH_URL_BYTES + RANGE_BYTES + 2 };

/* Makes the folder. If its copies have more than `limit` bytes together, removes the copies that have not
 * been used for the longest time. */
hl_status copies_open(const char *folder, uint64_t limit, hl_error *error);

/* Opens the copy of a key. file->descriptor is -1 if there is no copy. file->state is set to 0. condition:
 * [FETCH_CONDITION_BYTES]. */
void copies_find(const char *folder, const char *key, hl_fetched_file *file, char *condition);

/* Notes that a copy was used. */
void copies_touch(const char *folder, const char *key);

/* Makes an empty file with a new name, into which the server's bytes will be written. path:
 * [COPIES_PATH_BYTES]. */
hl_status copies_begin(const char *folder, char *path, hl_error *error);

/* Turns a file of copies_begin() into the copy of a key, and opens it. In: `size`, `begin` and `whole` of
 * *file. Out: its descriptor. */
hl_status copies_keep(const char *folder, const char *key, const char *condition, const char *path,
                      hl_fetched_file *file, hl_error *error);

#endif
