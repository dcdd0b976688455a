/* platform/wasi/allocator.c - defines the C library's allocator for several threads, because ziglang's own
 * one serves only one thread. The definitions of this file replace those of ziglang's C library, which are
 * weak ones, also for calls from within that library.
 *
 * Memory is dealt out in slots, whose sizes are powers of two. A released slot is kept for later blocks of
 * the same class of sizes. Slots that are smaller than a page of WebAssembly's memory (64 KiB) divide a page
 * among themselves, and larger ones are runs of pages. Memory never goes back to the system, because
 * WebAssembly's memory does not shrink. */
#define _GNU_SOURCE /* posix_memalign */
#include <errno.h>
#include <pthread.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* A slot of class c has 1 << c bytes. */
enum { LEAST_CLASS = 5, PAGE_CLASS = 16, MOST_CLASS = 31, LEAST_ALIGNMENT = 16 };

static const size_t PAGE_MASK = ((size_t)1 << PAGE_CLASS) - 1;

/* Lies before each block. The slot begins at least LEAST_ALIGNMENT bytes before the block. */
typedef struct block_head {
  unsigned char *slot;
  int class;
} block_head;

typedef struct free_slot {
  struct free_slot *next;
} free_slot;

static pthread_mutex_t mutex; /* 0, which is an open one (threads.c) */
static free_slot *released[MOST_CLASS + 1];
/* For each class below PAGE_CLASS, the first slot of its last page that was never used. There is no such slot
 * if this is the beginning of a page. */
static unsigned char *unused[PAGE_CLASS];

static unsigned char *take_released(int class) {
  free_slot *slot = released[class];
  if (slot != NULL) released[class] = slot->next;
  return (unsigned char *)slot;
}

static unsigned char *take_pages(int class) {
  unsigned char *pages = take_released(class);
  if (pages != NULL) return pages;
  size_t first = __builtin_wasm_memory_grow(0, (size_t)1 << (class - PAGE_CLASS));
  return first == SIZE_MAX ? NULL : (unsigned char *)(first << PAGE_CLASS);
}

static unsigned char *take_slot(int class) {
  if (class >= PAGE_CLASS) return take_pages(class);
  unsigned char *slot = take_released(class);
  if (slot != NULL) return slot;
  slot = unused[class];
  if (((size_t)slot & PAGE_MASK) == 0) slot = take_pages(PAGE_CLASS);
  if (slot != NULL) unused[class] = slot + ((size_t)1 << class);
  return slot;
}

/* Returns the class of the smallest slots for so many bytes, or a class above MOST_CLASS. */
static int class_of(size_t bytes) {
  int class = LEAST_CLASS;
  while (class <= MOST_CLASS && (size_t)1 << class < bytes) class ++;
  return class;
}

/* Slots of more bytes than the alignment begin at a multiple of the alignment, or of a page if the alignment
 * is greater. Therefore a slot that begins at `slot` has room for the head before `slot + alignment` rounded
 * downwards. */
static void *allocate(size_t bytes, size_t alignment) {
  if (alignment < LEAST_ALIGNMENT) alignment = LEAST_ALIGNMENT;
  size_t whole;
  int class = __builtin_add_overflow(bytes, alignment, &whole) ? MOST_CLASS + 1 : class_of(whole);
  if (class > MOST_CLASS) return NULL;
  pthread_mutex_lock(&mutex);
  unsigned char *slot = take_slot(class);
  pthread_mutex_unlock(&mutex);
  if (slot == NULL) return NULL;
  unsigned char *block = slot + alignment - ((size_t)slot & (alignment - 1));
  ((block_head *)block)[-1] = (block_head){slot, class};
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
  free_slot *slot = (free_slot *)head.slot;
  pthread_mutex_lock(&mutex);
  slot->next = released[head.class];
  released[head.class] = slot;
  pthread_mutex_unlock(&mutex);
}

void free(void *block) {
  if (block != NULL) release(block);
}

void *realloc(void *block, size_t bytes) {
  if (block == NULL) return malloc(bytes);
  const block_head head = ((block_head *)block)[-1];
  size_t before = (size_t)((unsigned char *)block - head.slot), whole;
  if (!__builtin_add_overflow(bytes, before, &whole) && class_of(whole) == head.class) return block;
  void *moved = allocate(bytes, LEAST_ALIGNMENT);
  if (moved == NULL) return or_no_memory(NULL);
  size_t held = ((size_t)1 << head.class) - before;
  memcpy(moved, block, held < bytes ? held : bytes);
  release(block);
  return moved;
}
