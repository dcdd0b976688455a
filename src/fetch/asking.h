/* fetch/asking.h - which servers the program and the Python package ask, and where copies of files lie.
 *
 * Only a store whose URL the user named is asked. A URL that a file names is refused. */
#ifndef HL_FETCH_ASKING_H
#define HL_FETCH_ASKING_H

#include <stdbool.h>

#include <halflight/context.h>

typedef struct fetch_permission {
  bool named;          /* the user named the URL */
  const char *instead; /* for the refusal of other URLs: which servers are asked, and what to do */
  int (*cancelled)(void *user_data); /* asked while files are fetched */
  void *user_data;
} fetch_permission;

/* Fetches files of a store, as hl_context_options.fetch must do, or refuses to. */
hl_status fetch_if_named(const fetch_permission *permission, const char *url, const char *const *names,
                         size_t count, uint64_t most, hl_fetched_file *files, hl_error *error);

/* The user's folder for files that can be made again, [bytes]; empty where the environment tells none. */
void fetch_choose_cache_folder(char *folder, size_t bytes);

#endif
