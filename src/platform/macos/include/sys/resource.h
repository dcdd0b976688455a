/* platform/macos/include/sys/resource.h - changes <sys/resource.h> so that memory is given in KiB, as on
 * Linux. */
#ifndef HL_PLATFORM_MACOS_SYS_RESOURCE_H
#define HL_PLATFORM_MACOS_SYS_RESOURCE_H

#include_next <sys/resource.h>

#include <sys/types.h>

int hl_posix_getrusage(int who, struct rusage *usage);
#define getrusage hl_posix_getrusage
/* The function prlimit() always fails on macOS, because the limits of another process cannot be set there. */
int prlimit(pid_t process, int what, const struct rlimit *limit, struct rlimit *before);

#endif
