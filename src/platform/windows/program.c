/* platform/windows/program.c - prepares the arguments and the standard streams, and finds the program's own
 * file. Afterwards the standard streams carry bytes without conversion, and the console's text is UTF-8. */
#include "platform/program.h"

#include <windows.h>

#include <shellapi.h>

#include <fcntl.h>
#include <io.h>
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "names.h"

/* Converts a text of the system to UTF-8. The caller frees the result. */
static char *narrow_text(const wchar_t *wide) {
  int bytes = WideCharToMultiByte(CP_UTF8, 0, wide, -1, NULL, 0, NULL, NULL);
  char *text = bytes > 0 ? malloc((size_t)bytes) : NULL;
  if (text != NULL) WideCharToMultiByte(CP_UTF8, 0, wide, -1, text, bytes, NULL, NULL);
  return text;
}

/* Replaces '\', which users type in names of files, by '/', which the program uses. */
static void turn_slashes(char *text) {
  for (char *c = text; *c != '\0'; c++)
    if (*c == '\\') *c = '/';
}

static void keep_colors(DWORD stream) {
  enum { VIRTUAL_TERMINAL = 4 };
  HANDLE console = GetStdHandle(stream);
  DWORD mode;
  if (GetConsoleMode(console, &mode)) SetConsoleMode(console, mode | VIRTUAL_TERMINAL);
}

void hl_program_begin(int *count, char ***arguments) {
  for (int descriptor = 0; descriptor < 3; descriptor++) _setmode(descriptor, _O_BINARY);
  SetConsoleOutputCP(CP_UTF8);
  keep_colors(STD_OUTPUT_HANDLE);
  keep_colors(STD_ERROR_HANDLE);
  int wide_count = 0;
  wchar_t **wide = CommandLineToArgvW(GetCommandLineW(), &wide_count);
  char **made = wide != NULL ? calloc((size_t)wide_count + 1, sizeof *made) : NULL;
  for (int n = 0; made != NULL && n < wide_count; n++) {
    /* If memory is short, the arguments of the C library are kept. */
    if ((made[n] = narrow_text(wide[n])) == NULL) return;
    turn_slashes(made[n]);
  }
  if (made == NULL) return;
  LocalFree(wide);
  *count = wide_count;
  *arguments = made;
}

bool hl_program_path(char *path, size_t size) {
  wchar_t wide[PATH_MAX];
  DWORD length = GetModuleFileNameW(NULL, wide, PATH_MAX);
  return length > 0 && length < PATH_MAX && hl_narrow_name(wide, length, path, size);
}
