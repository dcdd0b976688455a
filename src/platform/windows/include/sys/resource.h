/* platform/windows/include/sys/resource.h - the part of POSIX's <sys/resource.h> that tells how much memory a
 * process held at most. */
#ifndef HL_PLATFORM_WINDOWS_SYS_RESOURCE_H
#define HL_PLATFORM_WINDOWS_SYS_RESOURCE_H

struct rusage {
  long ru_maxrss; /* KiB */
};
enum { RUSAGE_SELF };
int getrusage(int who, struct rusage *usage);

#endif
