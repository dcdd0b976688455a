/* platform/macos/system.c - implements the functions of Linux that macOS lacks. The headers in
 * platform/macos/include declare them. */
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdint.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "platform/processors.h"

int hl_cpu_count(void) {
  long count = sysconf(_SC_NPROCESSORS_ONLN);
  return count > 0 ? (int)count : 1;
}

double hl_cpu_quota(const char *root) {
  (void)root;
  return INFINITY;
}

int posix_fallocate(int descriptor, off_t offset, off_t bytes) {
  struct stat about;
  if (fstat(descriptor, &about) != 0) return errno;
  off_t missing = offset + bytes - about.st_size;
  if (missing <= 0) return 0;
  fstore_t wanted = {.fst_flags = F_ALLOCATEALL, .fst_posmode = F_PEOFPOSMODE, .fst_length = missing};
  if (fcntl(descriptor, F_PREALLOCATE, &wanted) == -1 && errno != ENOTSUP) return errno;
  return ftruncate(descriptor, offset + bytes) == 0 ? 0 : errno;
}

int pipe2(int ends[2], int flags) {
  if (pipe(ends) != 0) return -1;
  for (int n = 0; (flags & O_CLOEXEC) != 0 && n < 2; n++) fcntl(ends[n], F_SETFD, FD_CLOEXEC);
  return 0;
}

ssize_t getrandom(void *bytes, size_t count, unsigned flags) {
  (void)flags;
  return getentropy(bytes, count) == 0 ? (ssize_t)count : -1;
}

#undef getrusage
int hl_posix_getrusage(int who, struct rusage *usage) {
  int result = getrusage(who, usage);
  usage->ru_maxrss /= 1024;
  return result;
}

int prlimit(pid_t process, int what, const struct rlimit *limit, struct rlimit *before) {
  (void)process, (void)what, (void)limit, (void)before;
  errno = ENOSYS;
  return -1;
}
