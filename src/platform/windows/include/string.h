/* platform/windows/include/string.h - extends <string.h> by functions of BSD and GNU. */
#ifndef HL_PLATFORM_WINDOWS_STRING_H
#define HL_PLATFORM_WINDOWS_STRING_H

#include_next <string.h>

char *strsep(char **text, const char *separators);
int strverscmp(const char *a, const char *b);
void *memrchr(const void *bytes, int byte, size_t count);

#endif
