/* platform/macos/include/sys/syscall.h - Linux's <sys/syscall.h>, without numbers: no system call may be made
 * by its number. */
