/* platform/windows/files.c - implements functions on open files: descriptors, reading and writing at an
 * offset, size and kind. */
#include <windows.h>

#include <winternl.h>

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include "platform/nameless_file.h"
#include "platform/windows/names.h"

enum {
  FOR_CREATION = O_CREAT | O_EXCL | O_TRUNC,
  SHARED = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE
};

static HANDLE handle_of(int descriptor) { return (HANDLE)_get_osfhandle(descriptor); }

/* ---- opening ---- */

static DWORD access_of(int flags) {
  if ((flags & O_PATH) != 0) return FILE_READ_ATTRIBUTES | SYNCHRONIZE;
  int how = flags & (O_RDONLY | O_WRONLY | O_RDWR);
  return (how != O_WRONLY ? FILE_GENERIC_READ : 0) | (how != O_RDONLY ? FILE_GENERIC_WRITE : 0);
}

static DWORD creation_of(int flags) {
  if ((flags & (O_CREAT | O_EXCL)) == (O_CREAT | O_EXCL)) return CREATE_NEW;
  if ((flags & O_CREAT) != 0) return (flags & O_TRUNC) != 0 ? CREATE_ALWAYS : OPEN_ALWAYS;
  return (flags & O_TRUNC) != 0 ? TRUNCATE_EXISTING : OPEN_EXISTING;
}

/* Makes a descriptor for a handle, which the descriptor then owns. Fails for links if the flags include
 * O_NOFOLLOW, and for files that are no folders if the flags include O_DIRECTORY. */
static int descriptor_of(HANDLE handle, int flags) {
  BY_HANDLE_FILE_INFORMATION about;
  int problem = 0;
  if ((flags & (O_NOFOLLOW | O_DIRECTORY)) != 0) {
    if (!GetFileInformationByHandle(handle, &about)) problem = EACCES;
    else if ((flags & O_NOFOLLOW) != 0 && (about.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) != 0)
      problem = ELOOP;
    else if ((flags & O_DIRECTORY) != 0 && (about.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) == 0)
      problem = ENOTDIR;
  }
  int descriptor = problem == 0 ? _open_osfhandle((intptr_t)handle,
                                                  _O_BINARY | (flags & (_O_NOINHERIT | _O_RDWR | _O_WRONLY)))
                                : -1;
  if (descriptor < 0) {
    CloseHandle(handle);
    if (problem != 0) errno = problem;
  }
  return descriptor;
}

int hl_posix_open(const char *path, int flags, ...) {
  wchar_t *name = hl_wide_name(path);
  if (name == NULL) return -1;
  DWORD of_link = (flags & O_NOFOLLOW) != 0 ? FILE_FLAG_OPEN_REPARSE_POINT : 0;
  HANDLE handle = CreateFileW(
      name, access_of(flags), SHARED, NULL, creation_of(flags),
      FILE_FLAG_BACKUP_SEMANTICS | SECURITY_SQOS_PRESENT | SECURITY_ANONYMOUS | of_link, NULL);
  DWORD error = GetLastError();
  free(name);
  return handle != INVALID_HANDLE_VALUE ? descriptor_of(handle, flags) : hl_system_error(error);
}

/* Opens a file below the folder of a handle. If `name` is empty, opens the folder itself. */
static HANDLE open_below(HANDLE folder, wchar_t *name, int flags) {
  size_t bytes = wcslen(name) * sizeof *name;
  UNICODE_STRING text = {.Length = (USHORT)bytes, .MaximumLength = (USHORT)bytes, .Buffer = name};
  OBJECT_ATTRIBUTES object = {.Length = sizeof object,
                              .RootDirectory = folder,
                              .ObjectName = &text,
                              .Attributes = OBJ_CASE_INSENSITIVE};
  IO_STATUS_BLOCK result;
  HANDLE handle = NULL;
  ULONG options = FILE_SYNCHRONOUS_IO_NONALERT | FILE_OPEN_FOR_BACKUP_INTENT |
                  ((flags & O_DIRECTORY) != 0 ? FILE_DIRECTORY_FILE : 0) |
                  ((flags & O_NOFOLLOW) != 0 ? FILE_OPEN_REPARSE_POINT : 0);
  NTSTATUS status = NtCreateFile(&handle, access_of(flags), &object, &result, NULL, 0, SHARED, FILE_OPEN,
                                 options, NULL, 0);
  if (status >= 0) return handle;
  hl_system_error(RtlNtStatusToDosError(status));
  return INVALID_HANDLE_VALUE;
}

int hl_posix_openat(int folder, const char *path, int flags, ...) {
  if (path[0] == '/' || strpbrk(path, ":\\") != NULL || (flags & FOR_CREATION) != 0) {
    /* Absolute names, names on a drive, names of a second stream of a file (':'), and flags that create a
     * file are refused. */
    errno = (flags & FOR_CREATION) != 0 ? EINVAL : ENOENT;
    return -1;
  }
  wchar_t *name = hl_wide_text(strcmp(path, ".") == 0 ? "" : path);
  if (name == NULL) return -1;
  HANDLE handle = INVALID_HANDLE_VALUE;
  if (wcslen(name) < 0x7fff) handle = open_below(handle_of(folder), name, flags);
  else errno = ENAMETOOLONG;
  free(name);
  return handle != INVALID_HANDLE_VALUE ? descriptor_of(handle, flags) : -1;
}

int hl_posix_fcntl(int descriptor, int command) {
  if (command != F_GETFD || handle_of(descriptor) != INVALID_HANDLE_VALUE) return 0;
  errno = EBADF;
  return -1;
}

int hl_nameless_file(char *path) {
  enum { TRIES = 1000 };
  for (int n = 0; n < TRIES; n++) {
    if (!hl_choose_name(path)) return -1;
    wchar_t *name = hl_wide_name(path);
    if (name == NULL) return -1;
    HANDLE handle = CreateFileW(name, FILE_GENERIC_READ | FILE_GENERIC_WRITE | DELETE, SHARED, NULL,
                                CREATE_NEW, FILE_ATTRIBUTE_TEMPORARY | FILE_FLAG_DELETE_ON_CLOSE, NULL);
    DWORD error = GetLastError();
    free(name);
    if (handle != INVALID_HANDLE_VALUE) return descriptor_of(handle, O_RDWR | O_CLOEXEC);
    if (error != ERROR_FILE_EXISTS) return hl_system_error(error);
  }
  errno = EEXIST;
  return -1;
}

/* ---- reading and writing ---- */

enum { MOST_AT_ONCE = 1 << 30 }; /* in bytes; the system's calls take numbers of 32 bits */

static DWORD at_once(size_t count) { return count < MOST_AT_ONCE ? (DWORD)count : MOST_AT_ONCE; }

ssize_t hl_posix_read(int descriptor, void *bytes, size_t count) {
  return _read(descriptor, bytes, at_once(count));
}

ssize_t hl_posix_write(int descriptor, const void *bytes, size_t count) {
  return _write(descriptor, bytes, at_once(count));
}

/* Reads or writes at an offset of the file, and does not change the descriptor's own position. */
static ssize_t transfer(int descriptor, void *into, const void *from, size_t count, off_t offset) {
  HANDLE handle = handle_of(descriptor);
  LARGE_INTEGER before, none = {.QuadPart = 0};
  OVERLAPPED place = {.Offset = (DWORD)offset, .OffsetHigh = (DWORD)(offset >> 32)};
  DWORD done = 0;
  BOOL known = SetFilePointerEx(handle, none, &before, FILE_CURRENT);
  BOOL good = into != NULL ? ReadFile(handle, into, at_once(count), &done, &place)
                           : WriteFile(handle, from, at_once(count), &done, &place);
  DWORD error = GetLastError();
  if (known) SetFilePointerEx(handle, before, NULL, FILE_BEGIN);
  if (!good && error == ERROR_HANDLE_EOF) return 0;
  return good ? (ssize_t)done : hl_system_error(error);
}

ssize_t pread(int descriptor, void *bytes, size_t count, off_t offset) {
  return transfer(descriptor, bytes, NULL, count, offset);
}

ssize_t pwrite(int descriptor, const void *bytes, size_t count, off_t offset) {
  return transfer(descriptor, NULL, bytes, count, offset);
}

int pipe2(int ends[2], int flags) {
  enum { PIPE_BYTES = 1 << 16 };
  return _pipe(ends, PIPE_BYTES, _O_BINARY | (flags & _O_NOINHERIT));
}

int posix_fallocate(int descriptor, off_t offset, off_t bytes) {
  return _filelengthi64(descriptor) >= offset + bytes || _chsize_s(descriptor, offset + bytes) == 0 ? 0
                                                                                                    : errno;
}

int poll(struct pollfd *wanted, unsigned count, int milliseconds) {
  HANDLE handle = handle_of(wanted->fd);
  wanted->revents = POLLIN;
  if (GetFileType(handle) != FILE_TYPE_PIPE) return (int)count;
  for (int waited = 0;; waited++) {
    DWORD ready = 0;
    if (!PeekNamedPipe(handle, NULL, 0, NULL, &ready, NULL) || ready > 0) return (int)count;
    if (waited == milliseconds) break;
    Sleep(1);
  }
  wanted->revents = 0;
  return 0;
}

int hl_posix_isatty(int descriptor) {
  DWORD mode;
  return GetConsoleMode(handle_of(descriptor), &mode);
}

/* ---- the attributes of a file ---- */

static struct timespec time_of(FILETIME time) {
  static const long long TICKS_TO_1970 = 116444736000000000, TICKS = 10000000; /* a tick is 100 ns; the system
                                                                                * counts ticks from the year
                                                                                * 1601 */
  long long ticks = ((long long)time.dwHighDateTime << 32 | time.dwLowDateTime) - TICKS_TO_1970;
  return (struct timespec){.tv_sec = ticks / TICKS, .tv_nsec = (long)(ticks % TICKS * 100)};
}

int hl_posix_fstat(int descriptor, struct stat *about) {
  HANDLE handle = handle_of(descriptor);
  BY_HANDLE_FILE_INFORMATION found;
  *about = (struct stat){.st_mode = S_IFCHR};
  DWORD type = GetFileType(handle);
  if (type == FILE_TYPE_PIPE) about->st_mode = S_IFIFO;
  if (type != FILE_TYPE_DISK)
    return handle != INVALID_HANDLE_VALUE ? 0 : hl_system_error(ERROR_INVALID_HANDLE);
  if (!GetFileInformationByHandle(handle, &found)) return hl_system_error(GetLastError());
  bool folder = (found.dwFileAttributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
  bool link = (found.dwFileAttributes & FILE_ATTRIBUTE_REPARSE_POINT) != 0;
  about->st_mode = (link ? S_IFLNK : folder ? S_IFDIR : S_IFREG) | S_IRUSR | S_IWUSR;
  about->st_dev = found.dwVolumeSerialNumber;
  about->st_ino = (unsigned long long)found.nFileIndexHigh << 32 | found.nFileIndexLow;
  about->st_size = (long long)((unsigned long long)found.nFileSizeHigh << 32 | found.nFileSizeLow);
  about->st_mtim = time_of(found.ftLastWriteTime);
  return 0;
}

/* Describes the file of a descriptor, and closes the descriptor. */
static int stat_opened(int descriptor, struct stat *about) {
  if (descriptor < 0) return -1;
  int result = hl_posix_fstat(descriptor, about);
  _close(descriptor);
  return result;
}

int hl_posix_stat(const char *path, struct stat *about) {
  return stat_opened(hl_posix_open(path, O_PATH | O_CLOEXEC), about);
}

/* Describes a file below a folder. If AT_SYMLINK_NOFOLLOW is set and the file is a link, describes the link
 * itself. To describe a link, the function opens the link itself with flags without O_NOFOLLOW, so that
 * descriptor_of() does not refuse it. */
int hl_posix_fstatat(int folder, const char *path, struct stat *about, int flags) {
  wchar_t *name = strpbrk(path, ":\\") == NULL ? hl_wide_text(path) : NULL;
  if (name == NULL) return errno = ENOENT, -1;
  int how = O_PATH | O_CLOEXEC;
  HANDLE handle = open_below(handle_of(folder), name,
                             how | ((flags & AT_SYMLINK_NOFOLLOW) != 0 ? O_NOFOLLOW : 0));
  free(name);
  return handle != INVALID_HANDLE_VALUE ? stat_opened(descriptor_of(handle, how), about) : -1;
}

int fstatvfs(int descriptor, struct statvfs *about) {
  wchar_t folder[MAX_PATH + 1];
  ULARGE_INTEGER free_bytes;
  DWORD length = GetFinalPathNameByHandleW(handle_of(descriptor), folder, MAX_PATH, VOLUME_NAME_DOS);
  while (length > 0 && length <= MAX_PATH && folder[length - 1] != L'\\') length--;
  if (length == 0 || length > MAX_PATH) return errno = ENOSYS, -1;
  folder[length] = 0;
  if (!GetDiskFreeSpaceExW(folder, &free_bytes, NULL, NULL)) return hl_system_error(GetLastError());
  *about = (struct statvfs){.f_frsize = 1, .f_bavail = free_bytes.QuadPart};
  return 0;
}
