/* platform/windows/include/locale.h - extends <locale.h> by the part of POSIX's locales that text/plain.c
 * uses. The only object is the locale "C". */
#ifndef HL_PLATFORM_WINDOWS_LOCALE_H
#define HL_PLATFORM_WINDOWS_LOCALE_H

#include_next <locale.h>

typedef void *locale_t;
#define LC_ALL_MASK 0x1f
locale_t newlocale(int mask, const char *name, locale_t base);
/* Sets the calling thread's locale. Returns an object that stands for the thread's previous locale; a second
 * call with this object restores it. */
locale_t uselocale(locale_t locale);
double strtod_l(const char *text, char **end, locale_t locale);

#endif
