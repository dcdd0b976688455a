/* fetch/asking.c - see asking.h. */
#include "asking.h"

#include <stdio.h>
#include <stdlib.h>

#include "fetch.h"

/* The greatest number of bytes of all copies together. */
static const uint64_t COPIES_LIMIT = (uint64_t)4 << 30;

void fetch_choose_cache_folder(char *folder, size_t bytes) {
  const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
  folder[0] = '\0';
  if (cache != NULL && cache[0] == '/') snprintf(folder, bytes, "%s/halflight", cache);
  else if (home != NULL && home[0] == '/') snprintf(folder, bytes, "%s/.cache/halflight", home);
}

hl_status fetch_if_named(const fetch_permission *permission, const char *url, const char *const *names,
                         const hl_fetch_range *ranges, size_t count, uint64_t most, hl_fetched_file *files,
                         hl_error *error) {
  char cache[1024], folder[1100];
  fetch_choose_cache_folder(cache, sizeof cache);
  if (permission->named && cache[0] != '\0') {
    snprintf(folder, sizeof folder, "%s/servers", cache);
    const fetcher f = {folder, COPIES_LIMIT, permission->cancelled, permission->user_data};
    return fetch_files(&f, url, names, ranges, count, most, files, error);
  }
  if (permission->named) {
    snprintf(error->message, sizeof error->message,
             "%.400s: no place for copies of a server's files: set HOME, or XDG_CACHE_HOME to a folder", url);
    return HL_ERROR_IO;
  }
  snprintf(error->message, sizeof error->message, "%.400s: a URL in a file: servers are asked for %s", url,
           permission->instead);
  return HL_ERROR_UNSUPPORTED;
}
