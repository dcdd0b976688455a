/* platform/macos/include/stdlib.h - extends <stdlib.h> by the functions of POSIX's locales. */
#ifndef HL_PLATFORM_MACOS_STDLIB_H
#define HL_PLATFORM_MACOS_STDLIB_H

#include_next <stdlib.h>

#include <xlocale.h>

#endif
