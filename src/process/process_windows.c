/* process/process_windows.c - starts, limits, awaits and ends a child process on Windows. */
#include <windows.h>

#include <errno.h>
#include <io.h>
#include <stdlib.h>
#include <string.h>

#include "process.h"

/* The handles of a child that is being started: its input, its output and its messages. The child inherits no
 * other handles. */
enum { STREAMS = 3 };

/* ---- the command line ---- */

/* Writes a word into the command line from `at` on, in quotes. When the child's C library splits the line
 * again, two backslashes before a quote stand for one backslash. Returns the position after the word. text:
 * if null, the characters are only counted. */
static size_t append_word(wchar_t *text, size_t at, const wchar_t *word) {
  size_t slashes = 0;
#define PUT(c) (text != NULL ? (void)(text[at] = (c)) : (void)0, at++)
  PUT(L'"');
  for (const wchar_t *c = word;; c++) {
    if (*c == L'\\') {
      slashes++;
      PUT(*c);
      continue;
    }
    for (; slashes > 0 && (*c == L'"' || *c == 0); slashes--) PUT(L'\\');
    slashes = 0;
    if (*c == 0) break;
    if (*c == L'"') PUT(L'\\');
    PUT(*c);
  }
  PUT(L'"');
  PUT(L' ');
#undef PUT
  return at;
}

static wchar_t *wide_of(const char *text) {
  int length = MultiByteToWideChar(CP_UTF8, 0, text, -1, NULL, 0);
  wchar_t *wide = malloc((size_t)length * sizeof *wide);
  if (wide != NULL) MultiByteToWideChar(CP_UTF8, 0, text, -1, wide, length);
  return wide;
}

/* Joins the words to one text, which the caller frees. Returns null if memory is short. */
static wchar_t *command_line(const char *const *words) {
  wchar_t *line = NULL;
  size_t length = 0;
  for (size_t w = 0; words[w] != NULL; w++) {
    wchar_t *word = wide_of(words[w]);
    size_t end = word != NULL ? append_word(NULL, length, word) : 0;
    wchar_t *longer = word != NULL ? realloc(line, (end + 1) * sizeof *longer) : NULL;
    if (longer == NULL) {
      free(word);
      free(line);
      return NULL;
    }
    line = longer;
    append_word(line, length, word);
    free(word);
    line[length = end] = 0;
  }
  return line;
}

/* ---- starting ---- */

static HANDLE inherited(HANDLE handle) {
  HANDLE copy = NULL, self = GetCurrentProcess();
  return DuplicateHandle(self, handle, self, &copy, 0, TRUE, DUPLICATE_SAME_ACCESS) ? copy : NULL;
}

static HANDLE open_nothing(DWORD access) {
  SECURITY_ATTRIBUTES inherits = {.nLength = sizeof inherits, .bInheritHandle = TRUE};
  HANDLE handle = CreateFileW(L"NUL", access, FILE_SHARE_READ | FILE_SHARE_WRITE, &inherits, OPEN_EXISTING, 0,
                              NULL);
  return handle != INVALID_HANDLE_VALUE ? handle : NULL;
}

static int error_number(DWORD error) {
  if (error == ERROR_FILE_NOT_FOUND || error == ERROR_PATH_NOT_FOUND) return ENOENT;
  return error == ERROR_ACCESS_DENIED ? EACCES : error == ERROR_NOT_ENOUGH_MEMORY ? ENOMEM : EIO;
}

/* Starts the child, which inherits only the three handles of its streams. */
static int spawn(process *p, wchar_t *line, HANDLE streams[STREAMS]) {
  SIZE_T bytes = 0;
  InitializeProcThreadAttributeList(NULL, 1, 0, &bytes);
  LPPROC_THREAD_ATTRIBUTE_LIST list = malloc(bytes);
  if (list == NULL) return ENOMEM;
  STARTUPINFOEXW how = {.StartupInfo = {.cb = sizeof how,
                                        .dwFlags = STARTF_USESTDHANDLES,
                                        .hStdInput = streams[0],
                                        .hStdOutput = streams[1],
                                        .hStdError = streams[2]},
                        .lpAttributeList = list};
  PROCESS_INFORMATION made;
  BOOL good = InitializeProcThreadAttributeList(list, 1, 0, &bytes) &&
              UpdateProcThreadAttribute(list, 0, PROC_THREAD_ATTRIBUTE_HANDLE_LIST, streams,
                                        STREAMS * sizeof *streams, NULL, NULL) &&
              CreateProcessW(NULL, line, NULL, NULL, TRUE,
                             CREATE_NEW_PROCESS_GROUP | CREATE_NO_WINDOW | EXTENDED_STARTUPINFO_PRESENT, NULL,
                             NULL, &how.StartupInfo, &made);
  int problem = good ? 0 : error_number(GetLastError());
  DeleteProcThreadAttributeList(list);
  free(list);
  if (!good) return problem;
  CloseHandle(made.hThread);
  p->child = (intptr_t)made.hProcess;
  return 0;
}

int process_start(process *p, const char *const *words, int input) {
  *p = (process){0, tmpfile()};
  if (p->messages == NULL) return errno;
  HANDLE streams[STREAMS] = {
      input >= 0 ? inherited((HANDLE)_get_osfhandle(input)) : open_nothing(GENERIC_READ),
      open_nothing(GENERIC_WRITE), inherited((HANDLE)_get_osfhandle(_fileno(p->messages)))};
  wchar_t *line = command_line(words);
  bool ready = line != NULL && streams[0] != NULL && streams[1] != NULL && streams[2] != NULL;
  int problem = ready ? spawn(p, line, streams) : ENOMEM;
  free(line);
  for (int n = 0; n < STREAMS; n++)
    if (streams[n] != NULL) CloseHandle(streams[n]);
  return problem;
}

bool process_is_there(const char *name) {
  wchar_t found[MAX_PATH], *wide = wide_of(name);
  bool there = wide != NULL && SearchPathW(NULL, wide, L".exe", MAX_PATH, found, NULL) > 0;
  free(wide);
  return there;
}

/* ---- a running child ---- */

/* Limits the child's memory by a job object, which exists as long as the child. The length of files is not
 * limited, because Windows has no such limit. */
void process_limit(const process *p, uint64_t memory, uint64_t file) {
  (void)file;
  HANDLE job = p->child != 0 ? CreateJobObjectW(NULL, NULL) : NULL;
  if (job == NULL) return;
  JOBOBJECT_EXTENDED_LIMIT_INFORMATION limits = {
      .BasicLimitInformation = {.LimitFlags = JOB_OBJECT_LIMIT_PROCESS_MEMORY}, .ProcessMemoryLimit = memory};
  if (SetInformationJobObject(job, JobObjectExtendedLimitInformation, &limits, sizeof limits))
    AssignProcessToJobObject(job, (HANDLE)p->child);
  CloseHandle(job);
}

/* Waits for the child's end, but no longer than the given time. */
static bool await(process *p, DWORD milliseconds, bool *succeeded) {
  DWORD code = 1;
  *succeeded = false;
  if (p->child == 0) return true;
  HANDLE child = (HANDLE)p->child;
  if (WaitForSingleObject(child, milliseconds) == WAIT_TIMEOUT) return false;
  *succeeded = GetExitCodeProcess(child, &code) && code == 0;
  CloseHandle(child);
  p->child = 0;
  return true;
}

bool process_has_ended(process *p, bool *succeeded) { return await(p, 0, succeeded); }

bool process_wait(process *p) {
  bool succeeded;
  await(p, INFINITE, &succeeded);
  return succeeded;
}

void process_end(process *p) {
  if (p->child != 0) TerminateProcess((HANDLE)p->child, 1);
  process_wait(p);
  if (p->messages != NULL) fclose(p->messages);
  p->messages = NULL;
}
