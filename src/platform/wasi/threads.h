/* platform/wasi/threads.h - runs the library's threads in a page. WebAssembly's system interface has no
 * threads. A page therefore starts web workers, called helpers, before the library asks for threads. Helpers
 * share the library's memory, and wait until they are needed; each thread of the library runs on one helper.
 *
 * Helpers cannot use files. A caller that opens files allows only one thread meanwhile. */
#ifndef HL_PLATFORM_WASI_THREADS_H
#define HL_PLATFORM_WASI_THREADS_H

#include <stdbool.h>

enum { MOST_HELPERS = 30 };

/* Limits the number of threads in pools, because hl_cpu_count() returns no greater number. threads: the
 * number of threads including the pool's caller. The limit is 1 at first. */
void hl_helpers_allow(int threads);

/* Reports that a helper has started. number: the helper's own number, from 0. Returns false if the number is
 * impossible. */
bool hl_helper_arrive(int number);

/* Runs threads of the library in the web worker of a helper, after hl_helper_arrive(). The function does not
 * return. */
void hl_helper_serve(int number);

/* The number of helpers on which no thread runs. */
int hl_helpers_free(void);

#endif
