/* platform/posix/nameless_file.c - see platform/nameless_file.h. */
#define _GNU_SOURCE
#include "platform/nameless_file.h"

#include <errno.h>
#include <stdlib.h>
#include <unistd.h>

int hl_nameless_file(char *path) {
  int file = mkstemp(path), number = errno;
  if (file >= 0) unlink(path);
  errno = number;
  return file;
}
