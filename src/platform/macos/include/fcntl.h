/* platform/macos/include/fcntl.h - extends <fcntl.h> by Linux's names. */
#ifndef HL_PLATFORM_MACOS_FCNTL_H
#define HL_PLATFORM_MACOS_FCNTL_H

#include_next <fcntl.h>

#include <sys/types.h>

#ifndef O_NOFOLLOW
/* The header <fcntl.h> of macOS declares O_NOFOLLOW only if the program selects no version of POSIX. */
#define O_NOFOLLOW 0x100
#endif
/* macOS has no descriptors that only name a file; O_PATH is 0, which opens a file for reading. */
#define O_PATH 0

/* Makes a file at least offset + bytes long, and reserves the space on its disk. Returns an error number or
 * 0. */
int posix_fallocate(int descriptor, off_t offset, off_t bytes);

#endif
