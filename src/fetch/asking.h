/* fetch/asking.h - decides which servers the program and the Python package ask, and chooses the folder for
 * copies of files.
 *
 * A server is asked only if the user named its URL. A URL that stands in a file is refused. */
#ifndef HL_FETCH_ASKING_H
#define HL_FETCH_ASKING_H

#include <stdbool.h>

#include <halflight/context.h>

typedef struct fetch_permission {
  bool named;          /* whether the user named the URL */
  const char *instead; /* a text for the error that refuses a URL in a file: it says which servers are asked,
                        * and gives the user advice */
  int (*cancelled)(void *user_data); /* asked while files are fetched */
  void *user_data;
} fetch_permission;

/* Fetches files of a store, as hl_context_options.fetch must do. Fails if the user did not name the URL. */
hl_status fetch_if_named(const fetch_permission *permission, const char *url, const char *const *names,
                         const hl_fetch_range *ranges, size_t count, uint64_t most, hl_fetched_file *files,
                         hl_error *error);

/* Writes the user's cache folder for Halflight to `folder`, which has room for `bytes` bytes. The text is
 * empty if the environment names no such folder. */
void fetch_choose_cache_folder(char *folder, size_t bytes);

#endif
