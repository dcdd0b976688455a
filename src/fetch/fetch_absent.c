/* fetch/fetch_absent.c - refuses to fetch files. It is built in place of fetch.c on systems that lack the
 * functions that fetch.c needs. */
#include <stdio.h>

#include "fetch.h"

hl_status fetch_files(const fetcher *f, const char *url, const char *const *names,
                      const hl_fetch_range *ranges, size_t count, uint64_t most, hl_fetched_file *files,
                      hl_error *error) {
  (void)f, (void)names, (void)ranges, (void)most;
  for (size_t n = 0; n < count; n++) files[n] = (hl_fetched_file){.descriptor = -1};
  snprintf(error->message, sizeof error->message,
           "%.400s: a store on a server, which this system's program does not ask: give the folder of a copy",
           url);
  return HL_ERROR_UNSUPPORTED;
}
