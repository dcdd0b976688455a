/* platform/windows/include/fcntl.h - declares the functions of POSIX's <fcntl.h>. Files are opened as binary
 * files, by names in UTF-8. */
#ifndef HL_PLATFORM_WINDOWS_FCNTL_H
#define HL_PLATFORM_WINDOWS_FCNTL_H

#include_next <fcntl.h>

#include <sys/types.h>

#define O_CLOEXEC  _O_NOINHERIT
#define O_NONBLOCK 0 /* has no effect, because open() never waits, and fails for a pipe without a writer */
#define O_NOCTTY   0
/* Flags of hl_posix_open() and hl_posix_openat() that the C library does not have. */
/* O_PATH: the descriptor can only be used by fstat(), and to open files below the folder */
#define O_PATH      0x10000000
#define O_DIRECTORY 0x20000000
#define O_NOFOLLOW  0x40000000 /* opening links, junctions and mounted folders fails with ELOOP */

#define AT_SYMLINK_NOFOLLOW 0x100
#define F_GETFD             1

int hl_posix_open(const char *path, int flags, ...);
/* Opens a file below a folder. path: a path relative to the folder, with '/'. Files with a colon or a
 * backslash in their names are not found. Opening a link fails as with O_NOFOLLOW. */
int hl_posix_openat(int folder, const char *path, int flags, ...);
/* Makes a file at least offset + bytes long. Returns an error number or 0. */
int posix_fallocate(int descriptor, off_t offset, off_t bytes);
int hl_posix_fcntl(int descriptor, int command);
#define open   hl_posix_open
#define openat hl_posix_openat
#define fcntl  hl_posix_fcntl

#endif
