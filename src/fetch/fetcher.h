/* fetch/fetcher.h - defines the parameters of fetching: the folder of copies, and the callback that cancels a
 * run. */
#ifndef HL_FETCH_FETCHER_H
#define HL_FETCH_FETCHER_H

#include <halflight/context.h>

typedef struct fetcher {
  const char *folder; /* the folder of copies; it is made if its parent folder exists */
  uint64_t limit;     /* greatest number of bytes of all copies together; the oldest copies are removed to
                       * keep it */
  int (*cancelled)(void *user_data); /* asked while curl runs */
  void *user_data;
} fetcher;

#endif
