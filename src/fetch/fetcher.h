/* fetch/fetcher.h - what fetching needs to know of its caller. */
#ifndef HL_FETCH_FETCHER_H
#define HL_FETCH_FETCHER_H

#include <halflight/context.h>

typedef struct fetcher {
  const char *folder; /* the folder of copies, which is made where its parent folder is there */
  uint64_t limit;     /* in bytes; older copies are removed if all copies together have more */
  int (*cancelled)(void *user_data); /* asked while curl runs */
  void *user_data;
} fetcher;

#endif
