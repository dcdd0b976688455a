/* platform/windows/include/stdio.h - changes <stdio.h> so that names of files are in UTF-8, files are binary,
 * and rename() can replace an existing file. */
#ifndef HL_PLATFORM_WINDOWS_STDIO_H
#define HL_PLATFORM_WINDOWS_STDIO_H

#include_next <stdio.h>

FILE *hl_posix_fopen(const char *path, const char *mode);
int hl_posix_rename(const char *from, const char *to);
FILE *hl_posix_tmpfile(void);
#undef fopen
#define fopen  hl_posix_fopen
#define rename hl_posix_rename
#undef tmpfile
#define tmpfile hl_posix_tmpfile

#endif
