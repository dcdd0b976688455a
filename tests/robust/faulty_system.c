/* tests/robust/faulty_system.c - the system's allocator, which other libraries and the C library use, fails
 * as the context's does. Linked into a program, it takes the place of malloc and its like. */
#define _GNU_SOURCE
#include <errno.h>
#include <stdlib.h>

#include "faulty.h"

void *__libc_malloc(size_t size);
void *__libc_calloc(size_t count, size_t size);
void *__libc_realloc(void *old, size_t size);

__attribute__((visibility("default"))) void *malloc(size_t size) {
  if (!faulty_system_strikes()) return __libc_malloc(size);
  errno = ENOMEM;
  return NULL;
}

__attribute__((visibility("default"))) void *calloc(size_t count, size_t size) {
  if (!faulty_system_strikes()) return __libc_calloc(count, size);
  errno = ENOMEM;
  return NULL;
}

__attribute__((visibility("default"))) void *realloc(void *old, size_t size) {
  if (!faulty_system_strikes()) return __libc_realloc(old, size);
  errno = ENOMEM;
  return NULL;
}
