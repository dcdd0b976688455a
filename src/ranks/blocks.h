/* ranks/blocks.h - describes an array of three dimensions shared by all ranks: every rank holds one block,
 * and any rank can fetch any part.
 *
 * A rank that needs a part sends requests to the ranks whose blocks overlap the part. In each of these ranks
 * a thread answers with packed copies. The messages are two-sided, because blocks may have any layout in
 * their owner's memory, with ghosts and strides. One-sided messages would not work: over TCP, Open MPI 4.1
 * answers one-sided messages only while the owner calls MPI. */
#ifndef HL_RANKS_BLOCKS_H
#define HL_RANKS_BLOCKS_H

#include "ranks/ranks.h"

/* A box of elements of the array, along i, j and k. */
typedef struct hl_box {
  uint64_t begin[3], count[3];
} hl_box;

/* Copies a part of this rank's block to packed memory. The box is given in indices of the whole array. data:
 * the member of hl_block_source. Called from any thread. */
typedef void hl_block_copier(const void *data, const hl_box *box, unsigned char *to);

typedef struct hl_block_source {
  hl_box box; /* the elements that this rank holds */
  hl_block_copier *copy;
  const void *data; /* borrowed */
} hl_block_source;

typedef struct hl_blocks hl_blocks;

/* The properties of an array. All ranks must give the same properties. */
typedef struct hl_blocks_shape {
  size_t dimension[3];
  size_t element_bytes, most; /* element_bytes: bytes of an element; most: the greatest number of elements
                               * that one call fetches */
} hl_blocks_shape;

/* Makes an array of this rank's block and the other ranks' blocks. Collective: all ranks call it. The boxes
 * of all ranks must fill the array without overlap. *blocks is owned by the caller. */
hl_status hl_blocks_share(hl_ranks *ranks, const hl_blocks_shape *shape, const hl_block_source *source,
                          hl_blocks **blocks, hl_error *error);

/* Releases the array. together: the call is collective, and waits until no other rank needs this rank's
 * block. Pass false only if this rank has failed. blocks may be null. */
void hl_blocks_release(hl_blocks *blocks, bool together);

/* Fetches the elements of a box into an array with the given distances between rows and between slices.
 * Elements of a row are adjacent. Several threads may fetch at once. */
void hl_blocks_fetch(hl_blocks *blocks, const hl_box *box, unsigned char *to, size_t row_bytes,
                     size_t slice_bytes);

/* Sets *both to the elements that lie in both boxes. Returns false if the boxes do not overlap. */
bool hl_boxes_meet(const hl_box *a, const hl_box *b, hl_box *both);

hl_ranks *hl_blocks_ranks(const hl_blocks *blocks);
const hl_block_source *hl_blocks_source(const hl_blocks *blocks);

#endif
