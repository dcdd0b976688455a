/* gpu/program_cache.c - see program_cache.h. A file holds the key's length, the key, a number made from the
 * program's bytes, and the program. The file is written under another name and then renamed, so that it
 * appears as a whole. A program whose number is wrong is not used, because a driver may crash on a damaged
 * program. A file that belongs to another user, or that other users may write, is not read, because drivers
 * run whatever the program says. */
#define _POSIX_C_SOURCE 200809L
#include "gpu/program_cache.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "platform/folders.h"
#include "text/hash.h"

#define CACHE_SUFFIX ".kernels"

uint64_t hl_program_number(const char *text) { return hl_hash_bytes(HL_HASH_BEGIN, text, strlen(text)); }

static bool name_of_key(const char *folder, const char *key, char *path, size_t bytes) {
  int length = snprintf(path, bytes, "%s/%016llx" CACHE_SUFFIX, folder,
                        (unsigned long long)hl_program_number(key));
  return length > 0 && (size_t)length < bytes;
}

static bool read_all(int file, void *to, size_t bytes) {
  for (size_t done = 0; done < bytes;) {
    ssize_t got = read(file, (char *)to + done, bytes - done);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    done += (size_t)got;
  }
  return true;
}

static bool write_all(int file, const void *from, size_t bytes) {
  for (size_t done = 0; done < bytes;) {
    ssize_t put = write(file, (const char *)from + done, bytes - done);
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return false;
    done += (size_t)put;
  }
  return true;
}

/* Reads the program in a file if the file's key is the wanted key. */
static bool read_program(int file, size_t size, const char *key, gpu_binary *binary) {
  char held[PROGRAM_KEY_BYTES];
  uint32_t length = 0;
  uint64_t number = 0;
  if (!read_all(file, &length, sizeof length) || length != strlen(key) || length >= sizeof held ||
      size <= sizeof length + length + sizeof number || !read_all(file, held, length) ||
      memcmp(held, key, length) != 0 || !read_all(file, &number, sizeof number))
    return false;
  binary->size = size - sizeof length - length - sizeof number;
  binary->bytes = malloc(binary->size);
  if (binary->bytes != NULL && read_all(file, binary->bytes, binary->size) &&
      hl_hash_bytes(HL_HASH_BEGIN, binary->bytes, binary->size) == number)
    return true;
  free(binary->bytes);
  *binary = (gpu_binary){0};
  return false;
}

bool hl_program_stored(const char *folder, const char *key, gpu_binary *binary) {
  char path[4096];
  struct stat about;
  if (folder == NULL || !name_of_key(folder, key, path, sizeof path)) return false;
  int file = open(path, O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (file < 0) return false;
  bool own = fstat(file, &about) == 0 && S_ISREG(about.st_mode) && about.st_uid == geteuid() &&
             (about.st_mode & (S_IWGRP | S_IWOTH)) == 0 && about.st_size <= PROGRAM_CACHE_BYTES;
  bool found = own && read_program(file, (size_t)about.st_size, key, binary);
  close(file);
  return found;
}

/* ---- storing ---- */

static bool is_program(const char *name) {
  size_t length = strlen(name), suffix = strlen(CACHE_SUFFIX);
  return length > suffix && strcmp(name + length - suffix, CACHE_SUFFIX) == 0;
}

/* Removes the oldest program of a folder if the folder's programs have more than `most` bytes. Returns
 * whether a program was removed. */
static bool remove_oldest(const char *folder, uint64_t most) {
  char oldest[256] = "", path[4096];
  uint64_t bytes = 0;
  time_t when = 0;
  DIR *all = opendir(folder);
  if (all == NULL) return false;
  for (struct dirent *entry = readdir(all); entry != NULL; entry = readdir(all)) {
    struct stat about;
    if (!is_program(entry->d_name) || strlen(entry->d_name) >= sizeof oldest ||
        fstatat(dirfd(all), entry->d_name, &about, AT_SYMLINK_NOFOLLOW) != 0)
      continue;
    bytes += (uint64_t)about.st_size;
    if (oldest[0] != '\0' && about.st_mtime >= when) continue;
    when = about.st_mtime;
    memcpy(oldest, entry->d_name, strlen(entry->d_name) + 1);
  }
  closedir(all);
  int length = snprintf(path, sizeof path, "%s/%s", folder, oldest);
  return bytes > most && oldest[0] != '\0' && length > 0 && (size_t)length < sizeof path && unlink(path) == 0;
}

void hl_program_store(const char *folder, const char *key, const gpu_binary *binary) {
  char path[4096], beside[4200];
  uint32_t length = (uint32_t)strlen(key);
  if (folder == NULL || length >= PROGRAM_KEY_BYTES || binary->size > PROGRAM_CACHE_BYTES / 4 ||
      !name_of_key(folder, key, path, sizeof path))
    return;
  hl_private_folder_make(folder);
  snprintf(beside, sizeof beside, "%s.%ld", path, (long)getpid());
  int file = open(beside, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC | O_NOFOLLOW, 0600);
  if (file < 0) return;
  const uint64_t number = hl_hash_bytes(HL_HASH_BEGIN, binary->bytes, binary->size);
  bool written = write_all(file, &length, sizeof length) && write_all(file, key, length) &&
                 write_all(file, &number, sizeof number) && write_all(file, binary->bytes, binary->size);
  if (close(file) != 0 || !written || rename(beside, path) != 0) unlink(beside);
  while (remove_oldest(folder, PROGRAM_CACHE_BYTES)) continue;
}
