/* platform/macos/include/locale.h - extends <locale.h> by POSIX's locales. */
#ifndef HL_PLATFORM_MACOS_LOCALE_H
#define HL_PLATFORM_MACOS_LOCALE_H

#include_next <locale.h>

#include <xlocale.h>

#endif
