/* platform/wasi/wasi.c - defines the functions of POSIX that WebAssembly lacks (wasi.h). */
#define _GNU_SOURCE /* madvise */
#include "platform/wasi/wasi.h"

#include <errno.h>
#include <math.h>
#include <stddef.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <unistd.h>

#include "platform/processors.h"

/* The tag of the exceptions that longjmp() throws. Code that clang generates refers to this tag, but clang
 * does not define the tag. */
__asm__(".globl __c_longjmp\n.tagtype __c_longjmp i32\n__c_longjmp:\n");

double hl_cpu_quota(const char *root) {
  (void)root;
  return INFINITY;
}

int sigfillset(unsigned char *signals) {
  *signals = 0;
  return 0;
}

int pthread_sigmask(int how, const unsigned char *signals, unsigned char *before) {
  (void)how, (void)signals;
  if (before != NULL) *before = 0;
  return 0;
}

long getrandom(void *bytes, unsigned long count, unsigned flags) {
  (void)flags;
  return getentropy(bytes, count) == 0 ? (long)count : -1;
}

int madvise(void *begin, size_t bytes, int advice) {
  (void)begin, (void)bytes, (void)advice;
  return 0;
}

int prctl(int option, ...) {
  (void)option;
  errno = ENOSYS;
  return -1;
}

unsigned geteuid(void) { return 0; }

int mkstemp(char *path) {
  (void)path;
  errno = ENOSPC;
  return -1;
}
