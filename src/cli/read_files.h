/* cli/read_files.h - the files that a run has read, so that it writes over none of them. */
#ifndef HL_CLI_READ_FILES_H
#define HL_CLI_READ_FILES_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

/* A file by what it is, whatever its names: links lead to the same. */
typedef struct cli_file_identity {
  dev_t device;
  ino_t inode;
} cli_file_identity;

typedef struct cli_read_files {
  cli_file_identity *files; /* owned; [count] */
  size_t count, capacity;
  bool incomplete; /* there was no memory for one of them */
} cli_read_files;

void read_files_add(cli_read_files *read, const char *path);
void read_files_release(cli_read_files *read);

/* Refuses a path that leads to one of the files, or is too long for any; reader: what read them
 * ("scene.json"). Returns the exit code. */
int read_files_protect(const cli_read_files *read, const char *path, const char *reader);

#endif
