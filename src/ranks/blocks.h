/* ranks/blocks.h - an array of three dimensions of which every rank holds a block, and all can get any part.
 *
 * A rank that needs a part sends requests to the ranks whose blocks hold something of it; a thread of theirs
 * answers with copies, packed. Two-sided messages serve blocks of any layout in their owner's memory, with
 * ghosts and strides; and Open MPI 4.1 answers one-sided ones over TCP only while the owner calls MPI. */
#ifndef HL_RANKS_BLOCKS_H
#define HL_RANKS_BLOCKS_H

#include "ranks/ranks.h"

/* Elements of the array, along i, j, k. */
typedef struct hl_box {
  uint64_t begin[3], count[3];
} hl_box;

/* Copies elements of this rank's block, a box of the whole array, packed. data: of hl_block_source. Called
 * from any thread. */
typedef void hl_block_copier(const void *data, const hl_box *box, unsigned char *to);

typedef struct hl_block_source {
  hl_box box; /* what this rank holds */
  hl_block_copier *copy;
  const void *data; /* borrowed */
} hl_block_source;

typedef struct hl_blocks hl_blocks;

/* What all ranks say alike. */
typedef struct hl_blocks_shape {
  size_t dimension[3];
  size_t element_bytes, most; /* elements that are fetched at once, at most */
} hl_blocks_shape;

/* Collective. *blocks: owned by the caller. The boxes of all ranks must fill the array without overlap. */
hl_status hl_blocks_share(hl_ranks *ranks, const hl_blocks_shape *shape, const hl_block_source *source,
                          hl_blocks **blocks, hl_error *error);

/* together: collective, and waits until no rank needs this rank's block; else where this rank has failed.
 * Null is allowed. */
void hl_blocks_release(hl_blocks *blocks, bool together);

/* Gets elements of a box into an array with these distances of rows and slices. Elements of a row adjoin.
 * Several threads may fetch at once. */
void hl_blocks_fetch(hl_blocks *blocks, const hl_box *box, unsigned char *to, size_t row_bytes,
                     size_t slice_bytes);

/* The elements of two boxes; false where there are none. */
bool hl_boxes_meet(const hl_box *a, const hl_box *b, hl_box *both);

hl_ranks *hl_blocks_ranks(const hl_blocks *blocks);
const hl_block_source *hl_blocks_source(const hl_blocks *blocks);

#endif
