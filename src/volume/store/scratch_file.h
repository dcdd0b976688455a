/* volume/store/scratch_file.h - makes files without a name for data that do not fit into memory. A file
 * without a name vanishes when it is closed, or when the process ends. */
#ifndef HL_VOLUME_SCRATCH_FILE_H
#define HL_VOLUME_SCRATCH_FILE_H

#include <stdbool.h>
#include <sys/types.h>

#include "core/error.h"

/* Makes a file of `bytes` zeros in the folder. The file's space on the disk is reserved at once. *file: the
 * file's descriptor, which the caller closes; -1 on failure. */
hl_status hl_scratch_open(hl_context *context, const char *folder, size_t bytes, int *file, hl_error *error);

/* Makes an empty file in the folder, which grows as it is written. Returns -1, with errno set, on failure. */
int hl_scratch_open_empty(hl_context *context, const char *folder);

/* Writes all bytes at the offset `at` of the file. Returns false, with errno set, on failure. */
bool hl_scratch_write(int file, const unsigned char *bytes, size_t count, off_t at);

/* Fails with the same error line as hl_scratch_open(). number: the system's error number. */
hl_status hl_scratch_fail(const char *folder, size_t bytes, int number, hl_error *error);

#endif
