/* platform/wasi/wasi.h - declares the names of POSIX that the sources use but that WASI does not declare. It
 * is included before each source of a build for WebAssembly.
 *
 * A page has one user. There are no signals, no libraries that are loaded later, and no disk for scratch
 * files. The functions for these things fail, as on a system that has no more of them. This header includes
 * no other header, because each source chooses which names the system's headers declare. */
#ifndef HL_PLATFORM_WASI_WASI_H
#define HL_PLATFORM_WASI_WASI_H

/* WASI has no descriptors that only name a file. A descriptor for reading serves as well, because all files
 * of a page may be read. */
#define O_PATH O_RDONLY

#define SIG_SETMASK 2
int sigfillset(unsigned char *signals);
int pthread_sigmask(int how, const unsigned char *signals, unsigned char *before);

long getrandom(void *bytes, unsigned long count, unsigned flags);
unsigned geteuid(void);
int mkstemp(char *path);

#endif
