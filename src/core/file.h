/* core/file.h - reads whole files, and writes outputs that appear complete or not at all. */
#ifndef HL_CORE_FILE_H
#define HL_CORE_FILE_H

#include <stdbool.h>
#include <stdio.h>

#include "core/error.h"
#include "platform/byte_stream.h"

/* Opens a file for reading and calls the context's `reads` callback. The function does not wait for the
 * writer of a pipe. */
hl_status hl_file_open(hl_context *context, const char *path, int *descriptor, hl_error *error);
/* Opens a file like hl_file_open(), but does not call `reads`. Threads other than the caller's use
 * hl_file_open_again(), because such threads may not call `reads`. The function is also used for files that
 * were reported to `reads` before. */
hl_status hl_file_open_again(hl_context *context, const char *path, int *descriptor, hl_error *error);
/* Opens a folder, for hl_beneath_open() and fdopendir(). path: "" stands for the current folder, or for the
 * folder of a confined context. */
hl_status hl_folder_open(hl_context *context, const char *path, int *descriptor, hl_error *error);
/* The kind of the file with this name: 'f' for a file that can be read, 'd' for a folder, and 0 for anything
 * else. Files that the context may not open have the kind 0, too. */
char hl_file_kind(const hl_context *context, const char *path);
/* Reads at most `capacity` bytes of an open file; *count is 0 at the end of the file. While a pipe is empty,
 * waits and polls the cancel callback. */
hl_status hl_file_pull(hl_context *context, int descriptor, const char *path, void *bytes, size_t capacity,
                       size_t *count, hl_error *error);

/* Reads a whole file of at most `limit` bytes. The caller owns *bytes (hl_release). A zero byte follows the
 * last byte. */
hl_status hl_file_read(hl_context *context, const char *path, size_t limit, unsigned char **bytes,
                       size_t *length, hl_error *error);

/* Judges a file by its first `length` bytes: sets *limit to the greatest length, in bytes, that the complete
 * file may have, or refuses the file. The function is called after 64 KiB, and again each time the number of
 * bytes that were read has doubled. The function is not called for files shorter than 64 KiB. */
typedef hl_status (*hl_file_judge)(const char *path, const unsigned char *bytes, size_t length, size_t *limit,
                                   hl_error *error);

/* Reads a whole file. `judge` derives the length limit from the file's header, so that reading stops early
 * even if the file is endless. */
hl_status hl_file_read_judged(hl_context *context, const char *path, hl_file_judge judge,
                              unsigned char **bytes, size_t *length, hl_error *error);

/* An output file, written under a temporary name in the folder of its final name. */
typedef struct hl_output {
  hl_context *context;
  char *path;           /* owned; the final name */
  char *temporary_path; /* owned; the name under which the file is written */
  /* the stream that writes to the file; null for outputs that another library opens by temporary_path */
  FILE *file;
} hl_output;

/* Creates the temporary file of an output and opens it for writing. */
hl_status hl_output_begin(hl_context *context, const char *path, hl_output *output, hl_error *error);
/* Flushes, closes and renames the temporary file of an output. On failure, removes the temporary file and
 * leaves an older file of the final name as it was. */
hl_status hl_output_commit(hl_output *output, hl_error *error);
/* Closes and removes the temporary file of an output. After a commit the function does nothing. */
void hl_output_abort(hl_output *output);

/* An output in growing memory, for encoders that write to a FILE. */
typedef struct hl_output_memory {
  hl_output output;     /* path: a name for messages; file: a stream that writes to this memory */
  unsigned char *bytes; /* owned; [capacity]; the first `length` bytes are written */
  size_t length, capacity, place;
  bool full;             /* whether an allocation failed */
  hl_byte_stream stream; /* the stream that writes to this memory */
} hl_output_memory;

/* Begins an output in memory. `memory` must stay at its address until the commit or abort. */
hl_status hl_output_memory_begin(hl_context *context, const char *name, hl_output_memory *memory,
                                 hl_error *error);
/* Gives the written bytes to the caller, who owns *bytes (hl_release). *bytes is untouched on failure. */
hl_status hl_output_memory_commit(hl_output_memory *memory, unsigned char **bytes, size_t *length,
                                  hl_error *error);
/* Releases an output in memory. After a commit the function does nothing. */
void hl_output_memory_abort(hl_output_memory *memory);

/* Joins folder + "/" + path. The result is a copy of `path` if `path` is absolute or a URL, or if `folder` is
 * null or empty. The caller owns the result, which is null if memory is short. */
char *hl_path_join(hl_context *context, const char *folder, const char *path);
/* The folder part of a path; "" if the path has none. The result is owned by the caller; it is null if memory
 * is short. */
char *hl_path_folder(hl_context *context, const char *path);

#endif
