/* volume/io/bundle_zip.c - lists and opens the files of zip archives, also of zip64 archives.
 *
 * Source: PKWARE's APPNOTE.TXT 6.3.10, sections 4.3.7 (local header), 4.3.12 (central directory), 4.3.14 to
 * 4.3.16 (end of the central directory) and 4.5.3 (zip64). No file is unpacked to disk, so that names in the
 * archive cannot do harm. */
#include "volume/io/bundle_zip.h"

#include <string.h>

#include "core/context.h"
#include "core/memory.h"

enum {
  LOCAL_BYTES = 30,
  CENTRAL_BYTES = 46,
  END_BYTES = 22,
  LOCATOR_BYTES = 20,
  END_64_BYTES = 56,
  COMMENT_MOST = 65535,
  NAME_MOST = 4096
};

static uint32_t u16(const unsigned char *bytes) { return bytes[0] | (uint32_t)bytes[1] << 8; }
static uint32_t u32(const unsigned char *bytes) { return u16(bytes) | u16(bytes + 2) << 16; }
static uint64_t u64(const unsigned char *bytes) { return u32(bytes) | (uint64_t)u32(bytes + 4) << 32; }

static hl_status fail_damaged(const hl_bundle *bundle, hl_error *error) {
  return hl_fail(error, HL_ERROR_INPUT, "%s: the zip archive's directory is damaged or cut off",
                 bundle->path);
}

static hl_status open_archive(const hl_bundle *bundle, bool quiet, hl_source **source, hl_error *error) {
  return bundle->memory != NULL ? hl_source_of_memory(bundle->context, bundle->path, bundle->memory,
                                                      bundle->memory_size, source, error)
                                : hl_source_open(bundle->context, bundle->path, quiet, source, error);
}

static hl_status read_exactly(const hl_bundle *bundle, hl_source *source, uint64_t at, void *bytes,
                              size_t count, hl_error *error) {
  size_t got;
  hl_status status = hl_source_read(source, at, bytes, count, &got, error);
  return status == HL_OK && got < count ? fail_damaged(bundle, error) : status;
}

/* Finds the end record, which is the last record of the file. Only a comment may follow the end record. */
static hl_status find_end(const hl_bundle *bundle, hl_source *source, uint64_t *at, hl_error *error) {
  enum { TAIL = END_BYTES + COMMENT_MOST };
  uint64_t size = hl_source_size(source), begin = size > TAIL ? size - TAIL : 0;
  unsigned char *tail = hl_allocate(bundle->context, TAIL, 1);
  if (tail == NULL) return hl_fail_memory(error, TAIL, bundle->path);
  size_t got;
  hl_status status = hl_source_read(source, begin, tail, TAIL, &got, error);
  bool found = false;
  for (size_t n = got >= END_BYTES ? got - END_BYTES + 1 : 0; n > 0 && status == HL_OK && !found; n--)
    if (memcmp(tail + n - 1, "PK\5\6", 4) == 0) {
      *at = begin + n - 1;
      found = true;
    }
  hl_release(bundle->context, tail);
  return status == HL_OK && !found ? fail_damaged(bundle, error) : status;
}

static hl_status find_directory(const hl_bundle *bundle, hl_source *source, uint64_t *at, uint64_t *count,
                                hl_error *error) {
  unsigned char end[END_BYTES], locator[LOCATOR_BYTES], wide[END_64_BYTES];
  uint64_t place = 0;
  hl_status status = find_end(bundle, source, &place, error);
  if (status == HL_OK) status = read_exactly(bundle, source, place, end, sizeof end, error);
  if (status != HL_OK) return status;
  *count = u16(end + 10);
  *at = u32(end + 16);
  if ((*count != 0xffff && *at != 0xffffffff) || place < LOCATOR_BYTES) return HL_OK;
  status = read_exactly(bundle, source, place - LOCATOR_BYTES, locator, sizeof locator, error);
  if (status != HL_OK || memcmp(locator, "PK\6\7", 4) != 0) return status;
  status = read_exactly(bundle, source, u64(locator + 8), wide, sizeof wide, error);
  if (status != HL_OK) return status;
  if (memcmp(wide, "PK\6\6", 4) != 0) return fail_damaged(bundle, error);
  *count = u64(wide + 32);
  *at = u64(wide + 48);
  return HL_OK;
}

/* Reads an entry's size, packed size and position from the extra field of zip64. The field contains, in this
 * order, only those of the three numbers that did not fit into 32 bits. */
static void take_extra(const unsigned char *extra, size_t length, hl_bundle_entry *entry) {
  for (size_t n = 0; n + 4 <= length;) {
    size_t bytes = u16(extra + n + 2);
    const unsigned char *value = extra + n + 4, *end = value + bytes;
    if (n + 4 + bytes > length) return;
    if (u16(extra + n) == 1) {
      uint64_t *const wide[] = {&entry->size, &entry->packed, &entry->at};
      for (int w = 0; w < 3; w++)
        if (*wide[w] == 0xffffffff && end - value >= 8) {
          *wide[w] = u64(value);
          value += 8;
        }
    }
    n += 4 + bytes;
  }
}

/* Reads one entry of the directory. Folders and encrypted files are ignored. */
static hl_status take_entry(hl_bundle *bundle, hl_source *source, uint64_t *at, unsigned char *text,
                            hl_error *error) {
  unsigned char central[CENTRAL_BYTES];
  hl_status status = read_exactly(bundle, source, *at, central, sizeof central, error);
  if (status != HL_OK) return status;
  if (memcmp(central, "PK\1\2", 4) != 0) return fail_damaged(bundle, error);
  size_t name_length = u16(central + 28), extra_length = u16(central + 30);
  bool encrypted = (u16(central + 8) & 1) != 0;
  hl_bundle_entry entry = {.name = (char *)text,
                           .method = (int)u16(central + 10),
                           .packed = u32(central + 20),
                           .size = u32(central + 24),
                           .at = u32(central + 42)};
  uint64_t next = *at + CENTRAL_BYTES + name_length + extra_length + u16(central + 32);
  if (name_length == 0 || name_length > NAME_MOST || encrypted) {
    *at = next;
    return HL_OK;
  }
  status = read_exactly(bundle, source, *at + CENTRAL_BYTES + name_length, text, extra_length, error);
  if (status == HL_OK) take_extra(text, extra_length, &entry);
  if (status == HL_OK) status = read_exactly(bundle, source, *at + CENTRAL_BYTES, text, name_length, error);
  if (status != HL_OK) return status;
  text[name_length] = 0;
  *at = next;
  bool is_file = text[name_length - 1] != '/' && strlen((char *)text) == name_length;
  return is_file ? hl_bundle_add(bundle, entry, error) : HL_OK;
}

static hl_status read_directory(hl_bundle *bundle, hl_source *source, hl_error *error) {
  uint64_t at, count;
  hl_status status = find_directory(bundle, source, &at, &count, error);
  if (status != HL_OK) return status;
  if (count > hl_source_size(source) / CENTRAL_BYTES) return fail_damaged(bundle, error);
  unsigned char *text = hl_allocate(bundle->context, 65536, 1);
  if (text == NULL) return hl_fail_memory(error, 65536, bundle->path);
  for (uint64_t n = 0; n < count && status == HL_OK; n++) {
    status = take_entry(bundle, source, &at, text, error);
    if (status == HL_OK && hl_cancelled(bundle->context))
      status = hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", bundle->path);
  }
  hl_release(bundle->context, text);
  hl_bundle_sort(bundle);
  return status;
}

static hl_status open_entry(const hl_bundle *bundle, const hl_bundle_entry *entry, bool quiet,
                            hl_source **source, hl_error *error) {
  unsigned char local[LOCAL_BYTES];
  hl_status status = open_archive(bundle, quiet, source, error);
  if (status == HL_OK) status = read_exactly(bundle, *source, entry->at, local, sizeof local, error);
  if (status == HL_OK && memcmp(local, "PK\3\4", 4) != 0) status = fail_damaged(bundle, error);
  if (status == HL_OK && entry->method != 0 && entry->method != 8)
    status = hl_fail(error, HL_ERROR_UNSUPPORTED,
                     "%s: packed by method %d, which is not read: pack it anew, stored or deflated",
                     bundle->path, entry->method);
  if (status == HL_OK) {
    uint64_t begin = entry->at + LOCAL_BYTES + u16(local + 26) + u16(local + 28);
    status = entry->method == 0 ? hl_source_cut(source, begin, entry->size, error)
                                : hl_source_inflate(source, begin, entry->size, error);
  }
  if (status == HL_OK) return HL_OK;
  hl_source_close(*source);
  *source = NULL;
  return status;
}

hl_status hl_bundle_open_zip(hl_context *context, const char *path, const void *bytes, size_t byte_count,
                             hl_bundle *bundle, hl_error *error) {
  *bundle = (hl_bundle){.context = context,
                        .path = hl_copy_text(context, path),
                        .is_archive = true,
                        .open_entry = open_entry,
                        .memory = bytes,
                        .memory_size = byte_count};
  if (bundle->path == NULL) return hl_fail_memory(error, strlen(path), path);
  hl_source *source = NULL;
  hl_status status = open_archive(bundle, false, &source, error);
  if (status == HL_OK) status = read_directory(bundle, source, error);
  hl_source_close(source);
  return status;
}
