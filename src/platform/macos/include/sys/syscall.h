/* platform/macos/include/sys/syscall.h - Linux's <sys/syscall.h>: no system call has a number that may be
 * used. */
