/* volume/io/file_list.c - reads the voxels of several files as one stream, as file_list.h describes. */
#include "volume/io/file_list.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/memory.h"
#include "text/number_word.h"
#include "volume/io/decoders.h"
#include "volume/io/text.h"

enum { FILES_MOST = 65536, NAME_BYTES = 1024 };

hl_status hl_file_list_add(hl_file_list *list, const char *name, hl_error *error) {
  if (list->count == FILES_MOST)
    return hl_fail(error, HL_ERROR_UNSUPPORTED, "more than %d files of voxels: join some of them",
                   (int)FILES_MOST);
  if (list->count == list->room) {
    size_t room = 2 * list->room + 64;
    char **grown = hl_reallocate(list->context, list->names, room, sizeof *grown);
    if (grown == NULL) return hl_fail_memory(error, room * sizeof *grown, "names of files");
    list->names = grown;
    list->room = room;
  }
  list->names[list->count] = hl_copy_text(list->context, name);
  if (list->names[list->count] == NULL) return hl_fail_memory(error, strlen(name), "names of files");
  list->count++;
  return HL_OK;
}

void hl_file_list_release(hl_file_list *list) {
  for (size_t n = 0; n < list->count; n++) hl_release(list->context, list->names[n]);
  hl_release(list->context, list->names);
  *list = (hl_file_list){.context = list->context};
}

/* Finds the number in a pattern: the only "%d", "%5d" or "%05d", where 'i' or 'u' may stand for 'd'. Returns
 * a pointer to the number's percent sign; null if the pattern has no number, or has another percent sign. */
static const char *find_number(const char *pattern, hl_number_word *word) {
  const char *percent = strchr(pattern, '%');
  return percent != NULL && hl_number_word_read(percent, "diu", word) &&
                 strchr(percent + word->length, '%') == NULL
             ? percent
             : NULL;
}

hl_status hl_file_list_pattern(hl_file_list *list, const char *text, bool *sound, hl_error *error) {
  char pattern[NAME_BYTES], name[NAME_BYTES + 32], word[32];
  double numbers[3];
  hl_number_word form;
  int count = 0;
  const char *cursor = text, *place = NULL;
  *sound = hl_text_word(&cursor, pattern, sizeof pattern) && (place = find_number(pattern, &form)) != NULL;
  for (; *sound && count < 3; count++)
    *sound = hl_text_word(&cursor, word, sizeof word) &&
             hl_text_number(word, strlen(word), &numbers[count]) && numbers[count] == floor(numbers[count]) &&
             fabs(numbers[count]) < 1e9;
  *sound = *sound && numbers[2] != 0 && (numbers[1] - numbers[0]) / numbers[2] >= 0 &&
           (numbers[1] - numbers[0]) / numbers[2] < FILES_MOST;
  hl_status status = HL_OK;
  for (double n = 0; *sound && status == HL_OK && n <= (numbers[1] - numbers[0]) / numbers[2]; n++) {
    long number = (long)(numbers[0] + n * numbers[2]);
    char digits[HL_NUMBER_BYTES];
    hl_number_word_write(&form, number, digits);
    snprintf(name, sizeof name, "%.*s%s%s", (int)(place - pattern), pattern, digits, place + form.length);
    status = hl_file_list_add(list, name, error);
  }
  return status;
}

/* ---- the stream ---- */

typedef struct files_stream {
  hl_stream base;
  char *header_path; /* owned; path of the header, in whose folder the files are looked for */
  hl_file_list list;
  size_t next;         /* index of the file that will be opened next */
  hl_stream *file;     /* owned; the current file, whose next byte belongs to its voxels; null if no file is
                        * open */
  uint64_t each, left; /* number of bytes of voxels in each file; number of bytes of voxels that are left in
                        * the current file */
} files_stream;

/* Opens a file, and moves its stream to the first voxel. *file is owned by the caller, also on failure. */
static hl_status open_one(const files_stream *stream, size_t index, hl_stream **file, hl_error *error) {
  const hl_file_list *list = &stream->list;
  char line[HL_LINE_BYTES];
  bool ended = false;
  hl_status status = hl_stream_open_memory(stream->base.context, stream->header_path, "", 0, file, error);
  if (status == HL_OK) status = hl_stream_switch(file, list->names[index], error);
  for (size_t n = 0; status == HL_OK && n < list->line_skip && !ended; n++)
    status = hl_stream_line(*file, line, &ended, error);
  if (status == HL_OK && list->packing == HL_FILE_ZLIB) status = hl_stream_push_inflate(file, error);
  if (status == HL_OK && list->packing == HL_FILE_BZIP2) status = hl_stream_push_bzip2(file, error);
  uint64_t skip = list->byte_skip, most = status == HL_OK ? hl_stream_at_most(*file) : 0;
  if (status == HL_OK && list->skip_to_last && list->packing != HL_FILE_RAW)
    status = hl_fail(
        error, HL_ERROR_UNSUPPORTED,
        "%s: packed voxels at the end of each of several files: state their place by a byte skip",
        stream->header_path);
  if (list->skip_to_last) skip = most > stream->each ? most - stream->each : 0;
  return status == HL_OK ? hl_stream_skip(*file, skip, error) : status;
}

static hl_status files_pull(hl_stream *base, unsigned char *bytes, size_t capacity, size_t *count,
                            hl_error *error) {
  files_stream *stream = (files_stream *)base;
  *count = 0;
  while (*count < capacity && (stream->file != NULL || stream->next < stream->list.count)) {
    if (stream->file == NULL) {
      hl_status status = open_one(stream, stream->next++, &stream->file, error);
      if (status != HL_OK) return status;
      stream->left = stream->each;
    }
    size_t wanted = capacity - *count < stream->left ? capacity - *count : (size_t)stream->left, got = 0;
    hl_status status = hl_stream_read(stream->file, bytes + *count, wanted, &got, error);
    if (status != HL_OK) return status;
    *count += got;
    stream->left -= got;
    if (got < wanted)
      return hl_fail(error, HL_ERROR_INPUT,
                     "%s: %.200s is too short: each of %zu files must have %llu bytes of voxels",
                     stream->header_path, stream->list.names[stream->next - 1], stream->list.count,
                     (unsigned long long)stream->each);
    if (stream->left > 0) continue;
    hl_stream_close(stream->file);
    stream->file = NULL;
  }
  return HL_OK;
}

static uint64_t files_at_most(const hl_stream *base) {
  const files_stream *stream = (const files_stream *)base;
  uint64_t files = stream->list.count - stream->next, bytes;
  if (__builtin_mul_overflow(files, stream->each, &bytes)) return UINT64_MAX;
  return stream->file != NULL ? bytes + stream->left : bytes;
}

static void files_close(hl_stream *base) {
  files_stream *stream = (files_stream *)base;
  hl_stream_close(stream->file);
  hl_file_list_release(&stream->list);
  hl_release(base->context, stream->header_path);
}

/* Checks that each file is long enough for its voxels, before memory for the voxels is allocated. */
static hl_status check_files(const files_stream *stream, hl_error *error) {
  for (size_t n = 0; n < stream->list.count; n++) {
    hl_stream *file = NULL;
    hl_status status = open_one(stream, n, &file, error);
    uint64_t most = status == HL_OK ? hl_stream_at_most(file) : 0;
    hl_stream_close(file);
    if (status != HL_OK) return status;
    if (most < stream->each)
      return hl_fail(
          error, HL_ERROR_INPUT, "%s: %.200s is too short: each of %zu files must have %llu bytes of voxels",
          stream->header_path, stream->list.names[n], stream->list.count, (unsigned long long)stream->each);
  }
  return HL_OK;
}

hl_status hl_stream_push_files(hl_stream **stream, hl_file_list *list, uint64_t bytes, hl_error *error) {
  files_stream *made = (files_stream *)hl_stream_make((*stream)->context, sizeof *made, *stream);
  if (made == NULL) return hl_fail_memory(error, HL_STREAM_BUFFER_BYTES, (*stream)->path);
  made->base.pull = files_pull;
  made->base.at_most = files_at_most;
  made->base.close = files_close;
  *stream = &made->base;
  made->list = *list;
  *list = (hl_file_list){.context = list->context};
  made->header_path = hl_copy_text(made->base.context, made->base.path);
  if (made->header_path == NULL) return hl_fail_memory(error, 100, "a path");
  made->each = made->list.count > 0 ? bytes / made->list.count : 0;
  if (made->list.count == 0 || made->each == 0 || bytes % made->list.count != 0)
    return hl_fail(error, HL_ERROR_INPUT, "%s: %llu bytes of voxels are no whole part for each of %zu files",
                   made->header_path, (unsigned long long)bytes, made->list.count);
  return check_files(made, error);
}
