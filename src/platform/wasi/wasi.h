/* platform/wasi/wasi.h - what the sources ask of POSIX and WASI does not declare: included before each source
 * of a build for WebAssembly.
 *
 * A page has one user. It has no signals, no libraries that are loaded later, and no disk for
 * scratch files. The functions fail as they do on a system that has none left. This header includes no other:
 * sources choose the names that the system's headers declare. */
#ifndef HL_PLATFORM_WASI_WASI_H
#define HL_PLATFORM_WASI_WASI_H

/* A descriptor for a name alone is one for reading: all files of a page may be read. */
#define O_PATH O_RDONLY

#define SIG_SETMASK 2
int sigfillset(unsigned char *signals);
int pthread_sigmask(int how, const unsigned char *signals, unsigned char *before);

long getrandom(void *bytes, unsigned long count, unsigned flags);
unsigned geteuid(void);
int mkstemp(char *path);

#endif
