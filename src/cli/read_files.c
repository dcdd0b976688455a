/* cli/read_files.c - the files that a run has read, so that it writes over none of them. */
#define _GNU_SOURCE
#include "read_files.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "message.h"

static bool make_room(cli_read_files *read) {
  if (read->count < read->capacity) return true;
  size_t capacity = read->capacity > 0 ? 2 * read->capacity : 16;
  cli_file_identity *files = realloc(read->files, capacity * sizeof *files);
  if (files == NULL) return false;
  read->files = files;
  read->capacity = capacity;
  return true;
}

void read_files_add(cli_read_files *read, const char *path) {
  struct stat about;
  if (stat(path, &about) != 0) return; /* gone already: nothing is left to protect */
  if (make_room(read)) read->files[read->count++] = (cli_file_identity){about.st_dev, about.st_ino};
  else read->incomplete = true;
}

void read_files_release(cli_read_files *read) { free(read->files); }

int read_files_protect(const cli_read_files *read, const char *path, const char *reader) {
  struct stat about;
  if (stat(path, &about) != 0)
    return errno != ENAMETOOLONG
               ? EXIT_CODE_OK
               : fail(EXIT_CODE_FAILURE, "%s: cannot be written: %s", path, strerror(errno));
  if (read->incomplete)
    return fail(EXIT_CODE_FAILURE, "out of memory for the names of the files that were read");
  for (size_t i = 0; i < read->count; i++)
    if (about.st_dev == read->files[i].device && about.st_ino == read->files[i].inode)
      return fail(EXIT_CODE_USAGE, "--output: '%s' is a file that '%s' needs: choose another name", path,
                  reader);
  return EXIT_CODE_OK;
}
