/* tests/robust/faulty_system.c - the system's allocator, which the C library and other libraries use, fails
 * as the context's allocator does. A program that is linked with this file calls it in place of malloc() and
 * its like. Calls of libtiff do not fail, since TIFFReadDirectory() follows a null pointer if malloc() fails
 * in it (4.5.0). */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "faulty.h"

/* Whether an allocation is to fail. caller: an address in the code that asks for memory. */
static bool fails_for(const void *caller) {
  Dl_info library;
  if (!faulty_system_at_work()) return false;
  if (dladdr(caller, &library) != 0 && strstr(library.dli_fname, "libtiff") != NULL) return false;
  return faulty_system_strikes();
}

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

__attribute__((visibility("default"))) void *malloc(size_t size) {
  if (!fails_for(__builtin_return_address(0))) return __libc_malloc(size);
  errno = ENOMEM;
  return NULL;
}

__attribute__((visibility("default"))) void *calloc(size_t count, size_t size) {
  if (!fails_for(__builtin_return_address(0))) return __libc_calloc(count, size);
  errno = ENOMEM;
  return NULL;
}

__attribute__((visibility("default"))) void *realloc(void *old, size_t size) {
  if (!fails_for(__builtin_return_address(0))) return __libc_realloc(old, size);
  errno = ENOMEM;
  return NULL;
}
