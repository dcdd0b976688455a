/* platform/macos/include/fcntl.h - <fcntl.h> with Linux's names. */
#ifndef HL_PLATFORM_MACOS_FCNTL_H
#define HL_PLATFORM_MACOS_FCNTL_H

#include_next <fcntl.h>

#include <sys/types.h>

#ifndef O_NOFOLLOW
#define O_NOFOLLOW 0x100 /* the system declares it only if no version of POSIX is asked for */
#endif
#define O_PATH 0 /* 0 opens for reading, because macOS has no descriptors that only name a file */

/* Makes a file at least offset + bytes long, and reserves the space on its disk. Returns an error number or
 * 0. */
int posix_fallocate(int descriptor, off_t offset, off_t bytes);

#endif
