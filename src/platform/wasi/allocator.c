/* platform/wasi/allocator.c - defines the C library's allocator for several threads, because ziglang's own
 * allocator serves only one thread. The definitions of this file replace the weak definitions in ziglang's C
 * library, also for calls from within that library.
 *
 * The allocator gives out memory in slots. Slots that are smaller than a page of WebAssembly's memory (64
 * KiB) have sizes that are powers of two, and divide a page among themselves. A released small slot is kept
 * for later blocks of the same class of sizes. A larger slot is a run of adjacent pages. A released run is
 * joined with adjacent free runs. Later slots of any number of pages are taken from free runs. Memory is
 * never returned to the system, because WebAssembly's memory does not shrink. */
#define _GNU_SOURCE /* posix_memalign */
#include <errno.h>
#include <pthread.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A slot of class c has 1 << c bytes. */
enum { LEAST_CLASS = 5, PAGE_CLASS = 16, LEAST_ALIGNMENT = 16 };

static const size_t PAGE_BYTES = (size_t)1 << PAGE_CLASS, PAGE_MASK = ((size_t)1 << PAGE_CLASS) - 1;

/* The head of a block lies directly before the block. The block's slot begins at least LEAST_ALIGNMENT bytes
 * before the block. */
typedef struct block_head {
  unsigned char *slot;
  size_t bytes; /* number of bytes of the slot: a power of two below PAGE_BYTES, or a multiple of
                 * PAGE_BYTES */
} block_head;

typedef struct free_slot {
  struct free_slot *next;
} free_slot;

/* Describes a run of free pages. The description is stored at the beginning of the first page. */
typedef struct free_run {
  struct free_run *next; /* the next free run in memory; runs that touch are joined */
  size_t bytes;
} free_run;

static pthread_mutex_t mutex; /* an open mutex, whose value is 0 (threads.c) */
static free_slot *released[PAGE_CLASS];
/* For each class, the first slot in the class's last page that was never used. If the address is the
 * beginning of a page, the class has no unused slot. */
static unsigned char *unused[PAGE_CLASS];
static free_run *runs; /* the first free run in memory */

/* Adds pages to the free runs. */
static void release_pages(unsigned char *pages, size_t bytes) {
  free_run *before = NULL, *after = runs, *run = (free_run *)pages;
  for (; after != NULL && (unsigned char *)after < pages; after = after->next) before = after;
  *run = (free_run){after, bytes};
  if (after != NULL && pages + bytes == (unsigned char *)after)
    *run = (free_run){after->next, bytes + after->bytes};
  if (before == NULL) {
    runs = run;
  } else if ((unsigned char *)before + before->bytes == pages) {
    *before = (free_run){run->next, before->bytes + run->bytes};
  } else {
    before->next = run;
  }
}

/* Returns the link to the smallest free run of at least `bytes` bytes; null if no free run is large
 * enough. */
static free_run **smallest_run(size_t bytes) {
  free_run **best = NULL;
  for (free_run **link = &runs; *link != NULL; link = &(*link)->next)
    if ((*link)->bytes >= bytes && (best == NULL || (*link)->bytes < (*best)->bytes)) best = link;
  return best;
}

/* Returns the number of bytes of the free run at the end of memory. */
static size_t free_at_end(void) {
  free_run *last = runs;
  while (last != NULL && last->next != NULL) last = last->next;
  const size_t end = __builtin_wasm_memory_size(0);
  return last != NULL && ((size_t)last + last->bytes) >> PAGE_CLASS == end ? last->bytes : 0;
}

/* Takes a run of pages of `bytes` bytes from the free runs or from the system. bytes: a multiple of
 * PAGE_BYTES. */
static unsigned char *take_pages(size_t bytes) {
  free_run **link = smallest_run(bytes);
  if (link == NULL) {
    const size_t more = bytes - free_at_end(), first = __builtin_wasm_memory_grow(0, more >> PAGE_CLASS);
    if (first == SIZE_MAX) return NULL;
    release_pages((unsigned char *)(first << PAGE_CLASS), more);
    link = smallest_run(bytes);
  }
  free_run *run = *link;
  if (run->bytes > bytes) {
    free_run *rest = (free_run *)((unsigned char *)run + bytes);
    *rest = (free_run){run->next, run->bytes - bytes};
    *link = rest;
  } else {
    *link = run->next;
  }
  return (unsigned char *)run;
}

/* Returns the class of the smallest slots with at least `bytes` bytes. */
static int class_of(size_t bytes) {
  int class = LEAST_CLASS;
  while ((size_t)1 << class < bytes) class ++;
  return class;
}

/* Returns the size in bytes of the smallest slot with at least `bytes` bytes; 0 if no slot can be large
 * enough. */
static size_t slot_bytes(size_t bytes) {
  if (bytes > PTRDIFF_MAX - PAGE_BYTES) return 0;
  return bytes > PAGE_BYTES / 2 ? (bytes + PAGE_MASK) & ~PAGE_MASK : (size_t)1 << class_of(bytes);
}

static unsigned char *take_slot(size_t bytes) {
  if (bytes >= PAGE_BYTES) return take_pages(bytes);
  const int class = class_of(bytes);
  free_slot *slot = released[class];
  if (slot != NULL) {
    released[class] = slot->next;
    return (unsigned char *)slot;
  }
  unsigned char *place = unused[class];
  if (((size_t)place & PAGE_MASK) == 0) place = take_pages(PAGE_BYTES);
  if (place != NULL) unused[class] = place + bytes;
  return place;
}

/* Slots of more bytes than the alignment begin at a multiple of the alignment, or of a page if the alignment
 * is greater. Therefore a slot that begins at `slot` has room for the head before `slot + alignment` rounded
 * downwards. */
static void *allocate(size_t bytes, size_t alignment) {
  if (alignment < LEAST_ALIGNMENT) alignment = LEAST_ALIGNMENT;
  size_t whole, taken = __builtin_add_overflow(bytes, alignment, &whole) ? 0 : slot_bytes(whole);
  if (taken == 0) return NULL;
  pthread_mutex_lock(&mutex);
  unsigned char *slot = take_slot(taken);
  pthread_mutex_unlock(&mutex);
  if (slot == NULL) return NULL;
  unsigned char *block = slot + alignment - ((size_t)slot & (alignment - 1));
  ((block_head *)block)[-1] = (block_head){slot, taken};
  return block;
}

static void *or_no_memory(void *block) {
  if (block == NULL) errno = ENOMEM;
  return block;
}

void *malloc(size_t bytes) { return or_no_memory(allocate(bytes, LEAST_ALIGNMENT)); }

void *aligned_alloc(size_t alignment, size_t bytes) { return or_no_memory(allocate(bytes, alignment)); }

int posix_memalign(void **memory, size_t alignment, size_t bytes) {
  void *block = allocate(bytes, alignment);
  if (block == NULL) return ENOMEM;
  *memory = block;
  return 0;
}

void *calloc(size_t count, size_t size) {
  size_t bytes;
  void *block = __builtin_mul_overflow(count, size, &bytes) ? NULL : allocate(bytes, LEAST_ALIGNMENT);
  if (block != NULL) memset(block, 0, bytes);
  return or_no_memory(block);
}

static void release(void *block) {
  const block_head head = ((block_head *)block)[-1];
  pthread_mutex_lock(&mutex);
  if (head.bytes >= PAGE_BYTES) {
    release_pages(head.slot, head.bytes);
  } else {
    free_slot *slot = (free_slot *)head.slot;
    const int class = class_of(head.bytes);
    *slot = (free_slot){released[class]};
    released[class] = slot;
  }
  pthread_mutex_unlock(&mutex);
}

void free(void *block) {
  if (block != NULL) release(block);
}

void *realloc(void *block, size_t bytes) {
  if (block == NULL) return malloc(bytes);
  const block_head head = ((block_head *)block)[-1];
  size_t before = (size_t)((unsigned char *)block - head.slot), whole;
  if (!__builtin_add_overflow(bytes, before, &whole) && slot_bytes(whole) == head.bytes) return block;
  void *moved = allocate(bytes, LEAST_ALIGNMENT);
  if (moved == NULL) return or_no_memory(NULL);
  size_t held = head.bytes - before;
  memcpy(moved, block, held < bytes ? held : bytes);
  release(block);
  return moved;
}
