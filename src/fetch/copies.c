/* fetch/copies.c - see copies.h. */
#define _GNU_SOURCE
#include "copies.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "platform/folders.h"
#include "text/hash.h"

#define MARK     "\nhalflight-copy 2\n"
#define NEW_NAME "new-"

/* The lines that follow a copy's bytes. They hold MARK, the key, and the condition. One line holds three
 * numbers: the number of bytes, the position of the first byte in the server's file, and the size of that
 * file. The last line holds the length of all these lines. */
enum { LENGTH_DIGITS = 8, LINES_MOST = COPIES_KEY_BYTES + FETCH_CONDITION_BYTES + 128 };

static hl_status fail(hl_error *error, const char *path) {
  snprintf(error->message, sizeof error->message, "%.800s: the folder of copies: %s", path, strerror(errno));
  return HL_ERROR_IO;
}

/* The name of a key's copy: two hashes with different beginnings. The key in the copy tells whether two keys
 * have one name. */
static void copy_path(const char *folder, const char *key, char path[COPIES_PATH_BYTES]) {
  snprintf(path, COPIES_PATH_BYTES, "%.4000s/%016" PRIx64 "%016" PRIx64, folder,
           hl_hash_bytes(HL_HASH_BEGIN, key, strlen(key)),
           hl_hash_bytes(0x9e3779b97f4a7c15u, key, strlen(key)));
}

/* ---- one copy ---- */

/* Reads the lines at the end of a copy. Returns false if the lines belong to another key, or if the copy was
 * cut off. */
static bool read_lines(const char *key, hl_fetched_file *file, char *condition) {
  const int descriptor = file->descriptor;
  struct stat about;
  char lines[LINES_MOST + 1], expected[LINES_MOST];
  if (fstat(descriptor, &about) != 0 || !S_ISREG(about.st_mode) || about.st_size < LENGTH_DIGITS)
    return false;
  char digits[LENGTH_DIGITS + 1] = "";
  if (pread(descriptor, digits, LENGTH_DIGITS, about.st_size - LENGTH_DIGITS) != LENGTH_DIGITS) return false;
  long length = strtol(digits, NULL, 10);
  if (length < LENGTH_DIGITS || length > LINES_MOST || length > about.st_size) return false;
  if (pread(descriptor, lines, (size_t)length, about.st_size - length) != length) return false;
  lines[length] = '\0';
  int begun = snprintf(expected, sizeof expected, MARK "%s\n", key);
  if (begun >= (int)sizeof expected || strncmp(lines, expected, (size_t)begun) != 0) return false;
  char *line = lines + begun, *end = strchr(line, '\n');
  if (end == NULL || end - line >= FETCH_CONDITION_BYTES) return false;
  *end = '\0';
  snprintf(condition, FETCH_CONDITION_BYTES, "%s", line);
  uint64_t *const numbers[3] = {&file->size, &file->begin, &file->whole};
  const char *text = end + 1;
  for (int n = 0; n < 3; n++) {
    char *after;
    *numbers[n] = strtoull(text, &after, 10);
    if (after == text) return false;
    text = after;
  }
  return file->size == (uint64_t)(about.st_size - length);
}

void copies_find(const char *folder, const char *key, hl_fetched_file *file, char *condition) {
  char path[COPIES_PATH_BYTES];
  copy_path(folder, key, path);
  condition[0] = '\0';
  *file = (hl_fetched_file){.descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW)};
  if (file->descriptor < 0 || read_lines(key, file, condition)) return;
  close(file->descriptor);
  condition[0] = '\0';
  *file = (hl_fetched_file){.descriptor = -1};
}

void copies_touch(const char *folder, const char *key) {
  char path[COPIES_PATH_BYTES];
  copy_path(folder, key, path);
  utimensat(AT_FDCWD, path, NULL, 0);
}

hl_status copies_begin(const char *folder, char *path, hl_error *error) {
  snprintf(path, COPIES_PATH_BYTES, "%.4000s/" NEW_NAME "XXXXXX", folder);
  int descriptor = mkstemp(path);
  if (descriptor < 0) return fail(error, folder);
  close(descriptor);
  return HL_OK;
}

/* Appends the lines. */
static bool write_lines(const char *key, const char *condition, const hl_fetched_file *file) {
  char lines[LINES_MOST + LENGTH_DIGITS + 1];
  int length = snprintf(lines, LINES_MOST, MARK "%s\n%s\n%" PRIu64 " %" PRIu64 " %" PRIu64 "\n", key,
                        condition, file->size, file->begin, file->whole);
  if (length >= LINES_MOST) return false;
  length += snprintf(lines + length, LENGTH_DIGITS + 1, "%0*d", LENGTH_DIGITS, length + LENGTH_DIGITS);
  return pwrite(file->descriptor, lines, (size_t)length, (off_t)file->size) == length;
}

hl_status copies_keep(const char *folder, const char *key, const char *condition, const char *path,
                      hl_fetched_file *file, hl_error *error) {
  char kept[COPIES_PATH_BYTES];
  copy_path(folder, key, kept);
  file->descriptor = open(path, O_RDWR | O_CLOEXEC | O_NOFOLLOW);
  if (file->descriptor >= 0 && write_lines(key, condition, file) && rename(path, kept) == 0) return HL_OK;
  fail(error, folder);
  if (file->descriptor >= 0) close(file->descriptor);
  *file = (hl_fetched_file){.descriptor = -1};
  return HL_ERROR_IO;
}

/* ---- the folder ---- */

typedef struct old_copy {
  char name[48];
  uint64_t bytes;
  time_t used;
} old_copy;

static int by_use(const void *a, const void *b) {
  const old_copy *first = a, *second = b;
  return first->used < second->used ? -1 : first->used > second->used ? 1 : strcmp(first->name, second->name);
}

/* Appends a file of the folder to the list. A file that an interrupted run left unfinished more than a day
 * ago is removed. */
static bool note(int folder, const char *name, old_copy **list, size_t *count, size_t *capacity) {
  enum { DAY = 86400 };
  struct stat about;
  if (name[0] == '.' || strlen(name) >= sizeof(*list)->name) return true;
  if (fstatat(folder, name, &about, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISREG(about.st_mode)) return true;
  if (strncmp(name, NEW_NAME, strlen(NEW_NAME)) == 0) {
    if (time(NULL) - about.st_mtime > DAY) unlinkat(folder, name, 0);
    return true;
  }
  if (*count == *capacity) {
    size_t more = 2 * *capacity + 256;
    old_copy *larger = realloc(*list, more * sizeof **list);
    if (larger == NULL) return false;
    *list = larger;
    *capacity = more;
  }
  old_copy *copy = &(*list)[(*count)++];
  *copy = (old_copy){.bytes = (uint64_t)about.st_size, .used = about.st_mtime};
  strcpy(copy->name, name);
  return true;
}

/* Removes the oldest copies beyond the limit. */
static void trim(DIR *folder, uint64_t limit) {
  old_copy *list = NULL;
  size_t count = 0, capacity = 0;
  uint64_t bytes = 0;
  bool room = true;
  for (struct dirent *entry; room && (entry = readdir(folder)) != NULL;)
    room = note(dirfd(folder), entry->d_name, &list, &count, &capacity);
  for (size_t n = 0; n < count; n++) bytes += list[n].bytes;
  if (count > 0) qsort(list, count, sizeof *list, by_use);
  for (size_t n = 0; n < count && bytes > limit; n++)
    if (unlinkat(dirfd(folder), list[n].name, 0) == 0) bytes -= list[n].bytes;
  free(list);
}

hl_status copies_open(const char *folder, uint64_t limit, hl_error *error) {
  hl_private_folder_make(folder);
  DIR *opened = opendir(folder);
  if (opened == NULL) return fail(error, folder);
  trim(opened, limit);
  closedir(opened);
  return HL_OK;
}
