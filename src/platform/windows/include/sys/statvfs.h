/* platform/windows/include/sys/statvfs.h - declares the part of POSIX's <sys/statvfs.h> that finds the free
 * space on the disk of a file. */
#ifndef HL_PLATFORM_WINDOWS_SYS_STATVFS_H
#define HL_PLATFORM_WINDOWS_SYS_STATVFS_H

#include <sys/types.h>

struct statvfs {
  unsigned long long f_frsize, f_bavail; /* bytes of a unit, and number of units that are free for this
                                          * user */
};
int fstatvfs(int descriptor, struct statvfs *about);

#endif
