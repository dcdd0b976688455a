/* platform/macos/include/sys/mman.h - <sys/mman.h> with Linux's advice, which is not heard. */
#ifndef HL_PLATFORM_MACOS_SYS_MMAN_H
#define HL_PLATFORM_MACOS_SYS_MMAN_H

#include_next <sys/mman.h>

#define MADV_NOHUGEPAGE MADV_NORMAL

#endif
