/* core/file.c - reading whole files, and writing through a temporary name. */
#define _GNU_SOURCE
#include "core/file.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/context.h"
#include "core/memory.h"

static hl_status fail_system(hl_error *error, const char *path, const char *verb) {
  return hl_fail(error, HL_ERROR_IO, "%s: cannot %s: %s", path, verb, strerror(errno));
}

static hl_status read_stream(hl_context *context, FILE *file, const char *path, size_t limit, unsigned char **bytes,
                             size_t *length, hl_error *error) {
  size_t capacity = 65536, used = 0;
  unsigned char *buffer = hl_allocate(context, capacity, 1);
  bool cancelled = false;
  while (buffer != NULL && !cancelled) {
    used += fread(buffer + used, 1, capacity - 1 - used, file);
    if (used < capacity - 1) break;
    if (used > limit) break;
    unsigned char *larger = hl_reallocate(context, buffer, capacity * 2, 1);
    if (larger == NULL) hl_release(context, buffer);
    buffer = larger;
    capacity *= 2;
    cancelled = hl_cancelled(context);
  }
  if (buffer == NULL) return hl_fail_memory(error, capacity, path);
  if (cancelled) {
    hl_release(context, buffer);
    return hl_fail(error, HL_ERROR_CANCELLED, "%s: cancelled", path);
  }
  if (ferror(file)) {
    hl_release(context, buffer);
    return fail_system(error, path, "read");
  }
  if (used > limit) {
    hl_release(context, buffer);
    return hl_fail(error, HL_ERROR_INPUT, "%s: more than %zu bytes, too large for a file of this kind", path, limit);
  }
  buffer[used] = 0;
  *bytes = buffer;
  *length = used;
  return HL_OK;
}

hl_status hl_file_read(hl_context *context, const char *path, size_t limit, unsigned char **bytes, size_t *length,
                       hl_error *error) {
  struct stat information;
  FILE *file = fopen(path, "rb");
  if (file == NULL) return fail_system(error, path, "open");
  if (fstat(fileno(file), &information) == 0 && S_ISDIR(information.st_mode)) {
    fclose(file);
    return hl_fail(error, HL_ERROR_IO, "%s: is a folder, expected a file", path);
  }
  hl_status status = read_stream(context, file, path, limit, bytes, length, error);
  fclose(file);
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
  int descriptor = mkstemp(output->temporary_path);
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
