/* platform/posix/memory.c - see platform/memory.h. */
#define _GNU_SOURCE /* madvise, _SC_PHYS_PAGES */
#include "platform/memory.h"

#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

/* The size of a large page, and the least size of blocks for which large pages are requested. With small
 * pages, every row of a tile would lie in a page of its own, and translating the pages' addresses would take
 * longer than reading the rows. */
enum { LARGE_PAGE = 1 << 21, LARGE_BLOCK = 1 << 22 };

uint64_t hl_machine_memory(void) {
  const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGESIZE);
  return pages > 0 && page_bytes > 0 ? (uint64_t)pages * (uint64_t)page_bytes : 0;
}

void *hl_aligned_allocate(size_t bytes, size_t alignment) {
  if (bytes < LARGE_BLOCK) return aligned_alloc(alignment, bytes);
  void *block = NULL; /* aligned_alloc() is not used here, because it might accept only multiples of the page
                       * size */
  if (posix_memalign(&block, LARGE_PAGE, bytes) != 0) return NULL;
#ifdef MADV_HUGEPAGE
  madvise(block, bytes, MADV_HUGEPAGE);
#endif
  return block;
}

void hl_aligned_release(void *memory) { free(memory); }
