/* core/file.c - reading whole files, and writing through a temporary name. */
#define _GNU_SOURCE
#include "core/file.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/context.h"
#include "core/memory.h"

static hl_status fail_system(hl_error *error, const char *path, const char *verb) {
  return hl_fail(error, HL_ERROR_IO, "%s: cannot %s: %s", path, verb, strerror(errno));
}

hl_status hl_file_open(const char *path, int *descriptor, hl_error *error) {
  *descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  return *descriptor < 0 ? fail_system(error, path, "open") : HL_OK;
}

hl_status hl_file_pull(hl_context *context, int descriptor, const char *path, void *bytes, size_t capacity, size_t *count,
                       hl_error *error) {
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

static hl_status read_all(hl_context *context, int descriptor, const char *path, size_t limit, unsigned char **bytes,
                          size_t *length, hl_error *error) {
  enum { GREATEST_PIECE = 1 << 23 }; /* between two questions whether to stop */
  size_t capacity = 65536, got = 0;
  hl_status status = HL_OK;
  *bytes = hl_allocate(context, capacity, 1);
  for (*length = 0; *bytes != NULL; *length += got) {
    if (*length + 1 == capacity) {
      unsigned char *larger = hl_reallocate(context, *bytes, capacity * 2, 1);
      if (larger == NULL) hl_release(context, *bytes);
      *bytes = larger;
      capacity *= 2;
      if (larger == NULL) break;
    }
    size_t room = capacity - 1 - *length;
    status = hl_cancelled(context)
                 ? hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", path)
                 : hl_file_pull(context, descriptor, path, *bytes + *length, room < GREATEST_PIECE ? room : GREATEST_PIECE, &got, error);
    if (status != HL_OK || got == 0) return status;
    if (*length + got > limit)
      return hl_fail(error, HL_ERROR_INPUT, "%s: more than %zu bytes, too large for a file of this kind", path, limit);
  }
  return hl_fail_memory(error, capacity, path);
}

hl_status hl_file_read(hl_context *context, const char *path, size_t limit, unsigned char **bytes, size_t *length,
                       hl_error *error) {
  struct stat information;
  int descriptor;
  *bytes = NULL;
  hl_status status = hl_file_open(path, &descriptor, error);
  if (status != HL_OK) return status;
  if (fstat(descriptor, &information) == 0 && S_ISDIR(information.st_mode))
    status = hl_fail(error, HL_ERROR_IO, "%s: is a folder, expected a file", path);
  else
    status = read_all(context, descriptor, path, limit, bytes, length, error);
  close(descriptor);
  if (status == HL_OK) {
    (*bytes)[*length] = 0;
  } else {
    hl_release(context, *bytes);
    *bytes = NULL;
  }
  return status;
}

hl_status hl_output_begin(hl_context *context, const char *path, hl_output *output, hl_error *error) {
  memset(output, 0, sizeof *output);
  output->context = context;
  size_t length = strlen(path);
  output->path = hl_copy_text(context, path);
  output->temporary_path = hl_allocate(context, length + 8, 1);
  if (output->path == NULL || output->temporary_path == NULL) {
    hl_output_abort(output);
    return hl_fail_memory(error, length, path);
  }
  memcpy(output->temporary_path, path, length);
  memcpy(output->temporary_path + length, ".XXXXXX", 8);
  int descriptor = mkostemp(output->temporary_path, O_CLOEXEC);
  if (descriptor < 0) {
    hl_release(context, output->temporary_path);
    output->temporary_path = NULL;
    hl_output_abort(output);
    return fail_system(error, path, "write");
  }
  mode_t mask = umask(0);
  umask(mask);
  fchmod(descriptor, 0666 & ~mask);
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

char *hl_path_join(hl_context *context, const char *folder, const char *path) {
  if (path[0] == '/' || folder == NULL || folder[0] == 0) return hl_copy_text(context, path);
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
