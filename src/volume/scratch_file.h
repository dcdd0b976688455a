/* volume/scratch_file.h - files without a name, for what memory has no room for: they are gone when they are
 * closed, or the process is. */
#ifndef HL_VOLUME_SCRATCH_FILE_H
#define HL_VOLUME_SCRATCH_FILE_H

#include <stdbool.h>
#include <sys/types.h>

#include "core/error.h"

/* Makes a file of zeros in the folder; its space on the disk is taken at once. *file: to be closed by the
 * caller; -1 on failure. */
hl_status hl_scratch_open(hl_context *context, const char *folder, size_t bytes, int *file, hl_error *error);

/* The same for an empty file, which grows as it is written. -1: failed, and errno says why. */
int hl_scratch_open_empty(hl_context *context, const char *folder);

/* Writes all bytes at an offset of the file; false: failed, and errno says why. */
bool hl_scratch_write(int file, const unsigned char *bytes, size_t count, off_t at);

/* Fails as hl_scratch_open() does, for the system's error number. */
hl_status hl_scratch_fail(const char *folder, size_t bytes, int number, hl_error *error);

#endif
