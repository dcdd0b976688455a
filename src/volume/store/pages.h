/* volume/store/pages.h - voxels in a scratch file, or in the memory of other ranks, for volumes that are
 * larger than memory.
 *
 * A scratch file holds pages: cubes of voxels. Page p of an axis holds the voxels from p * side to p * side +
 * side + PAGE_OVERLAP - 1, fewer at the grid's end. Therefore any 4x4x4 neighbouring voxels lie completely in
 * one page, the page of the first of them. The file is mapped: the system reads a page when one of its voxels
 * is needed. A sheet crosses few pages, and neighbouring sheets cross the same ones. The file has no name: it
 * is gone when the volume or the process is.
 *
 * Pages and the context's blocks together take no more than the context's memory limit, but always as much as
 * LEAST_PAGES: if one more page is needed, some pages that were not needed for long are given up (the clock
 * algorithm: F. J. Corbato, A Paging Experiment with the Multics System, 1968). Another thread may read such
 * a page at that moment: then the system reads it anew.
 *
 * Pages over ranks do not lie in a file: a page is copied from the ranks whose blocks hold it
 * (ranks/blocks.h), and forgotten as a whole. A thread that reads a page can tell by its version that it was
 * forgotten meanwhile, and then reads once more: see hl_page_begin(). */
#ifndef HL_VOLUME_PAGES_H
#define HL_VOLUME_PAGES_H

#include <pthread.h>

#include "volume/store/own_voxels.h"
#include "volume/volume.h"

/* The states of a page. FORGOTTEN: not in memory. HELD: in memory. NEEDED: in memory, and needed since the
 * clock's hand moved past it. COMING, over ranks: a thread is fetching it. */
enum { PAGE_FORGOTTEN = 0, PAGE_HELD = 1, PAGE_NEEDED = 2, PAGE_COMING = 3 /* over ranks */ };

enum {
  PAGE_SHIFT = 6,   /* a page's side is 2^6 = 64 voxels; tests use smaller pages */
  PAGE_OVERLAP = 3, /* voxels along an axis that a page shares with the next page */
  LEAST_PAGES = 16  /* number of pages that are held whatever the limit is */
};

typedef struct hl_pages {
  unsigned char *mapping; /* owned; [mapping_bytes]; the pages, with room for vector loads around them */
  size_t mapping_bytes;
  int file;             /* owned; the mapped file, until hl_pages_finish(); -1 if closed */
  unsigned char *first; /* the first page in the mapping */
  hl_context *context;  /* counts and limits the bytes of the pages that are held */
  hl_storage storage;
  size_t dimension[3];  /* voxels of the volume */
  size_t count[3];      /* numbers of pages; page (x, y, z) has the number (z * count[1] + y) * count[0] +
                         * x */
  unsigned char *state; /* owned; [pages]; a number PAGE_...; atomic */
  uint64_t held_bytes;  /* bytes of this volume's pages that are in memory; atomic */
  size_t hand;          /* the clock's hand: the page that it looks at next, modulo the number of pages;
                         * atomic */
  bool filled;          /* whether hl_pages_finish() was called */
  bool in_use;          /* whether a volume was made of these pages; over ranks, the other ranks may then ask
                         * for voxels */
  hl_blocks *blocks;    /* owned; null for a scratch file */
  hl_own_voxels *own;   /* owned; the voxels behind `blocks` */
  uint32_t *version;    /* owned; over ranks [pages], else null; rises when a page is forgotten; atomic */
  pthread_cond_t came;  /* over ranks: signalled when a page that a thread was fetching has arrived */
  pthread_mutex_t lock; /* held while values are counted; over ranks, also while the states of pages change */
  uint64_t *counts; /* owned; [hl_values_of(storage)]; counts of the stored values; null if they were taken,
                     * or for floats */
  size_t counted;   /* number of counted values */
  struct hl_brick_bounds *bricks; /* owned; bounds of the stored voxels' bricks (volume/brick_bounds.h); null
                                   * over ranks */
  struct hl_glimpse *glimpse; /* owned; glimpse of the stored voxels (volume/store/glimpse.h); may be null */
  int exact_file; /* owned; the file's own numbers (exact.h); -1 if the stored values are the numbers */
  int shift;
  size_t row_bytes, slice_bytes, page_bytes; /* distances in bytes: from row to row in a page, from slice to
                                              * slice in a page, and from page to page */
} hl_pages;

/* Makes a scratch file of zeros in the folder, whose space on the disk is taken at once. *pages is owned by
 * the caller, until a volume takes it over. */
hl_status hl_pages_create(hl_context *context, const char *folder, const hl_volume_description *grid,
                          int shift, hl_pages **pages, hl_error *error);
void hl_pages_release(hl_pages *pages); /* null is allowed */

/* Makes the pages of a volume over ranks, which are filled when they are needed. own: taken over, also on
 * failure. The call is collective, and so is the release. */
hl_status hl_pages_create_over_ranks(hl_ranks *ranks, hl_own_voxels *own, const hl_volume_description *grid,
                                     int shift, hl_pages **pages, hl_error *error);

/* Whether the voxels of a volume and a renderer's tables of them exceed the memory limit, and there is a
 * scratch folder. */
bool hl_pages_wanted(const hl_context *context, const hl_volume_description *grid);

/* Copies `count` stored values from number `first` on ([k][j][i]) into all pages that hold them. Each voxel
 * is stored at most once. Storing several whole slices at once is fastest. */
void hl_pages_store(hl_pages *pages, size_t first, size_t count, const void *values);

/* Takes the counts of each stored value. counts: [hl_values_of(storage)]. False for floats, for counts that
 * were taken before, and if voxels were not stored once each. */
bool hl_pages_take_counts(hl_pages *pages, uint64_t *counts);

/* Ends storing, after the last voxel. From now on a page that is needed is read as a whole, and no
 * neighbouring page with it. By itself the system would read farther, and its mapped memory would exceed the
 * bytes that are counted. */
void hl_pages_finish(hl_pages *pages);

/* Makes a volume over ranks. own: taken over, also on failure. shift: PAGE_SHIFT, or the shift of smaller
 * pages. name: starts the error lines. */
hl_status hl_volume_over_ranks(hl_ranks *ranks, const hl_volume_description *whole, hl_own_voxels *own,
                               int shift, const char *name, hl_volume **volume, hl_error *error);

/* Copies the voxels of a row. row: [dimension[0]] stored values. */
void hl_pages_load_row(const hl_pages *pages, size_t j, size_t k, void *row);

/* Forgets all pages. Called after a pass over all voxels, and before other memory is allocated. Other threads
 * may read pages meanwhile. */
void hl_pages_forget(const hl_pages *pages);

/* Forgets pages so that `bytes` can be allocated within the limit. Without this call, pages would exceed the
 * limit until the next page is needed. Other threads may read pages meanwhile. */
void hl_pages_leave_room(const hl_pages *pages, uint64_t bytes);

/* Takes a page into memory, or notes that it was needed if it is there. Forgets other pages if the limit is
 * reached. */
void hl_pages_hold(const hl_pages *pages, size_t number);

/* The page of a voxel along an axis. Voxels at the end of the grid may lie in the last page's overlap. */
static inline size_t hl_page_of(const hl_pages *pages, int axis, size_t voxel) {
  size_t page = voxel >> pages->shift;
  return page < pages->count[axis] ? page : pages->count[axis] - 1;
}

/* The place of a page while it is read. */
typedef struct hl_page_reading {
  const unsigned char *first; /* the page's first voxel, as stored */
  size_t number;
  uint32_t version; /* set over ranks */
} hl_page_reading;

/* Begins to read a page. The bytes that were read count only if hl_page_stayed() is true afterwards;
 * otherwise begin again (H.-J. Boehm, Can Seqlocks Get Along with Programming Language Memory Models?,
 * 2012). */
static inline hl_page_reading hl_page_begin(const hl_pages *pages, const size_t page[3]) {
  size_t number = (page[2] * pages->count[1] + page[1]) * pages->count[0] + page[0];
  uint32_t version = pages->version != NULL ? __atomic_load_n(&pages->version[number], __ATOMIC_ACQUIRE) : 0;
  if (__atomic_load_n(&pages->state[number], __ATOMIC_ACQUIRE) != PAGE_NEEDED) hl_pages_hold(pages, number);
  return (hl_page_reading){pages->first + number * pages->page_bytes, number, version};
}

/* Whether a page still has its voxels. Always true for pages in a file. */
static inline bool hl_page_stayed(const hl_pages *pages, const hl_page_reading *reading) {
  if (pages->version == NULL) return true;
  __atomic_thread_fence(__ATOMIC_ACQUIRE);
  return __atomic_load_n(&pages->version[reading->number], __ATOMIC_RELAXED) == reading->version;
}

/* Begins to read the page of a voxel. Returns the stored voxel and the voxels after it up to the page's
 * end. */
static inline const unsigned char *hl_page_voxel(const hl_pages *pages, size_t i, size_t j, size_t k,
                                                 hl_page_reading *reading) {
  const size_t page[3] = {hl_page_of(pages, 0, i), hl_page_of(pages, 1, j), hl_page_of(pages, 2, k)};
  *reading = hl_page_begin(pages, page);
  return reading->first + (k - (page[2] << pages->shift)) * pages->slice_bytes +
         (j - (page[1] << pages->shift)) * pages->row_bytes +
         (i - (page[0] << pages->shift)) * hl_storage_bytes(pages->storage);
}

/* The stored value of a voxel. */
static inline double hl_page_number(const hl_pages *pages, size_t i, size_t j, size_t k) {
  hl_page_reading reading;
  double number;
  do number = hl_stored_number(pages->storage, hl_page_voxel(pages, i, j, k, &reading), 0);
  while (!hl_page_stayed(pages, &reading));
  return number;
}

#endif
