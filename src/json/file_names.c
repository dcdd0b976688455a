/* json/file_names.c - see file_names.h. */
#define _GNU_SOURCE
#include "json/file_names.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool hl_json_find_folder(const char *folder, char found[PATH_MAX]) {
  if (realpath(folder[0] != 0 ? folder : ".", found) == NULL) return false;
  size_t length = strlen(found);
  if (length > 1 && length + 1 < PATH_MAX) strcpy(found + length, "/");
  return length == 1 || length + 1 < PATH_MAX;
}

const char *hl_json_name_from(const char *folder, const char *file, char name[PATH_MAX]) {
  char parent[PATH_MAX], real[PATH_MAX];
  const char *slash = strrchr(file, '/'), *last = slash != NULL ? slash + 1 : file;
  size_t before = (size_t)(last - file), length = strlen(folder);
  if (before >= sizeof parent || strcmp(last, ".") == 0 || strcmp(last, "..") == 0) return file;
  memcpy(parent, file, before);
  parent[before] = 0;
  if (!hl_json_find_folder(parent, real) || strncmp(real, folder, length) != 0) return file;
  int written = snprintf(name, PATH_MAX, "%s%s", real + length, last);
  return written > 0 && written < PATH_MAX ? name : file;
}
