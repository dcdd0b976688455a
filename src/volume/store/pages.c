/* volume/store/pages.c - see pages.h. */
#define _GNU_SOURCE
#include "volume/store/pages.h"

#include <errno.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/context.h"
#include "core/memory.h"
#include "volume/brick_bounds.h"
#include "volume/convert.h"
#include "volume/counts.h"
#include "volume/store/glimpse.h"
#include "volume/store/scratch_file.h"

/* ---- the scratch file ---- */

/* SLICES_AROUND: the mapping has room for this many slices before the first page and after the last, because
 * samplers load whole windows of voxels, which may reach beyond the volume. LINE: pages begin at a cache
 * line. UNIT, WHOLE_UNITS: pages of at least WHOLE_UNITS bytes, and pages over ranks, begin at one of the
 * system's units of memory. */
enum { SLICES_AROUND = 16, LINE = 64, UNIT = 4096, WHOLE_UNITS = 16 * UNIT };

static size_t round_up(size_t bytes, size_t unit) { return (bytes + unit - 1) / unit * unit; }

static bool multiply_all(const size_t *factors, int count, size_t *product) {
  *product = 1;
  for (int n = 0; n < count; n++)
    if (!hl_multiply(*product, factors[n], product)) return false;
  return true;
}

/* Sets all sizes of the pages and the mapping. in_units: whether each page begins at one of the system's
 * units of memory. Returns false if a size overflows. */
static bool plan(const hl_volume_description *grid, int shift, bool in_units, hl_pages *pages) {
  size_t side = (size_t)1 << shift, voxels[3];
  *pages = (hl_pages){.storage = hl_voxel_type_storage(grid->type), .shift = shift};
  for (int axis = 0; axis < 3; axis++) {
    size_t n = pages->dimension[axis] = grid->dimensions[axis];
    pages->count[axis] = n <= PAGE_OVERLAP ? 1 : (n - PAGE_OVERLAP + side - 1) >> shift;
    voxels[axis] = n < side + PAGE_OVERLAP ? n : side + PAGE_OVERLAP;
  }
  pages->row_bytes = voxels[0] * hl_storage_bytes(pages->storage);
  pages->slice_bytes = voxels[1] * pages->row_bytes;
  size_t page_bytes = voxels[2] * pages->slice_bytes;
  pages->page_bytes = round_up(page_bytes, !in_units && page_bytes < WHOLE_UNITS ? LINE : UNIT);
  const size_t factors[] = {pages->count[0], pages->count[1], pages->count[2], pages->page_bytes};
  size_t bytes, around = 2 * round_up(SLICES_AROUND * pages->slice_bytes, UNIT);
  return multiply_all(factors, 4, &bytes) && !__builtin_add_overflow(bytes, around, &pages->mapping_bytes) &&
         pages->mapping_bytes <= (size_t)INT64_MAX;
}

static size_t page_count(const hl_pages *pages) {
  return pages->count[0] * pages->count[1] * pages->count[2];
}

static hl_status map_scratch(hl_context *context, const char *folder, hl_pages *pages, hl_error *error) {
  size_t bytes = pages->mapping_bytes;
  int file = -1;
  hl_status status = hl_scratch_open(context, folder, bytes, &file, error);
  if (status != HL_OK) return status;
  void *mapping = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (mapping == MAP_FAILED) {
    status = hl_scratch_fail(folder, bytes, errno, error);
    close(file);
    return status;
  }
  pages->file = file;
  pages->mapping = mapping;
  pages->first = pages->mapping + round_up(SLICES_AROUND * pages->slice_bytes, UNIT);
  return HL_OK;
}

/* Allocates the arrays that are filled while voxels are stored: how often each value occurs, the bounds of
 * bricks, and a glimpse, which holds the few voxels that automatic choices read (glimpse.h). The glimpse
 * takes at most an eighth of the free memory. */
static hl_status allocate_findings(hl_context *context, hl_pages *pages, hl_error *error) {
  size_t values = hl_values_of(pages->storage);
  uint64_t taken = atomic_load(&context->whole->held) + atomic_load(&context->whole->paged),
           limit = context->options.memory_limit, most = limit > taken ? (limit - taken) / 8 : 0;
  if (values > 0) pages->counts = hl_allocate_zeroed(context, values, sizeof *pages->counts);
  if ((values > 0 && pages->counts == NULL) ||
      !hl_brick_bounds_create(context, pages->dimension, pages->storage, &pages->bricks) ||
      !hl_glimpse_create(context, pages->dimension, pages->storage, most, &pages->glimpse))
    return hl_fail_memory(error, values * sizeof *pages->counts, "a volume's pages");
  return HL_OK;
}

hl_status hl_pages_create(hl_context *context, const char *folder, const hl_volume_description *grid,
                          int shift, hl_pages **pages, hl_error *error) {
  *pages = NULL;
  hl_pages *made = hl_allocate_zeroed(context, 1, sizeof *made);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "a volume's pages");
  hl_status status = HL_OK;
  bool possible = plan(grid, shift, false, made);
  made->context = context;
  made->file = made->exact_file = -1;
  pthread_mutex_init(&made->lock, NULL); /* making a mutex without attributes cannot fail */
  pthread_cond_init(&made->came, NULL);
  if (!possible) status = hl_fail(error, HL_ERROR_INPUT, "%s: a volume too large for a file", folder);
  if (status == HL_OK) status = map_scratch(context, folder, made, error);
  size_t count = page_count(made);
  if (status == HL_OK && (made->state = hl_allocate_zeroed(context, count, 1)) == NULL)
    status = hl_fail_memory(error, count, "a volume's pages");
  if (status == HL_OK) status = allocate_findings(context, made, error);
  if (status == HL_OK) *pages = made;
  else hl_pages_release(made);
  return status;
}

static void count_held(hl_pages *pages, bool more) {
  uint64_t bytes = more ? pages->page_bytes : 0 - (uint64_t)pages->page_bytes;
  __atomic_fetch_add(&pages->held_bytes, bytes, __ATOMIC_RELAXED);
  atomic_fetch_add(&pages->context->whole->paged, bytes);
}

/* ---- sparse pages ---- */

/* Takes the next free place in the mapping for a sparse page, and sets all voxels of the page to the value of
 * voxels that are not stored. Returns the number of the place in the mapping. */
static size_t take_place(hl_pages *pages) {
  const size_t place = __atomic_fetch_add(&pages->places, 1, __ATOMIC_RELAXED),
               bytes = hl_storage_bytes(pages->storage);
  static const unsigned char zero[4] = {0};
  count_held(pages, true);
  if (memcmp(pages->value, zero, bytes) == 0) return place; /* new memory from the system is zero */
  unsigned char *to = pages->first + place * pages->page_bytes;
  for (size_t at = 0; at < pages->page_bytes; at += bytes) memcpy(to + at, pages->value, bytes);
  return place;
}

void hl_pages_own(hl_pages *pages, size_t number) {
  if (__atomic_load_n(&pages->place[number], __ATOMIC_ACQUIRE) != 0) return;
  pthread_mutex_lock(&pages->lock);
  if (pages->place[number] == 0)
    __atomic_store_n(&pages->place[number], (uint32_t)take_place(pages), __ATOMIC_RELEASE);
  pthread_mutex_unlock(&pages->lock);
}

double hl_pages_share(const hl_pages *pages) {
  return (double)(__atomic_load_n(&pages->places, __ATOMIC_RELAXED) - 1) / (double)page_count(pages);
}

/* Reserves addresses for the pages of a volume over ranks, or for sparse pages. The system gives memory to a
 * page when it is written. */
static hl_status map_nothing(hl_pages *pages, hl_error *error) {
  void *mapping = mmap(NULL, pages->mapping_bytes, PROT_READ | PROT_WRITE,
                       MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
  if (mapping == MAP_FAILED)
    return hl_fail(error, HL_ERROR_MEMORY, "out of memory: no addresses for %.1f MiB of voxels: %s",
                   (double)pages->mapping_bytes / (1 << 20), strerror(errno));
  /* without this call, the system could back several pages by one large page of memory */
  madvise(mapping, pages->mapping_bytes, MADV_NOHUGEPAGE);
  pages->mapping = mapping;
  pages->first = pages->mapping + round_up(SLICES_AROUND * pages->slice_bytes, UNIT);
  return HL_OK;
}

static hl_status allocate_states(hl_pages *pages, hl_error *error) {
  size_t count = page_count(pages);
  pages->state = hl_allocate_zeroed(pages->context, count, sizeof *pages->state);
  pages->version = hl_allocate_zeroed(pages->context, count, sizeof *pages->version);
  return pages->state != NULL && pages->version != NULL
             ? HL_OK
             : hl_fail_memory(error, count * (1 + sizeof *pages->version), "a volume's pages");
}

hl_status hl_pages_create_sparse(hl_context *context, const hl_volume_description *grid, int shift,
                                 const void *value, hl_pages **pages, hl_error *error) {
  *pages = NULL;
  hl_pages *made = hl_allocate_zeroed(context, 1, sizeof *made);
  if (made == NULL) return hl_fail_memory(error, sizeof *made, "a volume's pages");
  bool possible = plan(grid, shift, true, made) && page_count(made) < UINT32_MAX;
  made->mapping_bytes += made->page_bytes; /* place 0 stands for all pages in which nothing was stored */
  made->context = context;
  made->file = made->exact_file = -1;
  pthread_mutex_init(&made->lock, NULL);
  pthread_cond_init(&made->came, NULL);
  hl_status status = possible ? map_nothing(made, error)
                              : hl_fail(error, HL_ERROR_INPUT, "a volume too large for sparse pages");
  const size_t count = page_count(made);
  if (status == HL_OK) {
    made->state = hl_allocate(context, count, sizeof *made->state);
    made->place = hl_allocate_zeroed(context, count, sizeof *made->place);
    if (made->state == NULL || made->place == NULL)
      status = hl_fail_memory(error, count * (1 + sizeof *made->place), "a volume's pages");
  }
  if (status != HL_OK) {
    hl_pages_release(made);
    return status;
  }
  memcpy(made->value, value, hl_storage_bytes(made->storage));
  memset(made->state, PAGE_NEEDED, count);
  take_place(made);
  *pages = made;
  return HL_OK;
}

static hl_status fill_over_ranks(hl_ranks *ranks, const hl_volume_description *grid, int shift,
                                 hl_pages *pages, hl_error *error) {
  hl_own_voxels *own = pages->own;
  bool possible = plan(grid, shift, true, pages);
  pages->context = ranks->context;
  pages->own = own;
  pages->file = pages->exact_file = -1;
  pthread_mutex_init(&pages->lock, NULL);
  pthread_cond_init(&pages->came, NULL);
  if (!possible) return hl_fail(error, HL_ERROR_INPUT, "a volume too large for the addresses of a process");
  hl_status status = map_nothing(pages, error);
  if (status == HL_OK) status = allocate_states(pages, error);
  hl_blocks_shape shape = {.element_bytes = hl_storage_bytes(pages->storage)};
  memcpy(shape.dimension, grid->dimensions, sizeof shape.dimension);
  shape.most = pages->page_bytes / shape.element_bytes;
  const hl_block_source source = {own->box, hl_own_voxels_copy, own};
  return status == HL_OK ? hl_blocks_share(ranks, &shape, &source, &pages->blocks, error) : status;
}

hl_status hl_pages_create_over_ranks(hl_ranks *ranks, hl_own_voxels *own, const hl_volume_description *grid,
                                     int shift, hl_pages **pages, hl_error *error) {
  *pages = NULL;
  hl_pages *made = hl_allocate_zeroed(ranks->context, 1, sizeof *made);
  if (made == NULL) {
    hl_own_voxels_release(own);
    return hl_fail_memory(error, sizeof *made, "a volume's pages");
  }
  made->own = own;
  hl_status status = fill_over_ranks(ranks, grid, shift, made, error);
  if (status == HL_OK) *pages = made;
  else hl_pages_release(made);
  return status;
}

void hl_pages_release(hl_pages *pages) {
  if (pages == NULL) return;
  hl_blocks_release(pages->blocks, pages->in_use);
  hl_own_voxels_release(pages->own);
  if (pages->mapping != NULL) munmap(pages->mapping, pages->mapping_bytes);
  if (pages->file >= 0) close(pages->file);
  if (pages->exact_file >= 0) close(pages->exact_file);
  atomic_fetch_sub(&pages->context->whole->paged, pages->held_bytes);
  pthread_mutex_destroy(&pages->lock);
  pthread_cond_destroy(&pages->came);
  hl_brick_bounds_release(pages->bricks);
  hl_glimpse_release(pages->glimpse);
  hl_release(pages->context, pages->counts);
  hl_release(pages->context, pages->state);
  hl_release(pages->context, pages->version);
  hl_release(pages->context, pages->place);
  hl_release(pages->context, pages);
}

/* ---- which volumes ---- */

/* The least size in bytes of a volume that is put into a scratch file. */
static const uint64_t LEAST_BYTES = 4 << 20;

/* The number of bytes, approximately, that a renderer needs for each voxel in addition to the voxel itself:
 * for bounds and look-ups (grid/bounds.h), and for a rearranged copy of u8 voxels. */
static double bytes_beside(hl_storage storage) { return storage == HL_STORAGE_U8 ? 1.6 : 0.6; }

bool hl_pages_wanted(const hl_context *context, const hl_volume_description *grid) {
  const hl_context_options *options = &context->options;
  if (options->scratch_folder == NULL || options->memory_limit == 0) return false;
  hl_storage storage = hl_voxel_type_storage(grid->type);
  double voxels = (double)grid->dimensions[0] * (double)grid->dimensions[1] * (double)grid->dimensions[2];
  double bytes = (double)hl_storage_bytes(storage), held = (double)atomic_load(&context->whole->held);
  return voxels * bytes >= (double)LEAST_BYTES &&
         held + voxels * (bytes + bytes_beside(storage)) > (double)options->memory_limit;
}

/* ---- memory ---- */

/* A page fault may also map neighbouring units of memory. All units that a fault maps lie in an aligned
 * window of FAULT_WINDOW bytes (Linux, fault_around_bytes). */
enum { FAULT_WINDOW = 1 << 16 };

/* Gives the memory of a page back to the system, with all units of memory that page faults in the page may
 * have mapped. */
static void drop(const hl_pages *pages, size_t number) {
  uintptr_t first = (uintptr_t)pages->first + number * pages->page_bytes;
  if (pages->blocks != NULL) {
    madvise((void *)first, pages->page_bytes, MADV_DONTNEED);
    return;
  }
  uintptr_t begin = first / FAULT_WINDOW * FAULT_WINDOW;
  uintptr_t end = round_up(first + pages->page_bytes, FAULT_WINDOW);
  uintptr_t least = (uintptr_t)pages->mapping, most = least + pages->mapping_bytes / UNIT * UNIT;
  if (begin < least) begin = least;
  if (end > most) end = most;
  if (begin < end) madvise((void *)begin, end - begin, MADV_DONTNEED);
}

/* Forgets a page if the page is still in the state `state`. Other threads may have changed the state. */
static void forget_if(hl_pages *pages, size_t number, unsigned char state) {
  if (!__atomic_compare_exchange_n(&pages->state[number], &state, (unsigned char)PAGE_FORGOTTEN, false,
                                   __ATOMIC_RELAXED, __ATOMIC_RELAXED))
    return;
  if (pages->version != NULL) {
    __atomic_fetch_add(&pages->version[number], 1, __ATOMIC_RELAXED);
    __atomic_thread_fence(__ATOMIC_RELEASE);
  }
  drop(pages, number);
  count_held(pages, false);
}

/* Moves the clock's hand past one page. A page that was not needed since the hand's last visit is
 * forgotten. */
static void move_hand(hl_pages *pages, size_t count) {
  size_t number = __atomic_fetch_add(&pages->hand, 1, __ATOMIC_RELAXED) % count;
  unsigned char state = __atomic_load_n(&pages->state[number], __ATOMIC_RELAXED);
  if (state == PAGE_HELD) forget_if(pages, number, state);
  else if (state == PAGE_NEEDED)
    __atomic_compare_exchange_n(&pages->state[number], &state, (unsigned char)PAGE_HELD, false,
                                __ATOMIC_RELAXED, __ATOMIC_RELAXED);
}

/* The number of bytes of this volume's pages that may stay in memory when `bytes` more bytes are allocated;
 * UINT64_MAX if the context has no memory limit. */
static uint64_t room(const hl_pages *pages, uint64_t bytes) {
  hl_context *context = pages->context;
  uint64_t limit = context->options.memory_limit, least = LEAST_PAGES * (uint64_t)pages->page_bytes;
  if (limit == 0) return UINT64_MAX;
  uint64_t others = bytes + atomic_load(&context->whole->held) + atomic_load(&context->whole->paged) -
                    __atomic_load_n(&pages->held_bytes, __ATOMIC_RELAXED);
  return limit < others + least ? least : limit - others;
}

/* Makes room for an allocation of `bytes` bytes. If the pages in memory exceed the bytes that room() allows,
 * pages are forgotten until the pages take a sixteenth less than these bytes. Due to the surplus, pages are
 * forgotten seldom. */
static void make_room(hl_pages *pages, uint64_t bytes) {
  if (hl_pages_are_sparse(pages)) return;
  uint64_t most = room(pages, bytes);
  if (__atomic_load_n(&pages->held_bytes, __ATOMIC_RELAXED) <= most) return;
  size_t count = page_count(pages);
  most -= most / 16;
  for (size_t n = 0; n < 2 * count && __atomic_load_n(&pages->held_bytes, __ATOMIC_RELAXED) > most; n++)
    move_hand(pages, count);
}

void hl_pages_finish(hl_pages *pages) {
  pages->filled = true;
  if (pages->blocks != NULL || hl_pages_are_sparse(pages)) return;
  close(pages->file);
  pages->file = -1;
  madvise(pages->mapping, pages->mapping_bytes, MADV_RANDOM); /* from now on the system reads only the bytes
                                                               * that fetch() requests */
}

/* Asks the system to read a whole page at once. Without this request, the system would read each small part
 * of the page when the part is first accessed. */
static void fetch(const hl_pages *pages, size_t number) {
  uintptr_t first = (uintptr_t)pages->first + number * pages->page_bytes, begin = first / UNIT * UNIT;
  madvise((void *)begin, first + pages->page_bytes - begin, MADV_WILLNEED);
}

/* Copies a page's voxels from the ranks that hold them. */
static void fetch_from_ranks(const hl_pages *pages, size_t number) {
  const size_t *count = pages->count;
  const size_t page[3] = {number % count[0], number / count[0] % count[1], number / count[0] / count[1]};
  const size_t side = ((size_t)1 << pages->shift) + PAGE_OVERLAP;
  hl_box box;
  for (int axis = 0; axis < 3; axis++) {
    box.begin[axis] = page[axis] << pages->shift;
    size_t left = pages->dimension[axis] - box.begin[axis];
    box.count[axis] = left < side ? left : side;
  }
  hl_blocks_fetch(pages->blocks, &box, pages->first + number * pages->page_bytes, pages->row_bytes,
                  pages->slice_bytes);
}

/* Makes sure that a page over ranks is in memory. The page's state becomes PAGE_NEEDED only after all voxels
 * were copied, because other threads read the voxels of a page in this state. */
static void hold_over_ranks(hl_pages *pages, size_t number) {
  unsigned char state = PAGE_HELD;
  if (__atomic_compare_exchange_n(&pages->state[number], &state, (unsigned char)PAGE_NEEDED, false,
                                  __ATOMIC_ACQUIRE, __ATOMIC_ACQUIRE) ||
      state == PAGE_NEEDED)
    return;
  pthread_mutex_lock(&pages->lock);
  while ((state = __atomic_load_n(&pages->state[number], __ATOMIC_RELAXED)) == PAGE_COMING)
    pthread_cond_wait(&pages->came, &pages->lock);
  if (state == PAGE_FORGOTTEN) {
    __atomic_store_n(&pages->state[number], (unsigned char)PAGE_COMING, __ATOMIC_RELAXED);
    count_held(pages, true);
    make_room(pages, 0);
    pthread_mutex_unlock(&pages->lock); /* without the lock, other threads can fetch other pages while this
                                         * thread waits */
    fetch_from_ranks(pages, number);
    pthread_mutex_lock(&pages->lock);
    pthread_cond_broadcast(&pages->came);
  }
  __atomic_store_n(&pages->state[number], (unsigned char)PAGE_NEEDED, __ATOMIC_RELEASE);
  pthread_mutex_unlock(&pages->lock);
}

void hl_pages_hold(const hl_pages *held, size_t number) {
  hl_pages *pages = (hl_pages *)held; /* readers get constant pages, but holding a page changes its state */
  if (pages->blocks != NULL) {
    hold_over_ranks(pages, number);
    return;
  }
  unsigned char before = __atomic_exchange_n(&pages->state[number], (unsigned char)PAGE_NEEDED,
                                             __ATOMIC_RELAXED);
  if (before != PAGE_FORGOTTEN) return;
  count_held(pages, true);
  make_room(pages, 0);
  if (pages->filled) fetch(pages, number);
}

void hl_pages_leave_room(const hl_pages *pages, uint64_t bytes) {
  pthread_mutex_t *lock = (pthread_mutex_t *)&pages->lock;
  pthread_mutex_lock(lock);
  make_room((hl_pages *)pages, bytes);
  pthread_mutex_unlock(lock);
}

void hl_pages_forget(const hl_pages *pages) {
  if (hl_pages_are_sparse(pages)) return;
  size_t count = page_count(pages);
  pthread_mutex_t *lock = (pthread_mutex_t *)&pages->lock;
  pthread_mutex_lock(lock);
  for (size_t n = 0; n < count; n++) {
    unsigned char state = __atomic_load_n(&pages->state[n], __ATOMIC_RELAXED);
    if (state == PAGE_HELD || state == PAGE_NEEDED) forget_if((hl_pages *)pages, n, state);
  }
  pthread_mutex_unlock(lock);
}

/* Gives back the memory of all sparse pages that have the same index along z. */
static void drop_layer(hl_pages *pages, size_t z) {
  const size_t layer = pages->count[0] * pages->count[1];
  for (size_t number = z * layer; number < (z + 1) * layer; number++)
    if (pages->place[number] != 0) madvise(hl_page_first(pages, number), pages->page_bytes, MADV_DONTNEED);
}

void hl_pages_spread(hl_pages *pages, void *voxels) {
  const size_t *n = pages->dimension, row = n[0] * hl_storage_bytes(pages->storage);
  unsigned char *to = voxels;
  for (size_t k = 0; k < n[2]; k++) {
    if (k > 0 && hl_page_of(pages, 2, k) > hl_page_of(pages, 2, k - 1))
      drop_layer(pages, hl_page_of(pages, 2, k - 1));
    for (size_t j = 0; j < n[1]; j++, to += row) hl_pages_load_row(pages, j, k, to);
  }
}

/* ---- the stored voxels ---- */

bool hl_pages_take_counts(hl_pages *pages, uint64_t *counts) {
  const size_t *n = pages->dimension;
  bool whole = pages->counts != NULL && pages->counted == n[0] * n[1] * n[2];
  if (whole) memcpy(counts, pages->counts, hl_values_of(pages->storage) * sizeof *counts);
  hl_release(pages->context, pages->counts);
  pages->counts = NULL;
  return whole;
}

/* Copies row (j, k) from this rank's own block. Returns false unless the block contains the whole row. */
static bool own_row(const hl_pages *pages, size_t j, size_t k, void *row) {
  if (pages->own == NULL) return false;
  const hl_box wanted = {{0, j, k}, {pages->dimension[0], 1, 1}};
  hl_box held;
  if (!hl_boxes_meet(&wanted, &pages->own->box, &held) || held.count[0] < wanted.count[0]) return false;
  hl_own_voxels_copy(pages->own, &wanted, row);
  return true;
}

void hl_pages_load_row(const hl_pages *pages, size_t j, size_t k, void *row) {
  size_t bytes = hl_storage_bytes(pages->storage), width = pages->dimension[0];
  const void *kept = pages->glimpse != NULL ? hl_glimpse_row(pages->glimpse, j, k) : NULL;
  if (kept != NULL) memcpy(row, kept, width * bytes);
  if (kept != NULL || own_row(pages, j, k, row)) return;
  for (size_t page = 0; page < pages->count[0]; page++) {
    size_t begin = page << pages->shift,
           end = page + 1 < pages->count[0] ? begin + ((size_t)1 << pages->shift) : width;
    hl_page_reading reading;
    do
      memcpy((unsigned char *)row + begin * bytes, hl_page_voxel(pages, begin, j, k, &reading),
             (end - begin) * bytes);
    while (!hl_page_stayed(pages, &reading));
  }
}
