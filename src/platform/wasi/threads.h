/* platform/wasi/threads.h - runs the library's threads in a page. WebAssembly's system interface has no
 * threads. A page therefore starts web workers, called helpers, before the library asks for threads. Helpers
 * share the library's memory, and wait until they are needed; each thread of the library runs on one helper.
 *
 * Helpers cannot use files. While a caller opens files, it allows only one thread. */
#ifndef HL_PLATFORM_WASI_THREADS_H
#define HL_PLATFORM_WASI_THREADS_H

#include <stdbool.h>

enum { MOST_HELPERS = 30 };

/* Limits the number of threads in pools: hl_cpu_count() returns no greater number. threads: includes the
 * caller of a pool. The limit is 1 at first. */
void hl_helpers_allow(int threads);

/* Reports that a helper has started. number: each helper has its own number, from 0 on. Returns false if the
 * number is impossible. */
bool hl_helper_arrive(int number);

/* Runs threads of the library, in the worker of a helper, after hl_helper_arrive(). Does not return. */
void hl_helper_serve(int number);

/* The number of helpers on which no thread runs. */
int hl_helpers_free(void);

#endif
