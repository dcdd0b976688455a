/* volume/io/file_list.h - makes one stream of the voxels in several files, which a header names.
 *
 * The names are a list, or a pattern with a range of numbers ("slice%03d.raw", from, to, step). Each file may
 * begin with lines and bytes of its own, and may be packed. */
#ifndef HL_VOLUME_FILE_LIST_H
#define HL_VOLUME_FILE_LIST_H

#include "volume/io/stream.h"

typedef enum hl_file_packing { HL_FILE_RAW, HL_FILE_ZLIB, HL_FILE_BZIP2 } hl_file_packing;

typedef struct hl_file_list {
  hl_context *context;
  char **names; /* owned; [count] */
  size_t count, room;
  size_t line_skip, byte_skip; /* number of lines before each file's voxels; number of unpacked bytes between
                                * these lines and the voxels */
  bool skip_to_last;           /* whether the voxels are the last bytes of each file */
  hl_file_packing packing;
} hl_file_list;

hl_status hl_file_list_add(hl_file_list *list, const char *name, hl_error *error);
/* Adds the names that the text "PATTERN FROM TO STEP ..." describes. *sound: set to false if the text is not
 * of this form. */
hl_status hl_file_list_pattern(hl_file_list *list, const char *text, bool *sound, hl_error *error);
void hl_file_list_release(hl_file_list *list);

/* Replaces *stream by one stream of all files. The new stream gives `bytes` bytes, the same number from each
 * file. The files lie in the folder of the file of *stream. The new stream takes over the list. */
hl_status hl_stream_push_files(hl_stream **stream, hl_file_list *list, uint64_t bytes, hl_error *error);

#endif
