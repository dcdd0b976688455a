/* platform/windows/include/limits.h - extends <limits.h> by the greatest length of names in UTF-8. */
#include_next <limits.h>

#ifndef HL_PLATFORM_WINDOWS_LIMITS_H
#define HL_PLATFORM_WINDOWS_LIMITS_H

#undef PATH_MAX
#define PATH_MAX 4096
#ifndef NAME_MAX
#define NAME_MAX 255
#endif

#endif
