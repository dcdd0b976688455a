/* platform/linux/program.c - finds the program's own file, to which a link in /proc points. */
#define _GNU_SOURCE
#include "platform/program.h"

#include <unistd.h>

bool hl_program_path(char *path, size_t size) {
  ssize_t length = readlink("/proc/self/exe", path, size);
  if (length < 0 || (size_t)length >= size) return false;
  path[length] = '\0';
  return true;
}
