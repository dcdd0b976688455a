/* cli/view/token.c - keeps the token of a viewer's URL for the next viewer. */
#define _GNU_SOURCE
#include "token.h"

#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

/* Returns whether a file or folder belongs to the user, and nobody else has access to it. */
static bool is_private(const struct stat *about) {
  return about->st_uid == getuid() && (about->st_mode & (S_IRWXG | S_IRWXO)) == 0;
}

static bool find_path(int port, char path[PATH_MAX]) {
  const char *folder = getenv("XDG_RUNTIME_DIR");
  struct stat about;
  return folder != NULL && folder[0] == '/' && lstat(folder, &about) == 0 && S_ISDIR(about.st_mode) &&
         is_private(&about) && snprintf(path, PATH_MAX, "%s/halflight-view-%d", folder, port) < PATH_MAX;
}

static bool read_token(const char *path, char token[VIEW_TOKEN_DIGITS + 1]) {
  int descriptor = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  struct stat about;
  if (descriptor < 0) return false;
  bool good = fstat(descriptor, &about) == 0 && S_ISREG(about.st_mode) && is_private(&about) &&
              about.st_size == VIEW_TOKEN_DIGITS &&
              read(descriptor, token, VIEW_TOKEN_DIGITS) == VIEW_TOKEN_DIGITS;
  token[VIEW_TOKEN_DIGITS] = '\0';
  close(descriptor);
  return good && strspn(token, "0123456789abcdef") == VIEW_TOKEN_DIGITS;
}

static bool make_token(char token[VIEW_TOKEN_DIGITS + 1]) {
  unsigned char bytes[VIEW_TOKEN_DIGITS / 2];
  if (getrandom(bytes, sizeof bytes, 0) != (ssize_t)sizeof bytes) return false;
  for (size_t b = 0; b < sizeof bytes; b++) snprintf(token + 2 * b, 3, "%02x", bytes[b]);
  return true;
}

/* Writes the token to a new file, which replaces any file at this path. */
static bool write_token(const char *path, const char *token) {
  unlink(path);
  int descriptor = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, S_IRUSR | S_IWUSR);
  if (descriptor < 0) return false;
  bool good = write(descriptor, token, VIEW_TOKEN_DIGITS) == VIEW_TOKEN_DIGITS;
  good &= close(descriptor) == 0;
  if (!good) unlink(path);
  return good;
}

bool view_token_of_port(int port, char token[VIEW_TOKEN_DIGITS + 1]) {
  char path[PATH_MAX];
  if (!find_path(port, path)) return false;
  return read_token(path, token) || (make_token(token) && write_token(path, token));
}
