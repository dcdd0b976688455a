/* platform/posix/beneath.c - opens files below a folder (beneath.h). Linux's openat2() resolves a whole name
 * below a folder in one step, so that no other process can put a link into the path meanwhile. */
#define _GNU_SOURCE
#include "platform/beneath.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <string.h>
#include <sys/syscall.h>
#include <unistd.h>
#ifdef SYS_openat2
#include <linux/openat2.h>
#endif

/* Reads the next component of a path, without slashes, and moves *name behind the component. Returns false if
 * the component is too long. */
static int next_component(const char **name, char component[NAME_MAX + 1]) {
  const char *begin = *name + strspn(*name, "/");
  size_t length = strcspn(begin, "/");
  if (length > NAME_MAX) return 0;
  memcpy(component, begin, length);
  component[length] = 0;
  *name = begin + length + strspn(begin + length, "/");
  return 1;
}

int hl_beneath_open_by_components(int folder, const char *name, int flags) {
  enum { ON_THE_WAY = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC };
  int at = openat(folder, ".", ON_THE_WAY);
  if (name[0] == '/' && at >= 0) {
    close(at);
    errno = EXDEV;
    return -1;
  }
  for (char component[NAME_MAX + 1]; at >= 0;) {
    int fits = next_component(&name, component), last = name[0] == 0, next = -1;
    const char *step = component[0] == 0 ? "." : component;
    if (!fits) errno = ENAMETOOLONG;
    else if (strcmp(component, "..") == 0) errno = EXDEV;
    else next = openat(at, step, last ? flags | O_NOFOLLOW | O_CLOEXEC : ON_THE_WAY);
    int problem = errno;
    close(at);
    errno = problem;
    if (last || next < 0) return next;
    at = next;
  }
  return -1;
}

int hl_beneath_open(int folder, const char *name, int flags) {
#ifdef SYS_openat2
  enum { ATTEMPTS = 100 }; /* openat2() fails with EAGAIN if a folder of the path was renamed meanwhile */
  const struct open_how how = {.flags = (unsigned)(flags | O_CLOEXEC),
                               .resolve = RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS};
  for (int attempt = 0; attempt < ATTEMPTS; attempt++) {
    long opened = syscall(SYS_openat2, folder, name[0] != 0 ? name : ".", &how, sizeof how);
    if (opened >= 0) return (int)opened;
    /* an older system does not have openat2(), and some systems forbid unknown calls */
    if (errno == ENOSYS || errno == EPERM) break;
    if (errno != EAGAIN && errno != EINTR) return -1;
  }
#endif
  return hl_beneath_open_by_components(folder, name, flags);
}
