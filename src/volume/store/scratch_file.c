/* volume/store/scratch_file.c - see scratch_file.h. */
#define _GNU_SOURCE
#include "volume/store/scratch_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "core/memory.h"
#include "platform/nameless_file.h"

hl_status hl_scratch_fail(const char *folder, size_t bytes, int number, hl_error *error) {
  return hl_fail(error, HL_ERROR_MEMORY,
                 "%s: no scratch file of %.1f MiB for a volume larger than memory: %s: make room, name "
                 "another folder (TMPDIR), or raise the memory limit",
                 folder, (double)bytes / (1 << 20), strerror(number));
}

int hl_scratch_open_empty(hl_context *context, const char *folder) {
  static const char ending[] = "/halflight-scratch-XXXXXX";
  char *path = hl_allocate(context, strlen(folder) + sizeof ending, 1);
  if (path == NULL) {
    errno = ENOMEM;
    return -1;
  }
  sprintf(path, "%s%s", folder, ending);
  int file = hl_nameless_file(path), number = errno;
  hl_release(context, path);
  errno = number;
  return file;
}

/* Reserves space on the disk for the whole file before anything is written. Without reserved space, the
 * system would end the process when a write into the mapped file finds no space. The function first asks how
 * much space is free, because a failed attempt would fill the disk for a moment. Returns an error number, or
 * 0. */
static int take_space(int file, size_t bytes) {
  struct statvfs disk;
  if (fstatvfs(file, &disk) == 0 && bytes / disk.f_frsize >= disk.f_bavail) return ENOSPC;
  int number;
  do number = posix_fallocate(file, 0, (off_t)bytes);
  while (number == EINTR);
  return number;
}

hl_status hl_scratch_open(hl_context *context, const char *folder, size_t bytes, int *file, hl_error *error) {
  *file = hl_scratch_open_empty(context, folder);
  if (*file < 0) return hl_scratch_fail(folder, bytes, errno, error);
  int number = take_space(*file, bytes);
  if (number == 0) return HL_OK;
  close(*file);
  *file = -1;
  return hl_scratch_fail(folder, bytes, number, error);
}

bool hl_scratch_write(int file, const unsigned char *bytes, size_t count, off_t at) {
  while (count > 0) {
    ssize_t written = pwrite(file, bytes, count, at);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) return false;
    bytes += written, at += written, count -= (size_t)written;
  }
  return true;
}
