/* volume/brick_bounds.h - bounds of bricks: the least and greatest stored value of the voxels on which each
 * brick of a volume depends. Bounds of a volume larger than memory are found while the volume is stored,
 * because otherwise the whole volume would have to be read a second time. */
#ifndef HL_VOLUME_BRICK_BOUNDS_H
#define HL_VOLUME_BRICK_BOUNDS_H

#include <pthread.h>

#include "volume/volume.h"

/* Along an axis, brick b depends on voxels 4b-3 .. 4b+5. */
enum { BRICK_SIDE = 4, BRICK_BEFORE = 3, BRICK_AFTER = 5 };

typedef struct hl_brick_bounds {
  hl_context *context;
  hl_storage storage;
  size_t dimension[3], count[3]; /* number of voxels along each axis; number of bricks along each axis,
                                  * dimension / BRICK_SIDE + 1 */
  void *bounds;                  /* owned; [count[2]][count[1]][count[0]][2]; least and greatest stored value
                                  * of each brick */
  size_t slices;                 /* number of slices of voxels added so far */
  pthread_mutex_t lock;          /* held while bounds change */
} hl_brick_bounds;

/* Makes bounds to which no slice has been added yet. *bounds is owned by the caller. Returns false if memory
 * is short. */
bool hl_brick_bounds_create(hl_context *context, const size_t dimension[3], hl_storage storage,
                            hl_brick_bounds **bounds);
void hl_brick_bounds_release(hl_brick_bounds *bounds); /* null is allowed */

/* Adds slices k0 to k1 - 1. Each slice may be added only once; several threads may add slices at the same
 * time. values: stored values, [k1 - k0][dimension[1]][dimension[0]]. If memory is short, nothing is
 * added. */
void hl_brick_bounds_add(hl_brick_bounds *bounds, size_t k0, size_t k1, const void *values);

/* Returns whether all slices were added. */
bool hl_brick_bounds_whole(const hl_brick_bounds *bounds);

#endif
