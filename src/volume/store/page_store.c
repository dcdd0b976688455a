/* volume/store/page_store.c - stores voxels into the pages of a scratch file, and into sparse pages
 * (pages.h).
 *
 * Whole slices, and whole rows of a slice, are written to the file page by page, in as few pieces as
 * possible. If whole slices were copied into the mapping, the system would first have to map each unit of
 * memory, and to read or clear it. Only incomplete rows are copied into the mapping. */
#define _GNU_SOURCE
#include <string.h>

#include "volume/brick_bounds.h"
#include "volume/counts.h"
#include "volume/store/glimpse.h"
#include "volume/store/pages.h"
#include "volume/store/scratch_file.h"

/* ---- parts of rows ---- */

/* Finds which pages along an axis hold a voxel: the function returns the number of the first page, and *last
 * is set to the number of the last page. The two numbers differ if the voxel lies where pages overlap. */
static size_t first_page(const hl_pages *pages, int axis, size_t voxel, size_t *last) {
  *last = hl_page_of(pages, axis, voxel);
  size_t within = voxel - (*last << pages->shift), first = *last;
  /* a small page may overlap with more than one other page */
  while (first > 0 &&
         within + ((*last - first + 1) << pages->shift) < ((size_t)1 << pages->shift) + PAGE_OVERLAP)
    first--;
  return first;
}

/* Copies a part of a row, from index at[0] on, into the pages of one row along x. */
static void store_in_pages(hl_pages *pages, const size_t page_y_z[2], const size_t at[3], size_t count,
                           const unsigned char *values) {
  size_t bytes = hl_storage_bytes(pages->storage), end = at[0] + count, last, ignored;
  first_page(pages, 0, end - 1, &last);
  for (size_t x = first_page(pages, 0, at[0], &ignored); x <= last; x++) {
    size_t begin = x << pages->shift, stop = begin + ((size_t)1 << pages->shift) + PAGE_OVERLAP;
    size_t from = at[0] > begin ? at[0] : begin, to = end < stop ? end : stop;
    const size_t page[3] = {x, page_y_z[0], page_y_z[1]};
    unsigned char *place = (unsigned char *)hl_page_begin(pages, page).first +
                           (at[2] - (page[2] << pages->shift)) * pages->slice_bytes +
                           (at[1] - (page[1] << pages->shift)) * pages->row_bytes + (from - begin) * bytes;
    memcpy(place, values + (from - at[0]) * bytes, (to - from) * bytes);
  }
}

static void store_in_row(hl_pages *pages, const size_t at[3], size_t count, const unsigned char *values) {
  size_t last_y, last_z, first_y = first_page(pages, 1, at[1], &last_y),
                         first_z = first_page(pages, 2, at[2], &last_z);
  for (size_t z = first_z; z <= last_z; z++)
    for (size_t y = first_y; y <= last_y; y++)
      store_in_pages(pages, (const size_t[2]){y, z}, at, count, values);
}

/* ---- whole rows and slices ---- */

enum {
  PAGE_SIDE = (1 << PAGE_SHIFT) + PAGE_OVERLAP,
  PAGE_SLICE_BYTES = PAGE_SIDE * PAGE_SIDE * 4,
  SLICES_AT_ONCE = 8 /* number of slices that are written to a page at once */
};

/* A block of voxels to write: rows j0 to j1 - 1 of slices k0 to k1 - 1. A block of several slices must have
 * all rows of each slice. */
typedef struct row_block {
  size_t j0, j1, k0, k1;
  const unsigned char *values; /* [k1 - k0][j1 - j0][dimension[0]]; stored values */
} row_block;

static bool all_zero(const unsigned char *bytes, size_t count) {
  return bytes[0] == 0 && memcmp(bytes, bytes + 1, count - 1) == 0;
}

/* The part of a block that lies in a page. */
typedef struct page_part {
  size_t x, y, z, number; /* coordinates of the page's first voxel; number of the page */
  size_t j0, j1, k0, k1;
} page_part;

static page_part part_in(const hl_pages *pages, const size_t page[3], const row_block *block) {
  const size_t end_y = (page[1] << pages->shift) + pages->slice_bytes / pages->row_bytes,
               end_z = (page[2] << pages->shift) + ((size_t)1 << pages->shift) + PAGE_OVERLAP;
  page_part p = {.x = page[0] << pages->shift, .y = page[1] << pages->shift, .z = page[2] << pages->shift};
  p.number = (page[2] * pages->count[1] + page[1]) * pages->count[0] + page[0];
  p.j0 = block->j0 > p.y ? block->j0 : p.y, p.j1 = block->j1 < end_y ? block->j1 : end_y;
  p.k0 = block->k0 > p.z ? block->k0 : p.z, p.k1 = block->k1 < end_z ? block->k1 : end_z;
  return p;
}

/* Writes slices k0 to k1 - 1 of a page's part of a block. In the page, the slices of a page's part of a block
 * are a single run of bytes. Slices of zeros are not written, because parts of the sparse file that were not
 * written are zeros. Returns false if the system has refused the write. */
static bool write_part(const hl_pages *pages, const page_part *p, size_t k0, size_t k1,
                       const row_block *block) {
  unsigned char part[SLICES_AT_ONCE * PAGE_SLICE_BYTES], *to = part;
  const size_t bytes = hl_storage_bytes(pages->storage), side = pages->row_bytes / bytes,
               nx = pages->dimension[0], width = nx - p->x < side ? nx - p->x : side;
  for (size_t k = k0; k < k1; k++) {
    if (k > k0) { /* a page at the end of the grid may have fewer rows than its memory has room for */
      size_t unused = pages->slice_bytes - (p->j1 - p->j0) * pages->row_bytes;
      memset(to, 0, unused);
      to += unused;
    }
    for (size_t j = p->j0; j < p->j1; j++, to += pages->row_bytes) {
      size_t row = (k - block->k0) * (block->j1 - block->j0) + (j - block->j0);
      memcpy(to, block->values + (row * nx + p->x) * bytes, width * bytes);
      memset(to + width * bytes, 0, (side - width) * bytes);
    }
  }
  size_t place = (size_t)(pages->first - pages->mapping) + p->number * pages->page_bytes +
                 (k0 - p->z) * pages->slice_bytes + (p->j0 - p->y) * pages->row_bytes;
  return all_zero(part, (size_t)(to - part)) ||
         hl_scratch_write(pages->file, part, (size_t)(to - part), (off_t)place);
}

static bool write_in_page(const hl_pages *pages, const size_t page[3], const row_block *block) {
  const page_part p = part_in(pages, page, block);
  for (size_t k = p.k0, end; k < p.k1; k = end) {
    end = p.k1 - k < SLICES_AT_ONCE ? p.k1 : k + SLICES_AT_ONCE;
    if (!write_part(pages, &p, k, end, block)) return false;
  }
  return true;
}

static bool write_block(const hl_pages *pages, const row_block *block) {
  size_t last_y, last_z, ignored, first_y = first_page(pages, 1, block->j0, &ignored),
                                  first_z = first_page(pages, 2, block->k0, &ignored);
  first_page(pages, 1, block->j1 - 1, &last_y);
  first_page(pages, 2, block->k1 - 1, &last_z);
  for (size_t z = first_z; z <= last_z; z++)
    for (size_t y = first_y; y <= last_y; y++)
      for (size_t x = 0; x < pages->count[0]; x++)
        if (!write_in_page(pages, (const size_t[3]){x, y, z}, block)) return false;
  return true;
}

/* Writes the first of `count` voxels, which begin with number `first`. If the voxels begin at the start of a
 * slice and contain at least one whole slice, all whole slices are written. In all other cases the whole rows
 * in the first slice are written. Returns the number of voxels that were written, which may be 0. */
static size_t write_rows(hl_pages *pages, size_t first, size_t count, const unsigned char *values) {
  const size_t *n = pages->dimension;
  size_t row = first / n[0], j = row % n[1], k = row / n[1], rows = count / n[0];
  if (first % n[0] != 0 || rows == 0 || pages->slice_bytes > PAGE_SLICE_BYTES) return 0;
  row_block block = {j, j + rows < n[1] ? j + rows : n[1], k, k + 1, values};
  if (j == 0 && rows >= n[1]) block.k1 = k + rows / n[1];
  if (!write_block(pages, &block)) return 0;
  if (pages->bricks != NULL && block.j1 - block.j0 == n[1])
    hl_brick_bounds_add(pages->bricks, block.k0, block.k1, values);
  return (block.k1 - block.k0) * (block.j1 - block.j0) * n[0];
}

void hl_pages_store(hl_pages *pages, size_t first, size_t count, const void *values) {
  const size_t *n = pages->dimension, bytes = hl_storage_bytes(pages->storage);
  pthread_mutex_lock(&pages->lock);
  if (pages->counts != NULL) hl_values_count(pages->storage, values, count, pages->counts);
  pages->counted += count;
  pthread_mutex_unlock(&pages->lock);
  if (pages->glimpse != NULL) hl_glimpse_store(pages->glimpse, first, count, values);
  for (size_t done = 0, taken; done < count; done += taken) {
    const unsigned char *from = (const unsigned char *)values + done * bytes;
    size_t row = (first + done) / n[0], i = (first + done) % n[0];
    taken = write_rows(pages, first + done, count - done, from);
    if (taken > 0) continue;
    taken = n[0] - i < count - done ? n[0] - i : count - done;
    store_in_row(pages, (const size_t[3]){i, row % n[1], row / n[1]}, taken, from);
  }
}

/* ---- sparse pages ---- */

/* Returns whether all values equal the value of voxels of sparse pages that were not stored. */
static bool all_unstored(const hl_pages *pages, const unsigned char *values, size_t count) {
  const size_t bytes = hl_storage_bytes(pages->storage);
  return memcmp(values, pages->value, bytes) == 0 && memcmp(values, values + bytes, (count - 1) * bytes) == 0;
}

/* Stores the part of a box that lies in one page. */
static void store_box_in_page(hl_pages *pages, const size_t page[3], const size_t begin[3],
                              const size_t count[3], const unsigned char *values) {
  const size_t bytes = hl_storage_bytes(pages->storage), side = ((size_t)1 << pages->shift) + PAGE_OVERLAP,
               number = (page[2] * pages->count[1] + page[1]) * pages->count[0] + page[0];
  size_t from[3], to[3];
  for (int a = 0; a < 3; a++) {
    const size_t first = page[a] << pages->shift, end = begin[a] + count[a];
    from[a] = begin[a] > first ? begin[a] : first;
    to[a] = end < first + side ? end : first + side;
  }
  hl_pages_own(pages, number);
  unsigned char *place = hl_page_first(pages, number) + (from[0] - (page[0] << pages->shift)) * bytes;
  for (size_t k = from[2]; k < to[2]; k++)
    for (size_t j = from[1]; j < to[1]; j++)
      memcpy(place + (k - (page[2] << pages->shift)) * pages->slice_bytes +
                 (j - (page[1] << pages->shift)) * pages->row_bytes,
             values + (((k - begin[2]) * count[1] + j - begin[1]) * count[0] + from[0] - begin[0]) * bytes,
             (to[0] - from[0]) * bytes);
}

void hl_pages_store_box(hl_pages *pages, const size_t begin[3], const size_t count[3], const void *values) {
  size_t first[3], last[3], ignored;
  if (all_unstored(pages, values, count[0] * count[1] * count[2])) return;
  for (int a = 0; a < 3; a++) {
    first[a] = first_page(pages, a, begin[a], &ignored);
    first_page(pages, a, begin[a] + count[a] - 1, &last[a]);
  }
  for (size_t z = first[2]; z <= last[2]; z++)
    for (size_t y = first[1]; y <= last[1]; y++)
      for (size_t x = first[0]; x <= last[0]; x++)
        store_box_in_page(pages, (const size_t[3]){x, y, z}, begin, count, values);
}

bool hl_pages_have_one_value(const hl_pages *pages, size_t first, size_t count) {
  if (!hl_pages_are_sparse(pages)) return false;
  const size_t width = pages->dimension[0], rows = pages->dimension[1], end = (first + count - 1) / width + 1;
  for (size_t row = first / width, next; row < end; row = next) {
    /* the next row that lies in other pages: the first row of the next page along y, or of the next slice */
    const size_t y = hl_page_of(pages, 1, row % rows), z = hl_page_of(pages, 2, row / rows);
    const size_t after = y + 1 < pages->count[1] ? (y + 1) << pages->shift : rows;
    const uint32_t *place = pages->place + (z * pages->count[1] + y) * pages->count[0];
    for (size_t x = 0; x < pages->count[0]; x++)
      if (place[x] != 0) return false;
    next = row + (after - row % rows);
  }
  return true;
}
