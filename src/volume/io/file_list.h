/* volume/io/file_list.h - voxels in several files that a header names, as one stream.
 *
 * Names come as a list, or as a pattern with one number ("slice%03d.raw", from, to, step). Each file may
 * begin with lines and bytes of its own, and may be packed. */
#ifndef HL_VOLUME_FILE_LIST_H
#define HL_VOLUME_FILE_LIST_H

#include "volume/io/stream.h"

typedef enum hl_file_packing { HL_FILE_RAW, HL_FILE_ZLIB, HL_FILE_BZIP2 } hl_file_packing;

typedef struct hl_file_list {
  hl_context *context;
  char **names; /* owned; [count] */
  size_t count, room;
  size_t line_skip, byte_skip; /* numbers of lines, and then of unpacked bytes, that each file has before its
                                * voxels */
  bool skip_to_last;           /* whether the voxels are the last bytes of each file */
  hl_file_packing packing;
} hl_file_list;

hl_status hl_file_list_add(hl_file_list *list, const char *name, hl_error *error);
/* Adds the names that "PATTERN FROM TO STEP ..." stands for. *sound: false if the text is not of this
 * form. */
hl_status hl_file_list_pattern(hl_file_list *list, const char *text, bool *sound, hl_error *error);
void hl_file_list_release(hl_file_list *list);

/* Replaces *stream by one stream of all files, each of which gives an equal part of `bytes`. The files are
 * looked for beside the file of *stream. The new stream takes over the list. */
hl_status hl_stream_push_files(hl_stream **stream, hl_file_list *list, uint64_t bytes, hl_error *error);

#endif
