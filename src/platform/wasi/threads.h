/* platform/wasi/threads.h - the threads of a page. WebAssembly's system interface has no threads. A page
 * therefore starts workers, the helpers, before the library asks for threads. Helpers share one memory and
 * wait in it; each thread of the library runs on one helper.
 *
 * Helpers cannot use files. While a caller opens files, it allows one thread alone. */
#ifndef HL_PLATFORM_WASI_THREADS_H
#define HL_PLATFORM_WASI_THREADS_H

#include <stdbool.h>

enum { MOST_HELPERS = 30 };

/* Limits the threads of pools: hl_cpu_count() tells no greater number. threads: the caller of a pool counts
 * as one. The limit is 1 at the beginning. */
void hl_helpers_allow(int threads);

/* Says that a helper has started. number: from 0 on, another one for each helper. False if there is no such
 * number. */
bool hl_helper_arrive(int number);

/* Runs in a helper's worker, after hl_helper_arrive(), and does not return: runs threads of the library. */
void hl_helper_serve(int number);

/* The number of helpers that run no thread. */
int hl_helpers_free(void);

#endif
