/* platform/macos/include/string.h - extends <string.h> by GNU's functions. */
#ifndef HL_PLATFORM_MACOS_STRING_H
#define HL_PLATFORM_MACOS_STRING_H

#include_next <string.h>

int strverscmp(const char *a, const char *b);
void *memrchr(const void *bytes, int byte, size_t count);

#endif
