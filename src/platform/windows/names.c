/* platform/windows/names.c - see names.h. */
#include "platform/windows/names.h"

#include <windows.h>

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>

wchar_t *hl_wide_text(const char *text) {
  int length = MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text, -1, NULL, 0);
  wchar_t *wide = length > 0 ? malloc((size_t)length * sizeof *wide) : NULL;
  if (wide == NULL) {
    errno = length > 0 ? ENOMEM : ENOENT;
    return NULL;
  }
  MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, text, -1, wide, length);
  for (wchar_t *c = wide; *c != 0; c++)
    if (*c == L'/') *c = L'\\';
  return wide;
}

/* Makes the absolute name with the prefix that lifts the limit of 260 characters. The function frees the name
 * `wide`. */
static wchar_t *lift_limit(wchar_t *wide) {
  static const wchar_t prefix[] = L"\\\\?\\";
  DWORD most = GetFullPathNameW(wide, 0, NULL, NULL);
  wchar_t *whole = malloc((most + 4) * sizeof *whole);
  if (whole != NULL) {
    memcpy(whole, prefix, 4 * sizeof *whole);
    GetFullPathNameW(wide, most, whole + 4, NULL);
  } else errno = ENOMEM;
  free(wide);
  return whole;
}

wchar_t *hl_wide_name(const char *path) {
  enum { LONG_NAME = 240 };
  wchar_t *wide = strcmp(path, "/dev/null") == 0 ? wcsdup(L"NUL") : hl_wide_text(path);
  if (wide == NULL || wcslen(wide) < LONG_NAME || wcsncmp(wide, L"\\\\", 2) == 0) return wide;
  return lift_limit(wide);
}

bool hl_narrow_name(const wchar_t *wide, size_t length, char *text, size_t size) {
  int written = WideCharToMultiByte(CP_UTF8, 0, wide, (int)length, text, (int)size - 1, NULL, NULL);
  if (written <= 0 && length > 0) return false;
  text[written] = '\0';
  for (char *c = text; *c != '\0'; c++)
    if (*c == '\\') *c = '/';
  return true;
}

bool hl_choose_name(char *path) {
  static const char letters[] = "abcdefghijklmnopqrstuvwxyz234567"; /* 32 letters */
  enum { LETTERS = 6 };
  unsigned char random[LETTERS];
  if (getrandom(random, sizeof random, 0) != (ssize_t)sizeof random) return false;
  char *end = path + strlen(path) - LETTERS;
  for (int i = 0; i < LETTERS; i++) end[i] = letters[random[i] % 32];
  return true;
}

int hl_system_error(unsigned long error) {
  static const struct {
    unsigned long error;
    int number;
  } known[] = {{ERROR_FILE_NOT_FOUND, ENOENT},
               {ERROR_PATH_NOT_FOUND, ENOENT},
               {ERROR_INVALID_NAME, ENOENT},
               {ERROR_BAD_PATHNAME, ENOENT},
               {ERROR_INVALID_DRIVE, ENOENT},
               {ERROR_BAD_NETPATH, ENOENT},
               {ERROR_ACCESS_DENIED, EACCES},
               {ERROR_SHARING_VIOLATION, EACCES},
               {ERROR_LOCK_VIOLATION, EACCES},
               {ERROR_WRITE_PROTECT, EROFS},
               {ERROR_FILE_EXISTS, EEXIST},
               {ERROR_ALREADY_EXISTS, EEXIST},
               {ERROR_DIRECTORY, ENOTDIR},
               {ERROR_DIR_NOT_EMPTY, ENOTEMPTY},
               {ERROR_TOO_MANY_OPEN_FILES, EMFILE},
               {ERROR_NOT_ENOUGH_MEMORY, ENOMEM},
               {ERROR_OUTOFMEMORY, ENOMEM},
               {ERROR_COMMITMENT_LIMIT, ENOMEM},
               {ERROR_DISK_FULL, ENOSPC},
               {ERROR_HANDLE_DISK_FULL, ENOSPC},
               {ERROR_FILENAME_EXCED_RANGE, ENAMETOOLONG},
               {ERROR_INVALID_HANDLE, EBADF},
               {ERROR_BROKEN_PIPE, EPIPE},
               {ERROR_NO_DATA, EPIPE}};
  errno = EIO;
  for (size_t n = 0; n < sizeof known / sizeof *known; n++)
    if (known[n].error == error) errno = known[n].number;
  return -1;
}
