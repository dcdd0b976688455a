/* platform/macos/include/sys/mman.h - extends <sys/mman.h> by Linux's kinds of advice, which have no effect
 * on this system. */
#ifndef HL_PLATFORM_MACOS_SYS_MMAN_H
#define HL_PLATFORM_MACOS_SYS_MMAN_H

#include_next <sys/mman.h>

#define MADV_NOHUGEPAGE MADV_NORMAL

#endif
