/* platform/macos/include/fcntl.h - extends <fcntl.h> by Linux's names. */
#ifndef HL_PLATFORM_MACOS_FCNTL_H
#define HL_PLATFORM_MACOS_FCNTL_H

#include_next <fcntl.h>

#include <sys/types.h>

#ifndef O_NOFOLLOW
/* The system declares this name only if the program asks for no version of POSIX. */
#define O_NOFOLLOW 0x100
#endif
/* The value 0 opens a file for reading, because macOS has no descriptors that only name a file. */
#define O_PATH 0

/* Makes a file at least offset + bytes long, and reserves the space on its disk. Returns an error number or
 * 0. */
int posix_fallocate(int descriptor, off_t offset, off_t bytes);

#endif
