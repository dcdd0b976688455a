/* platform/windows/include/sys/stat.h - declares the functions of POSIX's <sys/stat.h>, with names in UTF-8,
 * and with 64 bits for sizes and the numbers of files. This header replaces the C library's <sys/stat.h>. */
#ifndef _INC_STAT
#define _INC_STAT

#include <direct.h>
#include <io.h>
#include <sys/types.h>
#include <time.h>
/* this system header declares structs with members of the following names, and must be included before the
 * names become macros */
#include <wchar.h>

struct stat {
  unsigned long long st_dev, st_ino;
  unsigned st_mode, st_uid; /* st_uid: 0, like the result of geteuid() */
  long long st_size;
  struct timespec st_mtim;
};
#define st_mtime st_mtim.tv_sec

#define S_IFMT         0xf000
#define S_IFIFO        0x1000
#define S_IFCHR        0x2000
#define S_IFDIR        0x4000
#define S_IFREG        0x8000
#define S_IFLNK        0xa000
#define S_ISFIFO(mode) (((mode)&S_IFMT) == S_IFIFO)
#define S_ISCHR(mode)  (((mode)&S_IFMT) == S_IFCHR)
#define S_ISDIR(mode)  (((mode)&S_IFMT) == S_IFDIR)
#define S_ISREG(mode)  (((mode)&S_IFMT) == S_IFREG)
#define S_ISLNK(mode)                                                                   \
  (((mode)&S_IFMT) == S_IFLNK) /* also a junction, and a folder where a disk is mounted \
                                */
#define S_ISSOCK(mode) 0
#define S_IRUSR        0400
#define S_IWUSR        0200
#define S_IRWXU        0700
#define S_IRWXG        0070
#define S_IWGRP        0020
#define S_IRWXO        0007
#define S_IWOTH        0002

int hl_posix_stat(const char *path, struct stat *about);
int hl_posix_fstat(int descriptor, struct stat *about);
int hl_posix_fstatat(int folder, const char *path, struct stat *about, int flags);
int hl_posix_mkdir(const char *path, int mode);
#define stat(path, about) hl_posix_stat(path, about)
#define fstat             hl_posix_fstat
#define fstatat           hl_posix_fstatat
#define mkdir             hl_posix_mkdir

#endif
