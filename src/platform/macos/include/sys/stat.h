/* platform/macos/include/sys/stat.h - extends <sys/stat.h> by POSIX's name of the time at which a file was
 * changed. */
#ifndef HL_PLATFORM_MACOS_SYS_STAT_H
#define HL_PLATFORM_MACOS_SYS_STAT_H

#include_next <sys/stat.h>

#define st_mtim st_mtimespec

#endif
