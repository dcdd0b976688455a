/* fetch/fetch.h - fetches files of a store on a web server, or parts of files, by the program curl, and keeps
 * them in a folder of copies.
 *
 * In: the store's URL and names in it. Out: descriptors of copies. A copy is used again only if the server
 * says that its file has not changed since. */
#ifndef HL_FETCH_FETCH_H
#define HL_FETCH_FETCH_H

#include "fetcher.h"

/* Fetches files or parts of them, as hl_context_options.fetch must do. The caller owns the descriptors, also
 * after a failure; a descriptor is -1 if its file was not received. */
hl_status fetch_files(const fetcher *f, const char *url, const char *const *names,
                      const hl_fetch_range *ranges, size_t count, uint64_t most, hl_fetched_file *files,
                      hl_error *error);

#endif
