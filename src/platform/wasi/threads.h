/* platform/wasi/threads.h - the threads of a page. WebAssembly's system interface has none: a page starts
 * workers of its own, the helpers, before the library asks for threads. Each helper waits in the memory that
 * all of them share, and a thread of the library runs on one of them.
 *
 * Helpers have no files. A caller that opens files allows one thread meanwhile. */
#ifndef HL_PLATFORM_WASI_THREADS_H
#define HL_PLATFORM_WASI_THREADS_H

#include <stdbool.h>

enum { MOST_HELPERS = 30 };

/* The most threads of a pool, its caller included: hl_cpu_count() tells no more. At the beginning 1. */
void hl_helpers_allow(int threads);

/* Says that a helper is there. number: from 0, each once. False: there is no such number. */
bool hl_helper_arrive(int number);

/* Runs in a helper's worker, after hl_helper_arrive(), and does not return: runs threads of the library. */
void hl_helper_serve(int number);

/* The number of helpers that run no thread. */
int hl_helpers_free(void);

#endif
