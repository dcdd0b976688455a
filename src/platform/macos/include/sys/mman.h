/* platform/macos/include/sys/mman.h - <sys/mman.h> with Linux's kinds of advice, which have no effect here.
 */
#ifndef HL_PLATFORM_MACOS_SYS_MMAN_H
#define HL_PLATFORM_MACOS_SYS_MMAN_H

#include_next <sys/mman.h>

#define MADV_NOHUGEPAGE MADV_NORMAL

#endif
