/* platform/macos/include/sys/syscall.h - replaces Linux's <sys/syscall.h>. It defines no numbers, because no
 * system call can be made by its number. */
