/* platform/windows/paths.c - implements calls that take names of files: the calls open streams, rename and
 * remove files, and find the current folder. */
#include <windows.h>

#include <direct.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "platform/nameless_file.h"
#include "platform/paths.h"
#include "platform/windows/names.h"

/* Names of the network ("//server/share/file") do not count as absolute, because a scene with such a name
 * could make the system send the user's identity to that server. A name of the network is appended to a
 * folder's name, and thus means a file below the folder. */
bool hl_path_is_absolute(const char *path) {
  bool drive = ((path[0] | 0x20) >= 'a' && (path[0] | 0x20) <= 'z') && path[1] == ':';
  bool slash = path[0] == '/' || path[0] == '\\';
  return drive || (slash && path[1] != '/' && path[1] != '\\');
}

FILE *hl_posix_fopen(const char *path, const char *mode) {
  const wchar_t *wide_mode = mode[0] == 'r' ? L"rbN" : mode[0] == 'w' ? L"wbN" : L"abN";
  wchar_t *name = hl_wide_name(path);
  FILE *file = name != NULL ? _wfopen(name, wide_mode) : NULL;
  free(name);
  return file;
}

FILE *hl_posix_tmpfile(void) {
  wchar_t folder[MAX_PATH + 1];
  char path[4 * MAX_PATH + 32];
  DWORD length = GetTempPathW(MAX_PATH, folder);
  if (length == 0 || length > MAX_PATH || !hl_narrow_name(folder, length, path, sizeof path - 32))
    return NULL;
  strcat(path, "halflight-XXXXXX");
  int descriptor = hl_nameless_file(path);
  return descriptor >= 0 ? _fdopen(descriptor, "w+b") : NULL;
}

/* Calls a function of the system with a file's name. */
static int on_name(const char *path, BOOL (*call)(const wchar_t *)) {
  wchar_t *name = hl_wide_name(path);
  if (name == NULL) return -1;
  int result = call(name) ? 0 : hl_system_error(GetLastError());
  free(name);
  return result;
}

static BOOL make_folder(const wchar_t *name) { return CreateDirectoryW(name, NULL); }
static BOOL remove_file(const wchar_t *name) { return DeleteFileW(name); }
static BOOL remove_folder(const wchar_t *name) { return RemoveDirectoryW(name); }
static BOOL enter_folder(const wchar_t *name) { return SetCurrentDirectoryW(name); }
static BOOL find(const wchar_t *name) { return GetFileAttributesW(name) != INVALID_FILE_ATTRIBUTES; }

static BOOL find_writable(const wchar_t *name) {
  DWORD attributes = GetFileAttributesW(name);
  bool folder = attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
  if (folder || (attributes & FILE_ATTRIBUTE_READONLY) == 0)
    return TRUE; /* for folders, the attribute "read only" has no meaning */
  if (attributes != INVALID_FILE_ATTRIBUTES) SetLastError(ERROR_ACCESS_DENIED);
  return FALSE;
}

int hl_posix_mkdir(const char *path, int mode) {
  (void)mode;
  return on_name(path, make_folder);
}

int hl_posix_unlink(const char *path) { return on_name(path, remove_file); }
int hl_posix_rmdir(const char *path) { return on_name(path, remove_folder); }
int hl_posix_chdir(const char *path) { return on_name(path, enter_folder); }

int hl_posix_access(const char *path, int mode) {
  return on_name(path, (mode & W_OK) != 0 ? find_writable : find);
}

int hl_posix_rename(const char *from, const char *to) {
  wchar_t *before = hl_wide_name(from), *after = hl_wide_name(to);
  int result = -1;
  if (before != NULL && after != NULL)
    result = MoveFileExW(before, after, MOVEFILE_REPLACE_EXISTING) ? 0 : hl_system_error(GetLastError());
  free(before);
  free(after);
  return result;
}

char *hl_posix_getcwd(char *path, size_t size) {
  wchar_t wide[PATH_MAX];
  DWORD length = GetCurrentDirectoryW(PATH_MAX, wide);
  if (path == NULL && (path = malloc(size = PATH_MAX)) == NULL) return NULL;
  if (length > 0 && length < PATH_MAX && hl_narrow_name(wide, length, path, size)) return path;
  errno = ERANGE;
  return NULL;
}

/* Writes the absolute name of the file that a handle has opened, after following links. The prefix "\\?\" is
 * removed, and "\\?\UNC\" becomes "\\". */
static char *final_name(HANDLE handle, char *resolved) {
  wchar_t wide[PATH_MAX];
  DWORD length = GetFinalPathNameByHandleW(handle, wide, PATH_MAX, VOLUME_NAME_DOS);
  size_t begin = 0;
  if (wcsncmp(wide, L"\\\\?\\UNC\\", 8) == 0) wide[begin = 6] = L'\\';
  else if (wcsncmp(wide, L"\\\\?\\", 4) == 0) begin = 4;
  if (length > 0 && length < PATH_MAX && hl_narrow_name(wide + begin, length - begin, resolved, PATH_MAX))
    return resolved;
  errno = ENAMETOOLONG;
  return NULL;
}

char *realpath(const char *path, char *resolved) {
  wchar_t *name = hl_wide_name(path);
  if (name == NULL) return NULL;
  HANDLE handle = CreateFileW(name, FILE_READ_ATTRIBUTES,
                              FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, NULL, OPEN_EXISTING,
                              FILE_FLAG_BACKUP_SEMANTICS, NULL);
  free(name);
  if (handle == INVALID_HANDLE_VALUE) {
    hl_system_error(GetLastError());
    return NULL;
  }
  char *made = resolved != NULL ? resolved : malloc(PATH_MAX);
  char *found = made != NULL ? final_name(handle, made) : NULL;
  if (found == NULL && resolved == NULL) free(made);
  CloseHandle(handle);
  return found;
}

char *hl_posix_mkdtemp(char *path) {
  enum { TRIES = 1000 };
  for (int n = 0; n < TRIES && hl_choose_name(path); n++) {
    if (hl_posix_mkdir(path, 0) == 0) return path;
    if (errno != EEXIST) return NULL;
  }
  return NULL;
}

int symlink(const char *path, const char *name) {
  (void)path, (void)name;
  errno = ENOSYS;
  return -1;
}

unsigned geteuid(void) { return 0; }
