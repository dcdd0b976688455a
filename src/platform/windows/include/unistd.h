/* platform/windows/include/unistd.h - declares functions of POSIX's <unistd.h>, with names in UTF-8, and with
 * 64 bits for sizes and offsets. */
#ifndef HL_PLATFORM_WINDOWS_UNISTD_H
#define HL_PLATFORM_WINDOWS_UNISTD_H

#include_next <unistd.h>

#include <stddef.h>

/* The functions read() and write() of POSIX. A call reads or writes at most 1 GiB. */
ssize_t hl_posix_read(int descriptor, void *bytes, size_t count);
ssize_t hl_posix_write(int descriptor, const void *bytes, size_t count);
ssize_t pread(int descriptor, void *bytes, size_t count, off_t offset);
ssize_t pwrite(int descriptor, const void *bytes, size_t count, off_t offset);
int pipe2(int ends[2], int flags);
int hl_posix_unlink(const char *path);
int hl_posix_rmdir(const char *path);
int hl_posix_access(const char *path, int mode);
int hl_posix_chdir(const char *path);
char *hl_posix_getcwd(char *path, size_t size);
int hl_posix_isatty(int descriptor);
unsigned geteuid(void);                          /* returns 0, because users have no numbers on Windows */
int symlink(const char *path, const char *name); /* always fails */

enum { _SC_PAGESIZE, _SC_NPROCESSORS_ONLN };
long sysconf(int name);

#define read(descriptor, bytes, count)  hl_posix_read(descriptor, bytes, count)
#define write(descriptor, bytes, count) hl_posix_write(descriptor, bytes, count)
#define unlink                          hl_posix_unlink
#define rmdir                           hl_posix_rmdir
#define access                          hl_posix_access
#define chdir                           hl_posix_chdir
#define getcwd                          hl_posix_getcwd
#define isatty                          hl_posix_isatty

#endif
