/* platform/windows/include/sys/random.h - declares the function of Linux's <sys/random.h>. */
#ifndef HL_PLATFORM_WINDOWS_SYS_RANDOM_H
#define HL_PLATFORM_WINDOWS_SYS_RANDOM_H

#include <sys/types.h>

ssize_t getrandom(void *bytes, size_t count, unsigned flags);

#endif
