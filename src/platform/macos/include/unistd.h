/* platform/macos/include/unistd.h - extends <unistd.h> by Linux's pipe2(). */
#ifndef HL_PLATFORM_MACOS_UNISTD_H
#define HL_PLATFORM_MACOS_UNISTD_H

#include_next <unistd.h>

/* The name hl_posix_pipe2 avoids a conflict with the pipe2() that macOS 27 has. */
int hl_posix_pipe2(int ends[2], int flags);
#define pipe2 hl_posix_pipe2

#endif
