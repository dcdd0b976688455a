/* platform/windows/include/sys/syscall.h - replaces Linux's <sys/syscall.h>. The header defines no numbers,
 * because programs cannot make system calls by their numbers on Windows. */
