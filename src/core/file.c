/* core/file.c - reads whole files, and writes outputs that appear complete or not at all. */
#define _GNU_SOURCE
#include "core/file.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/context.h"
#include "core/memory.h"
#include "platform/beneath.h"
#include "platform/paths.h"
#include "text/plain.h"

static hl_status fail_system(hl_error *error, const char *path, const char *verb) {
  return hl_fail(error, HL_ERROR_IO, "%s: cannot %s: %s", path, verb, strerror(errno));
}

/* Opens a file if the context may open this file. Returns -1, with errno set, if the context may not open the
 * file, or if the system cannot open it. */
static int open_allowed(const hl_context *context, const char *path, int flags) {
  flags |= O_CLOEXEC;
  /* with O_NONBLOCK and O_NOCTTY, open() waits neither for the writer of a pipe nor for a device */
  if ((flags & O_PATH) == 0) flags |= O_NONBLOCK | O_NOCTTY;
  if (!hl_is_confined(context)) return open(path[0] != 0 ? path : ".", flags);
  errno = EXDEV;
  return context->folder >= 0 ? hl_beneath_open(context->folder, path, flags) : -1;
}

/* Fails with a line about a file. In a confined context the line does not depend on the files outside the
 * context's folder. */
static hl_status fail_open(const hl_context *context, hl_error *error, const char *path) {
  bool of_process = errno == EMFILE || errno == ENFILE || errno == ENOMEM;
  if (!hl_is_confined(context) || of_process) return fail_system(error, path, "open");
  return hl_fail(error, HL_ERROR_IO, "%s: no such file below the folder of the file that was opened", path);
}

hl_status hl_file_open_again(hl_context *context, const char *path, int *descriptor, hl_error *error) {
  struct stat about;
  *descriptor = path[0] != 0 ? open_allowed(context, path, O_RDONLY) : (errno = ENOENT, -1);
  if (*descriptor < 0) return fail_open(context, error, path);
  if (!hl_is_confined(context)) return HL_OK;
  if (fstat(*descriptor, &about) == 0 && (S_ISREG(about.st_mode) || S_ISDIR(about.st_mode))) return HL_OK;
  close(*descriptor);
  *descriptor = -1;
  return hl_fail(error, HL_ERROR_IO, "%s: is not a regular file", path);
}

hl_status hl_file_open(hl_context *context, const char *path, int *descriptor, hl_error *error) {
  hl_status status = hl_file_open_again(context, path, descriptor, error);
  if (status == HL_OK && context->options.reads != NULL)
    context->options.reads(context->options.user_data, path);
  return status;
}

hl_status hl_folder_open(hl_context *context, const char *path, int *descriptor, hl_error *error) {
  *descriptor = open_allowed(context, path, O_RDONLY | O_DIRECTORY);
  return *descriptor >= 0 ? HL_OK : fail_open(context, error, path);
}

char hl_file_kind(const hl_context *context, const char *path) {
  struct stat about;
  int descriptor = open_allowed(context, path, O_PATH);
  if (descriptor < 0) return 0;
  bool known = fstat(descriptor, &about) == 0;
  close(descriptor);
  if (known && S_ISDIR(about.st_mode)) return 'd';
  return known && (S_ISREG(about.st_mode) || !hl_is_confined(context)) ? 'f' : 0;
}

hl_status hl_file_pull(hl_context *context, int descriptor, const char *path, void *bytes, size_t capacity,
                       size_t *count, hl_error *error) {
  enum { MILLISECONDS_BETWEEN_QUESTIONS = 20 };
  for (*count = 0;;) {
    struct pollfd wanted = {.fd = descriptor, .events = POLLIN};
    int ready;
    while ((ready = poll(&wanted, 1, MILLISECONDS_BETWEEN_QUESTIONS)) == 0 || (ready < 0 && errno == EINTR))
      if (hl_cancelled(context)) return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", path);
    ssize_t got = read(descriptor, bytes, capacity);
    if (got >= 0) *count = (size_t)got;
    if (got >= 0) return HL_OK;
    if (errno != EINTR && errno != EAGAIN) return fail_system(error, path, "read");
  }
}

/* A file that is being read into memory. */
typedef struct file_reading {
  hl_context *context;
  const char *path;
  int descriptor;
  hl_file_judge judge;  /* judges the file's length by its first bytes; null if `limit` is final */
  size_t limit;         /* the greatest length, in bytes, that is accepted for the file */
  unsigned char *bytes; /* owned; [capacity]; the bytes that have been read */
  size_t length, capacity;
} file_reading;

/* Enlarges the block of bytes if only one byte is free, because the last byte is reserved for the terminating
 * zero. */
static hl_status make_room(file_reading *file, hl_error *error) {
  if (file->length + 1 < file->capacity) return HL_OK;
  if (file->judge != NULL) {
    hl_status status = file->judge(file->path, file->bytes, file->length, &file->limit, error);
    if (status != HL_OK) return status;
  }
  unsigned char *larger = hl_reallocate(file->context, file->bytes, file->capacity * 2, 1);
  if (larger == NULL) return hl_fail_memory(error, file->capacity * 2, file->path);
  file->bytes = larger;
  file->capacity *= 2;
  return HL_OK;
}

static hl_status read_all(file_reading *file, hl_error *error) {
  /* the least and the greatest number of bytes between two checks for cancellation */
  enum { FIRST_PIECE = 1 << 16, GREATEST_PIECE = 1 << 23 };
  file->capacity = FIRST_PIECE;
  file->bytes = hl_allocate(file->context, file->capacity, 1);
  if (file->bytes == NULL) return hl_fail_memory(error, file->capacity, file->path);
  for (size_t got = 1; got > 0; file->length += got) {
    hl_status status = make_room(file, error);
    if (status != HL_OK) return status;
    if (hl_cancelled(file->context)) return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", file->path);
    size_t room = file->capacity - 1 - file->length;
    status = hl_file_pull(file->context, file->descriptor, file->path, file->bytes + file->length,
                          room < GREATEST_PIECE ? room : GREATEST_PIECE, &got, error);
    if (status != HL_OK) return status;
    if (file->length + got > file->limit)
      return hl_fail(error, HL_ERROR_INPUT, "%s: more than %zu bytes, too large for a file of this kind",
                     file->path, file->limit);
  }
  return HL_OK;
}

static hl_status read_file(file_reading *file, unsigned char **bytes, size_t *length, hl_error *error) {
  struct stat information;
  *bytes = NULL;
  hl_status status = hl_file_open(file->context, file->path, &file->descriptor, error);
  if (status != HL_OK) return status;
  if (fstat(file->descriptor, &information) == 0 && S_ISDIR(information.st_mode))
    status = hl_fail(error, HL_ERROR_IO, "%s: is a folder, expected a file", file->path);
  else status = read_all(file, error);
  close(file->descriptor);
  if (status != HL_OK) {
    hl_release(file->context, file->bytes);
    return status;
  }
  file->bytes[file->length] = 0;
  *bytes = file->bytes;
  *length = file->length;
  return HL_OK;
}

hl_status hl_file_read(hl_context *context, const char *path, size_t limit, unsigned char **bytes,
                       size_t *length, hl_error *error) {
  file_reading file = {.context = context, .path = path, .limit = limit};
  return read_file(&file, bytes, length, error);
}

hl_status hl_file_read_judged(hl_context *context, const char *path, hl_file_judge judge,
                              unsigned char **bytes, size_t *length, hl_error *error) {
  file_reading file = {.context = context, .path = path, .judge = judge, .limit = SIZE_MAX};
  return read_file(&file, bytes, length, error);
}

/* ---- outputs ---- */

/* Makes a temporary name, "folder/name.XXXXXX", from "folder/name". If the result would be longer than the
 * system allows, the name is cut between two characters. */
static char *temporary_path(hl_context *context, const char *path) {
  static const char suffix[] = ".XXXXXX";
  const char *slash = strrchr(path, '/'), *name = slash != NULL ? slash + 1 : path;
  size_t kept = strlen(name), most = NAME_MAX - (sizeof suffix - 1);
  if (kept > most)
    for (kept = most; kept > 0 && ((unsigned char)name[kept] & 0xc0) == 0x80;)
      kept--; /* the cut must not fall within a UTF-8 character */
  size_t length = (size_t)(name - path) + kept;
  char *made = hl_allocate(context, length + sizeof suffix, 1);
  if (made == NULL) return NULL;
  memcpy(made, path, length);
  memcpy(made + length, suffix, sizeof suffix);
  return made;
}

/* Creates a file under a free name; the last letters of `path` are replaced. The file's mode follows from the
 * process's umask. The function mkstemp() is not used, because it makes private files. The mode of a file
 * that mkstemp() has made could not be corrected afterwards, because the umask cannot be read without
 * changing it. */
static int create_temporary(char *path) {
  /* five random bits choose one of the 32 letters */
  static const char letters[] = "abcdefghijklmnopqrstuvwxyz234567";
  enum { LETTERS = 6, TRIES = 1000 };
  for (int n = 0; n < TRIES; n++) {
    unsigned char random[LETTERS];
    if (getrandom(random, sizeof random, 0) != (ssize_t)sizeof random) return -1;
    char *end = path + strlen(path) - LETTERS;
    for (int i = 0; i < LETTERS; i++) end[i] = letters[random[i] % 32];
    int descriptor = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0 || errno != EEXIST) return descriptor;
  }
  return -1;
}

hl_status hl_output_begin(hl_context *context, const char *path, hl_output *output, hl_error *error) {
  memset(output, 0, sizeof *output);
  output->context = context;
  output->path = hl_copy_text(context, path);
  char *temporary = temporary_path(context, path);
  if (output->path == NULL || temporary == NULL) {
    hl_release(context, temporary);
    hl_output_abort(output);
    return hl_fail_memory(error, strlen(path), path);
  }
  output->temporary_path = temporary;
  int descriptor = create_temporary(output->temporary_path);
  if (descriptor < 0) {
    hl_release(context, output->temporary_path);
    output->temporary_path = NULL;
    hl_output_abort(output);
    return fail_system(error, path, "write");
  }
  output->file = fdopen(descriptor, "wb");
  if (output->file == NULL) {
    close(descriptor);
    hl_output_abort(output);
    return fail_system(error, path, "write");
  }
  return HL_OK;
}

hl_status hl_output_commit(hl_output *output, hl_error *error) {
  hl_status status = HL_OK;
  if (output->file != NULL) {
    bool failed = fflush(output->file) != 0 || ferror(output->file);
    failed = fclose(output->file) != 0 || failed;
    output->file = NULL;
    if (failed) status = fail_system(error, output->path, "write");
  }
  if (status == HL_OK && rename(output->temporary_path, output->path) != 0)
    status = fail_system(error, output->path, "rename the finished file to this name");
  if (status == HL_OK) {
    hl_release(output->context, output->temporary_path);
    output->temporary_path = NULL;
  }
  hl_output_abort(output);
  return status;
}

void hl_output_abort(hl_output *output) {
  if (output->file != NULL) fclose(output->file);
  if (output->temporary_path != NULL) unlink(output->temporary_path);
  hl_release(output->context, output->temporary_path);
  hl_release(output->context, output->path);
  output->file = NULL;
  output->temporary_path = output->path = NULL;
}

/* ---- outputs in memory ---- */

/* Makes room for `end` bytes in an output in memory. New bytes are zero. */
static bool reserve(hl_output_memory *memory, size_t end) {
  if (end <= memory->capacity) return true;
  size_t capacity = memory->capacity > 0 ? memory->capacity : 65536;
  while (capacity < end)
    if (!hl_multiply(capacity, 2, &capacity)) return false;
  unsigned char *larger = hl_reallocate(memory->output.context, memory->bytes, capacity, 1);
  if (larger == NULL) return false;
  memset(larger + memory->capacity, 0, capacity - memory->capacity);
  memory->bytes = larger;
  memory->capacity = capacity;
  return true;
}

static bool on_write(void *data, const char *bytes, size_t length) {
  hl_output_memory *memory = data;
  if (memory->place > SIZE_MAX - length || !reserve(memory, memory->place + length)) {
    memory->full = true;
    errno = ENOMEM;
    return false;
  }
  memcpy(memory->bytes + memory->place, bytes, length);
  memory->place += length;
  if (memory->place > memory->length) memory->length = memory->place;
  return true;
}

static int64_t on_seek(void *data, int64_t offset, int whence) {
  hl_output_memory *memory = data;
  int64_t from = whence == SEEK_SET ? 0 : (int64_t)(whence == SEEK_CUR ? memory->place : memory->length);
  if (from + offset < 0) return -1;
  memory->place = (size_t)(from + offset);
  return from + offset;
}

hl_status hl_output_memory_begin(hl_context *context, const char *name, hl_output_memory *memory,
                                 hl_error *error) {
  memset(memory, 0, sizeof *memory);
  memory->output.context = context;
  memory->output.path = hl_copy_text(context, name);
  memory->stream = (hl_byte_stream){.data = memory, .write = on_write, .seek = on_seek};
  if (memory->output.path != NULL) memory->output.file = hl_byte_stream_open(&memory->stream);
  if (memory->output.file != NULL) return HL_OK;
  hl_output_memory_abort(memory);
  return hl_fail_memory(error, 65536, name);
}

hl_status hl_output_memory_commit(hl_output_memory *memory, unsigned char **bytes, size_t *length,
                                  hl_error *error) {
  if (!hl_byte_stream_finish(&memory->stream, memory->output.file)) {
    hl_fail_memory(error, memory->capacity > 0 ? memory->capacity : 65536, memory->output.path);
    hl_output_memory_abort(memory);
    return HL_ERROR_MEMORY;
  }
  *bytes = memory->bytes;
  *length = memory->length;
  memory->bytes = NULL;
  hl_output_memory_abort(memory);
  return HL_OK;
}

void hl_output_memory_abort(hl_output_memory *memory) {
  hl_context *context = memory->output.context;
  hl_output_abort(&memory->output);
  hl_release(context, memory->bytes);
  memory->bytes = NULL;
}

/* ---- paths ---- */

char *hl_path_join(hl_context *context, const char *folder, const char *path) {
  if (folder == NULL || folder[0] == 0)
    folder = path[0] == '/' || path[0] == '\\'
                 ? "."
                 : NULL; /* on Windows, "//server" names a computer in the network and is no absolute path;
                          * the path then becomes relative to the current folder */
  if (hl_path_is_absolute(path) || hl_plain_is_url(path) || folder == NULL)
    return hl_copy_text(context, path);
  size_t folder_length = strlen(folder), path_length = strlen(path);
  char *joined = hl_allocate(context, folder_length + path_length + 2, 1);
  if (joined == NULL) return NULL;
  memcpy(joined, folder, folder_length);
  joined[folder_length] = '/';
  memcpy(joined + folder_length + 1, path, path_length + 1);
  return joined;
}

char *hl_path_folder(hl_context *context, const char *path) {
  const char *slash = strrchr(path, '/');
  size_t length = slash == NULL ? 0 : slash == path ? 1 : (size_t)(slash - path);
  char *folder = hl_allocate(context, length + 1, 1);
  if (folder == NULL) return NULL;
  memcpy(folder, path, length);
  folder[length] = 0;
  return folder;
}
