/* platform/wasi/wasi.h - declares the names of POSIX that the sources use but that WASI does not declare. A
 * build for WebAssembly includes this header before each source.
 *
 * A web page has one user, no signals, no libraries that are loaded later, and no disk for scratch files. The
 * functions for signals, libraries and scratch files fail, as on a system that has no more signals, libraries
 * or disk space. This header includes no other header, because each source chooses which names the system's
 * headers declare. */
#ifndef HL_PLATFORM_WASI_WASI_H
#define HL_PLATFORM_WASI_WASI_H

/* WASI has no descriptors that only name a file. O_PATH is O_RDONLY, because all files of a web page may be
 * read. */
#define O_PATH O_RDONLY

#define SIG_SETMASK 2
int sigfillset(unsigned char *signals);
int pthread_sigmask(int how, const unsigned char *signals, unsigned char *before);

long getrandom(void *bytes, unsigned long count, unsigned flags);
unsigned geteuid(void);
int mkstemp(char *path);

#endif
