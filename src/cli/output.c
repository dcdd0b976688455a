/* cli/output.c - checks of OUT before the work. */
#define _GNU_SOURCE
#include "output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "message.h"

bool has_extension(const char *path, const char *extension) {
  size_t length = strlen(path), extension_length = strlen(extension);
  return length > extension_length && strcasecmp(path + length - extension_length, extension) == 0;
}

static int check_folder(const char *path) {
  char *folder = strdup(path);
  if (folder == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  char *slash = strrchr(folder, '/');
  if (slash != NULL) slash[slash == folder ? 1 : 0] = '\0';
  const char *name = slash != NULL ? folder : ".";
  int exit_code = EXIT_CODE_OK;
  if (access(name, W_OK | X_OK) != 0)
    exit_code =
        fail(EXIT_CODE_FAILURE, "%s: its folder '%s' cannot be written: %s", path, name, strerror(errno));
  free(folder);
  return exit_code;
}

int output_check(const char *path, char *const *inputs, int input_count) {
  if (!has_extension(path, ".png") && !has_extension(path, ".exr") && !has_extension(path, ".npy"))
    return fail(EXIT_CODE_USAGE, "--output: '%s' must end in .png, .exr or .npy", path);
  struct stat about, about_input;
  if (stat(path, &about) == 0) {
    if (S_ISDIR(about.st_mode)) return fail(EXIT_CODE_FAILURE, "%s: is a folder: name a file in it", path);
    for (int i = 0; i < input_count; i++)
      if (stat(inputs[i], &about_input) == 0 && about.st_dev == about_input.st_dev &&
          about.st_ino == about_input.st_ino)
        return fail(EXIT_CODE_USAGE, "--output: '%s' is the input '%s': choose another name", path,
                    inputs[i]);
  }
  return check_folder(path);
}
