/* platform/windows/include/sys/resource.h - declares the part of POSIX's <sys/resource.h> that tells the
 * greatest amount of memory that a process has held. */
#ifndef HL_PLATFORM_WINDOWS_SYS_RESOURCE_H
#define HL_PLATFORM_WINDOWS_SYS_RESOURCE_H

struct rusage {
  long ru_maxrss; /* greatest memory of the process in KiB */
};
enum { RUSAGE_SELF };
int getrusage(int who, struct rusage *usage);

#endif
