/* platform/posix/folders.c - see platform/folders.h. */
#include "platform/folders.h"

#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

enum { PATH_BYTES = 4096 };

void hl_private_folder_make(const char *path) {
  char part[PATH_BYTES];
  if (path[0] == '\0' || strlen(path) >= sizeof part) return;
  strcpy(part, path);
  for (char *at = strchr(part + 1, '/'); at != NULL; at = strchr(at + 1, '/')) {
    *at = '\0';
    mkdir(part, 0700);
    *at = '/';
  }
  mkdir(part, 0700);
}
