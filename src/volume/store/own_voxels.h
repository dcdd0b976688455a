/* volume/store/own_voxels.h - describes the block that this rank holds of a volume that several ranks share.
 *
 * In: voxels in the caller's memory, of any type and strides, borrowed; or a block of slices that a reader
 * fills with stored values. Out: stored values, packed, of any box of the block. */
#ifndef HL_VOLUME_OWN_VOXELS_H
#define HL_VOLUME_OWN_VOXELS_H

#include "ranks/blocks.h"
#include "volume/convert.h"

typedef struct hl_own_voxels {
  hl_context *context;
  hl_box box;           /* the box, in the whole volume, of the voxels that this rank holds */
  hl_voxel_type type;   /* type of the voxels in memory; equal to `stored` unless the voxels are a caller's
                         * voxels of another type */
  hl_voxel_type stored; /* type of the stored values: U8, U16 or F32 */
  size_t stored_bytes;  /* bytes of a stored value */
  const unsigned char *first;
  ptrdiff_t stride[3];   /* distances between neighbouring voxels along each axis, in bytes */
  unsigned char *slices; /* owned; [count[2]][count[1]][count[0]]; the block to which `first` points; null if
                          * `first` is borrowed */
  void *exact; /* owned; [count[2]][count[1]][count[0]]; the file's own numbers, if `slices` rounds any of
                * them (volume/exact.h); else null */
  void *row;   /* owned; memory for a row of voxels of `type`, if the voxels of a row are not adjacent; else
                * null. Used only with row_lock held */
  pthread_mutex_t row_lock;
} hl_own_voxels;

/* Allocates memory for this rank's share of the slices, which the caller fills. *own is owned by the
 * caller. */
hl_status hl_own_voxels_allocate(hl_ranks *ranks, const hl_volume_description *whole, hl_own_voxels **own,
                                 hl_error *error);

/* Borrows the caller's voxels of a block. hl_blocks_share() must have accepted the block. */
hl_status hl_own_voxels_borrow(hl_ranks *ranks, const hl_volume_description *whole, const hl_block *block,
                               hl_own_voxels **own, hl_error *error);

/* Allocates a block of floats for the same voxels of the volume as another block. The caller fills `slices`.
 * *own is owned by the caller. */
hl_status hl_own_voxels_like(hl_ranks *ranks, const hl_own_voxels *other, hl_own_voxels **own,
                             hl_error *error);

void hl_own_voxels_release(hl_own_voxels *own); /* null is allowed */

/* Copies the stored values of a box of voxels, packed, to `to`. The function is the hl_block_copier of an
 * hl_own_voxels. */
void hl_own_voxels_copy(const void *own, const hl_box *box, unsigned char *to);

/* Copies `count` stored values of a block, from number `first` on. Voxels are numbered within the block. */
void hl_own_voxels_run(const hl_own_voxels *own, size_t first, size_t count, unsigned char *to);

static inline size_t hl_own_voxels_count(const hl_own_voxels *own) {
  return own->box.count[0] * own->box.count[1] * own->box.count[2];
}

#endif
