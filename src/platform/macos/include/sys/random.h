/* platform/macos/include/sys/random.h - declares the function of Linux's <sys/random.h>. */
#ifndef HL_PLATFORM_MACOS_SYS_RANDOM_H
#define HL_PLATFORM_MACOS_SYS_RANDOM_H

#include_next <sys/random.h>

#include <sys/types.h>

ssize_t getrandom(void *bytes, size_t count, unsigned flags);

#endif
