/* platform/macos/program.c - finds the program's own file, whose path the dynamic linker knows. */
#include "platform/program.h"

#include <limits.h>
#include <mach-o/dyld.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

bool hl_program_path(char *path, size_t size) {
  char told[PATH_MAX], resolved[PATH_MAX];
  uint32_t room = sizeof told;
  if (_NSGetExecutablePath(told, &room) != 0 || realpath(told, resolved) == NULL) return false;
  size_t bytes = strlen(resolved) + 1;
  if (bytes > size) return false;
  memcpy(path, resolved, bytes);
  return true;
}
