/* platform/windows/include/sys/mman.h - declares the part of POSIX's <sys/mman.h> that maps whole files and
 * memory. */
#ifndef HL_PLATFORM_WINDOWS_SYS_MMAN_H
#define HL_PLATFORM_WINDOWS_SYS_MMAN_H

#include <stddef.h>
#include <sys/types.h>

enum { PROT_READ = 1, PROT_WRITE = 2 };
enum { MAP_SHARED = 1, MAP_PRIVATE = 2, MAP_ANONYMOUS = 32, MAP_NORESERVE = 64 };
enum { MADV_RANDOM, MADV_WILLNEED, MADV_DONTNEED, MADV_NOHUGEPAGE };
#define MAP_FAILED ((void *)-1)

void *mmap(void *address, size_t bytes, int protection, int flags, int descriptor, off_t offset);
int munmap(void *begin, size_t bytes);
/* MADV_DONTNEED lets the system take back the memory of a mapped file. Advice other than MADV_DONTNEED has no
 * effect. */
int madvise(void *begin, size_t bytes, int advice);

#endif
