/* platform/windows/mapping.c - maps files into memory (platform/windows/include/sys/mman.h), and allocates
 * memory (platform/memory.h). */
#include <windows.h>

#include <errno.h>
#include <io.h>
#include <malloc.h>
#include <sys/mman.h>

#include "platform/memory.h"
#include "platform/windows/names.h"

static void *map_file(HANDLE file, size_t bytes, DWORD protection, DWORD access) {
  HANDLE mapping = CreateFileMappingW(file, NULL, protection, (DWORD)((unsigned long long)bytes >> 32),
                                      (DWORD)bytes, NULL);
  if (mapping == NULL) return NULL;
  void *view = MapViewOfFile(mapping, access, 0, 0, bytes);
  DWORD error = GetLastError();
  CloseHandle(mapping); /* the mapping stays open as long as its view */
  SetLastError(error);
  return view;
}

void *mmap(void *address, size_t bytes, int protection, int flags, int descriptor, off_t offset) {
  bool written = (protection & PROT_WRITE) != 0;
  void *view = NULL;
  if (address != NULL || offset != 0) SetLastError(ERROR_NOT_SUPPORTED);
  else if ((flags & MAP_ANONYMOUS) != 0)
    view = VirtualAlloc(NULL, bytes, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
  else
    view = map_file((HANDLE)_get_osfhandle(descriptor), bytes, written ? PAGE_READWRITE : PAGE_READONLY,
                    written ? FILE_MAP_READ | FILE_MAP_WRITE : FILE_MAP_READ);
  if (view != NULL) return view;
  hl_system_error(GetLastError());
  return MAP_FAILED;
}

int munmap(void *begin, size_t bytes) {
  (void)bytes;
  return UnmapViewOfFile(begin) || VirtualFree(begin, 0, MEM_RELEASE) ? 0 : hl_system_error(GetLastError());
}

/* Gives memory back for MADV_DONTNEED: VirtualUnlock() of memory that is not locked removes the memory from
 * the process's working set. */
int madvise(void *begin, size_t bytes, int advice) {
  if (advice == MADV_DONTNEED) VirtualUnlock(begin, bytes);
  return 0;
}

void *hl_aligned_allocate(size_t bytes, size_t alignment) { return _aligned_malloc(bytes, alignment); }

void hl_aligned_release(void *memory) { _aligned_free(memory); }
