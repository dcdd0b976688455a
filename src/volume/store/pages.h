/* volume/store/pages.h - stores voxels in pages: in a scratch file or in the memory of other ranks for
 * volumes that are larger than memory, or in sparse pages in memory for volumes most of whose voxels have one
 * value.
 *
 * A scratch file holds pages: cubes of voxels. Page p of an axis holds the voxels from p * side to p * side +
 * side + PAGE_OVERLAP - 1, and fewer voxels at the grid's end. Therefore any 4x4x4 neighbouring voxels lie
 * completely in the page of their first voxel. The file is mapped into memory, and the system reads a page
 * when a voxel of the page is needed. A renderer's sheet crosses few pages, and neighbouring sheets cross
 * mostly the same pages. The scratch file has no name, so that the file vanishes with the volume or the
 * process.
 *
 * Pages and the context's blocks together stay below the context's memory limit, except that LEAST_PAGES
 * pages are always allowed. If a further page is needed, pages that were not needed for the longest time are
 * forgotten (the clock algorithm: F. J. Corbato, A Paging Experiment with the Multics System, 1968). If
 * another thread is reading a page that is forgotten, the system reads the page from the file again.
 *
 * Pages over ranks do not lie in a file: a page is copied from the ranks whose blocks hold the page's voxels
 * (ranks/blocks.h), and is forgotten as a whole. Each page has a version, which changes when the page is
 * forgotten. A thread that has read voxels of a page compares versions, and reads the voxels again if the
 * page was forgotten meanwhile: see hl_page_begin().
 *
 * Sparse pages lie in memory, in the order in which their first voxels were stored. All pages in which no
 * voxel was stored share one page of memory, whose voxels have one value. Sparse pages are never
 * forgotten. */
#ifndef HL_VOLUME_PAGES_H
#define HL_VOLUME_PAGES_H

#include <pthread.h>

#include "volume/store/own_voxels.h"
#include "volume/volume.h"

/* The states of a page. FORGOTTEN: the page is not in memory. HELD: the page is in memory. NEEDED: the page
 * is in memory, and was needed since the clock's hand moved past it. COMING: a thread is fetching the page
 * from other ranks. */
enum { PAGE_FORGOTTEN = 0, PAGE_HELD = 1, PAGE_NEEDED = 2, PAGE_COMING = 3 /* only over ranks */ };

enum {
  PAGE_SHIFT = 6,   /* a page's side is 2^6 = 64 voxels; tests use smaller pages */
  PAGE_OVERLAP = 3, /* number of voxels along an axis that a page has in common with the next page */
  LEAST_PAGES = 16  /* number of pages that may be in memory even if they exceed the memory limit */
};

typedef struct hl_pages {
  unsigned char *mapping; /* owned; [mapping_bytes]; the pages, and space before and after them for vector
                           * loads */
  size_t mapping_bytes;
  int file;             /* owned; the mapped file; -1 after hl_pages_finish() has closed it */
  unsigned char *first; /* address of the first page in the mapping */
  hl_context *context;  /* the context, whose count and limit of memory include the pages */
  hl_storage storage;
  size_t dimension[3];  /* number of voxels of the volume along each axis */
  size_t count[3];      /* number of pages along each axis; page (x, y, z) has the number (z * count[1] + y) *
                         * count[0] + x */
  unsigned char *state; /* owned; [pages]; the state of each page, PAGE_...; atomic */
  uint64_t held_bytes;  /* bytes of this volume's pages that are in memory; atomic */
  size_t hand;          /* the clock's hand: modulo the number of pages, the number of the page that the hand
                         * reaches next; atomic */
  bool filled;          /* whether hl_pages_finish() has been called */
  bool in_use;          /* whether the pages belong to a volume; if several ranks share the volume, other
                         * ranks can request voxels while in_use is true */
  hl_blocks *blocks;    /* owned; the blocks of all ranks, for pages over ranks; else null */
  hl_own_voxels *own;   /* owned; the voxels of this rank's block */
  uint32_t *version;    /* owned; [pages] over ranks, else null; the version of each page, which rises when
                         * the page is forgotten; atomic */
  uint32_t *place;      /* owned; [pages] of sparse pages, else null; the place of each page in the mapping,
                         * counted in pages; 0 for pages in which nothing was stored; atomic */
  size_t places;        /* number of places in the mapping that are taken, including place 0; atomic */
  unsigned char value[4]; /* for sparse pages, the stored value of voxels that were not stored */
  pthread_cond_t came;    /* if several ranks share the volume, signalled when a page that was being fetched
                           * is complete */
  pthread_mutex_t lock;   /* held while values are counted; if several ranks share the volume, also while the
                           * states of pages change */
  uint64_t *counts; /* owned; [hl_values_of(storage)]; how often each stored value occurs; null for floats,
                     * and after the counts were taken */
  size_t counted;   /* number of stored values that were counted */
  struct hl_brick_bounds *bricks; /* owned; bounds of the bricks of the stored voxels (volume/brick_bounds.h);
                                   * null over ranks */
  struct hl_glimpse *glimpse; /* owned; glimpse of the stored voxels (volume/store/glimpse.h); may be null */
  int exact_file; /* owned; file with the file's own numbers (exact.h); -1 if the stored values are these
                   * numbers */
  int shift;
  size_t row_bytes, slice_bytes, page_bytes; /* number of bytes from a row of a page to the next, from a slice
                                              * of a page to the next, and from a page to the next */
} hl_pages;

/* Makes pages in a new scratch file in the folder. The file's space on the disk is reserved at once, and all
 * voxels are zeros. *pages is owned by the caller, until a volume takes it over. */
hl_status hl_pages_create(hl_context *context, const char *folder, const hl_volume_description *grid,
                          int shift, hl_pages **pages, hl_error *error);
void hl_pages_release(hl_pages *pages); /* null is allowed */

/* Makes the pages of a volume over ranks. A page gets its voxels from the ranks when the page is needed. own:
 * the pages take over the block, also on failure. All ranks must call hl_pages_create_over_ranks() and
 * hl_pages_release(). */
hl_status hl_pages_create_over_ranks(hl_ranks *ranks, hl_own_voxels *own, const hl_volume_description *grid,
                                     int shift, hl_pages **pages, hl_error *error);

/* Makes sparse pages in memory, whose voxels have the stored value `value` until they are stored. Addresses
 * are reserved for all pages, and memory is taken for pages in which voxels are stored. */
hl_status hl_pages_create_sparse(hl_context *context, const hl_volume_description *grid, int shift,
                                 const void *value, hl_pages **pages, hl_error *error);
static inline bool hl_pages_are_sparse(const hl_pages *pages) { return pages->place != NULL; }

/* The fraction of all sparse pages in which voxels were stored, 0 to 1. */
double hl_pages_share(const hl_pages *pages);

/* Allocates the memory of a sparse page, unless the page has memory already. Several threads may call
 * hl_pages_own() at the same time. */
void hl_pages_own(hl_pages *pages, size_t number);

/* Stores a box of voxels in sparse pages. values: [count[2]][count[1]][count[0]]; stored values. Several
 * threads may store different voxels at the same time. */
void hl_pages_store_box(hl_pages *pages, const size_t begin[3], const size_t count[3], const void *values);

/* Copies all voxels of sparse pages to `voxels` ([k][j][i]), and gives back the memory of pages as soon as
 * their voxels are copied. Afterwards the caller can only release the pages. */
void hl_pages_spread(hl_pages *pages, void *voxels);

/* Returns whether none of `count` voxels from number `first` on ([k][j][i]) lies in a sparse page in which
 * voxels were stored. Returns false if the pages are not sparse. */
bool hl_pages_have_one_value(const hl_pages *pages, size_t first, size_t count);

/* Returns whether a volume should be put into a scratch file. The result is true if the context has a scratch
 * folder, and if the voxels and a renderer's tables for them exceed the free memory within the limit. */
bool hl_pages_wanted(const hl_context *context, const hl_volume_description *grid);

/* Stores `count` values from number `first` on ([k][j][i]) in all pages that hold these voxels. Each voxel
 * may be stored only once. Storing several whole slices at once is fastest. */
void hl_pages_store(hl_pages *pages, size_t first, size_t count, const void *values);

/* Copies the counts of the stored values, and releases the pages' own counts. counts:
 * [hl_values_of(storage)]. Returns false for floats, if the counts were taken before, or if not each voxel
 * was stored once. */
bool hl_pages_take_counts(hl_pages *pages, uint64_t *counts);

/* Must be called after the last voxel was stored. After hl_pages_finish(), a needed page is read as a whole,
 * and without neighbouring pages. Before hl_pages_finish(), the system reads farther than the page, and maps
 * more memory than is counted. */
void hl_pages_finish(hl_pages *pages);

/* Makes a volume over ranks. own: the volume takes over the block, also on failure. shift: a page's side is
 * 2^shift voxels; usually PAGE_SHIFT. name: starts the error lines. */
hl_status hl_volume_over_ranks(hl_ranks *ranks, const hl_volume_description *whole, hl_own_voxels *own,
                               int shift, const char *name, hl_volume **volume, hl_error *error);

/* Copies the voxels of a row. row: [dimension[0]] stored values. */
void hl_pages_load_row(const hl_pages *pages, size_t j, size_t k, void *row);

/* Forgets all pages. Callers call hl_pages_forget() after a pass over all voxels, before they allocate other
 * memory. Other threads may read pages during the call. */
void hl_pages_forget(const hl_pages *pages);

/* Forgets pages until `bytes` bytes can be allocated within the limit. Without hl_pages_leave_room(), the
 * memory limit would be exceeded until the next page is needed. Other threads may read pages during the
 * call. */
void hl_pages_leave_room(const hl_pages *pages, uint64_t bytes);

/* Makes sure that a page is in memory, and marks the page as needed. Forgets other pages if the memory limit
 * is reached. */
void hl_pages_hold(const hl_pages *pages, size_t number);

/* The index, along an axis, of the page of a voxel. A voxel at the end of the grid may belong to the last
 * page as a part of its overlap. */
static inline size_t hl_page_of(const hl_pages *pages, int axis, size_t voxel) {
  size_t page = voxel >> pages->shift;
  return page < pages->count[axis] ? page : pages->count[axis] - 1;
}

/* A page whose voxels a thread is reading. */
typedef struct hl_page_reading {
  const unsigned char *first; /* the stored value of the page's first voxel; further voxels follow */
  size_t number;
  uint32_t version; /* the page's version at hl_page_begin(); set only over ranks */
} hl_page_reading;

/* A pointer to the first voxel of a page. */
static inline unsigned char *hl_page_first(const hl_pages *pages, size_t number) {
  size_t place = pages->place != NULL ? __atomic_load_n(&pages->place[number], __ATOMIC_ACQUIRE) : number;
  return pages->first + place * pages->page_bytes;
}

/* Begins to read a page. Voxels that were read are valid only if hl_page_stayed() is true afterwards;
 * otherwise the caller begins again (H.-J. Boehm, Can Seqlocks Get Along with Programming Language Memory
 * Models?, 2012). */
static inline hl_page_reading hl_page_begin(const hl_pages *pages, const size_t page[3]) {
  size_t number = (page[2] * pages->count[1] + page[1]) * pages->count[0] + page[0];
  uint32_t version = pages->version != NULL ? __atomic_load_n(&pages->version[number], __ATOMIC_ACQUIRE) : 0;
  if (__atomic_load_n(&pages->state[number], __ATOMIC_ACQUIRE) != PAGE_NEEDED) hl_pages_hold(pages, number);
  return (hl_page_reading){hl_page_first(pages, number), number, version};
}

/* Returns whether a page has kept its voxels since hl_page_begin(). For pages in a file the result is always
 * true. */
static inline bool hl_page_stayed(const hl_pages *pages, const hl_page_reading *reading) {
  if (pages->version == NULL) return true;
  __atomic_thread_fence(__ATOMIC_ACQUIRE);
  return __atomic_load_n(&pages->version[reading->number], __ATOMIC_RELAXED) == reading->version;
}

/* Begins to read the page of a voxel. Returns a pointer to the voxel's stored value; the voxels after it in
 * the page follow. */
static inline const unsigned char *hl_page_voxel(const hl_pages *pages, size_t i, size_t j, size_t k,
                                                 hl_page_reading *reading) {
  const size_t page[3] = {hl_page_of(pages, 0, i), hl_page_of(pages, 1, j), hl_page_of(pages, 2, k)};
  *reading = hl_page_begin(pages, page);
  return reading->first + (k - (page[2] << pages->shift)) * pages->slice_bytes +
         (j - (page[1] << pages->shift)) * pages->row_bytes +
         (i - (page[0] << pages->shift)) * hl_storage_bytes(pages->storage);
}

/* The stored value of voxel (i, j, k), as a double. */
static inline double hl_page_number(const hl_pages *pages, size_t i, size_t j, size_t k) {
  hl_page_reading reading;
  double number;
  do number = hl_stored_number(pages->storage, hl_page_voxel(pages, i, j, k, &reading), 0);
  while (!hl_page_stayed(pages, &reading));
  return number;
}

#endif
