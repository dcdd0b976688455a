/* platform/windows/system.c - implements functions that concern the machine and the process: processors,
 * memory, signals, libraries, random numbers. */
#include <windows.h>

#include <psapi.h>

#include <dlfcn.h>
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/resource.h>
#include <unistd.h>

#include "platform/memory.h"
#include "platform/paths.h"
#include "platform/processors.h"
#include "platform/windows/names.h"

/* ---- the machine ---- */

int hl_cpu_count(void) {
  DWORD_PTR of_process = 0, of_system = 0;
  DWORD all = GetActiveProcessorCount(ALL_PROCESSOR_GROUPS);
  if (GetActiveProcessorGroupCount() > 1) return (int)all; /* the mask covers only one group */
  if (!GetProcessAffinityMask(GetCurrentProcess(), &of_process, &of_system)) return all > 0 ? (int)all : 1;
  int count = __builtin_popcountll(of_process);
  return count > 0 ? count : 1;
}

double hl_cpu_quota(const char *root) {
  (void)root;
  return INFINITY;
}

long sysconf(int name) {
  SYSTEM_INFO about;
  GetSystemInfo(&about);
  if (name == _SC_PAGESIZE) return (long)about.dwPageSize;
  return name == _SC_NPROCESSORS_ONLN ? hl_cpu_count() : -1;
}

uint64_t hl_machine_memory(void) {
  MEMORYSTATUSEX memory = {.dwLength = sizeof memory};
  return GlobalMemoryStatusEx(&memory) ? memory.ullTotalPhys : 0;
}

int getrusage(int who, struct rusage *usage) {
  PROCESS_MEMORY_COUNTERS counters;
  (void)who;
  if (!GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters))
    return hl_system_error(GetLastError());
  usage->ru_maxrss = (long)(counters.PeakWorkingSetSize / 1024);
  return 0;
}

ssize_t getrandom(void *bytes, size_t count, unsigned flags) {
  unsigned number;
  (void)flags;
  for (size_t n = 0; n < count; n++) {
    if (rand_s(&number) != 0) return -1;
    ((unsigned char *)bytes)[n] = (unsigned char)number;
  }
  return (ssize_t)count;
}

/* ---- the environment ---- */

/* The value, in UTF-8, of an environment variable that a caller has asked for. The library keeps these
 * values, because the C library has values only in the system's code page. */
typedef struct kept_value {
  struct kept_value *next;
  char text[];
} kept_value;

/* Stores a value in the list of kept values, unless the list already has the value. Returns null if memory is
 * short. */
static char *keep(const wchar_t *wide) {
  static kept_value *first;
  static SRWLOCK lock = SRWLOCK_INIT;
  int bytes = WideCharToMultiByte(CP_UTF8, 0, wide, -1, NULL, 0, NULL, NULL);
  kept_value *made = malloc(sizeof *made + (size_t)bytes);
  if (made == NULL) return NULL;
  WideCharToMultiByte(CP_UTF8, 0, wide, -1, made->text, bytes, NULL, NULL);
  AcquireSRWLockExclusive(&lock);
  kept_value *found = first;
  while (found != NULL && strcmp(found->text, made->text) != 0) found = found->next;
  if (found == NULL) made->next = first, first = made;
  ReleaseSRWLockExclusive(&lock);
  if (found != NULL) free(made);
  return found != NULL ? found->text : made->text;
}

char *hl_posix_getenv(const char *name) {
  wchar_t *wide_name = hl_wide_text(name);
  const wchar_t *value = wide_name != NULL ? _wgetenv(wide_name) : NULL;
  free(wide_name);
  return value != NULL ? keep(value) : NULL;
}

const char *hl_temporary_folder(void) {
  const char *folder = getenv("TEMP");
  return folder != NULL && folder[0] != '\0' ? folder : "C:/Windows/Temp";
}

/* ---- signals ---- */

#undef signal

int sigfillset(sigset_t *signals) {
  *signals = ~(sigset_t)0;
  return 0;
}

int sigemptyset(sigset_t *signals) {
  *signals = 0;
  return 0;
}

int pthread_sigmask(int how, const sigset_t *signals, sigset_t *before) {
  (void)how, (void)signals;
  if (before != NULL) *before = 0;
  return 0;
}

void (*hl_posix_signal(int number, void (*handler)(int)))(int) {
  return number == SIGPIPE || number == SIGXFSZ ? SIG_DFL : signal(number, handler);
}

int sigaction(int number, const struct sigaction *action, struct sigaction *before) {
  (void)before;
  if (action != NULL && number != SIGHUP && signal(number, action->sa_handler) != SIG_ERR) return 0;
  errno = EINVAL;
  return -1;
}

/* ---- libraries ---- */

void *dlopen(const char *name, int flags) {
  if ((flags & RTLD_NOLOAD) != 0) return GetModuleHandleA(name);
  return LoadLibraryExA(name, NULL, LOAD_LIBRARY_SEARCH_SYSTEM32);
}

void *dlsym(void *library, const char *name) {
  FARPROC found = GetProcAddress(library, name);
  void *address;
  memcpy(&address, &found, sizeof address);
  return address;
}

int dlclose(void *library) { return FreeLibrary(library) ? 0 : -1; }

const char *dlerror(void) { return "this system has no such library"; }
