/* particles/block_table.h - gives numbers to the blocks of a lattice that are needed.
 *
 * A block is known by its coordinates. The table numbers blocks in the order in which they are added, and
 * finds the number of a block by a hash of its coordinates. */
#ifndef HL_PARTICLES_BLOCK_TABLE_H
#define HL_PARTICLES_BLOCK_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/error.h"

typedef struct hl_block_table {
  size_t count;        /* number of blocks */
  int32_t (*place)[3]; /* owned; [count]; coordinates x, y, z of each block, by its number */
  size_t room;         /* number of blocks for which `place` has room */
  uint32_t *entries;   /* owned; [size]; a block's number plus 1; 0 if the entry is free */
  size_t size;         /* a power of two, or 0 */
} hl_block_table;

/* The number of a block; -1 where the table does not have it. */
ptrdiff_t hl_block_number(const hl_block_table *table, const int32_t place[3]);

/* Adds a block unless the table has it. *number may be null. Fails where there is no memory. subject: starts
 * the error line. */
hl_status hl_block_add(hl_context *context, hl_block_table *table, const int32_t place[3],
                       const char *subject, size_t *number, hl_error *error);

void hl_block_table_release(hl_context *context, hl_block_table *table);

#endif
