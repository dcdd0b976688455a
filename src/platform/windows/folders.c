/* platform/windows/folders.c - lists the names in a folder, by the folder's handle
 * (platform/windows/include/dirent.h). */
#include <windows.h>

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <stdbool.h>
#include <stdlib.h>
#include <unistd.h>

#include "platform/windows/names.h"

struct hl_folder_listing {
  int descriptor; /* owned */
  bool begun;
  FILE_ID_BOTH_DIR_INFO *next; /* points into `entries`; null if all entries were read */
  struct dirent entry;
  _Alignas(8) unsigned char entries[1 << 16];
};

DIR *fdopendir(int descriptor) {
  DIR *folder = calloc(1, sizeof *folder);
  if (folder != NULL) folder->descriptor = descriptor;
  return folder;
}

DIR *opendir(const char *path) {
  int descriptor = open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  DIR *folder = descriptor >= 0 ? fdopendir(descriptor) : NULL;
  if (folder == NULL && descriptor >= 0) close(descriptor);
  return folder;
}

/* Reads the next entries of a folder. Returns false if the folder has no further entries. */
static bool fetch(DIR *folder) {
  HANDLE handle = (HANDLE)_get_osfhandle(folder->descriptor);
  FILE_INFO_BY_HANDLE_CLASS how = folder->begun ? FileIdBothDirectoryInfo : FileIdBothDirectoryRestartInfo;
  folder->begun = true;
  if (!GetFileInformationByHandleEx(handle, how, folder->entries, sizeof folder->entries)) return false;
  folder->next = (FILE_ID_BOTH_DIR_INFO *)folder->entries;
  return true;
}

struct dirent *readdir(DIR *folder) {
  while (folder->next != NULL || fetch(folder)) {
    const FILE_ID_BOTH_DIR_INFO *entry = folder->next;
    folder->next = entry->NextEntryOffset > 0
                       ? (FILE_ID_BOTH_DIR_INFO *)((unsigned char *)entry + entry->NextEntryOffset)
                       : NULL;
    if (hl_narrow_name(entry->FileName, entry->FileNameLength / sizeof *entry->FileName, folder->entry.d_name,
                       sizeof folder->entry.d_name))
      return &folder->entry;
  }
  return NULL;
}

int closedir(DIR *folder) {
  int result = close(folder->descriptor);
  free(folder);
  return result;
}

int dirfd(DIR *folder) { return folder->descriptor; }
