/* platform/memory.h - finds the size of the machine's memory, and allocates memory at aligned addresses. */
#ifndef HL_PLATFORM_MEMORY_H
#define HL_PLATFORM_MEMORY_H

#include <stddef.h>
#include <stdint.h>

/* The number of bytes of the machine's memory; 0 if the number is unknown. */
uint64_t hl_machine_memory(void);

/* Allocates memory whose address is a multiple of the alignment. bytes: a multiple of the alignment, which
 * is a power of two. Returns null if memory is short. */
void *hl_aligned_allocate(size_t bytes, size_t alignment);
void hl_aligned_release(void *memory);

#endif
