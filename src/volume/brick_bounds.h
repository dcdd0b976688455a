/* volume/brick_bounds.h - the least and greatest stored value of what each brick of a volume depends on,
 * found while a volume larger than memory is stored: else it would be read once more. */
#ifndef HL_VOLUME_BRICK_BOUNDS_H
#define HL_VOLUME_BRICK_BOUNDS_H

#include <pthread.h>

#include "volume/volume.h"

/* Along an axis, brick b depends on voxels 4b-3 .. 4b+5. */
enum { BRICK_SIDE = 4, BRICK_BEFORE = 3, BRICK_AFTER = 5 };

typedef struct hl_brick_bounds {
  hl_context *context;
  hl_storage storage;
  size_t dimension[3], count[3]; /* voxels; bricks: dimension / BRICK_SIDE + 1 */
  void *bounds;                  /* owned; [count[2]][count[1]][count[0]][2]; least, greatest; as stored */
  size_t slices;                 /* of voxels, added so far */
  pthread_mutex_t lock;          /* held while bounds change */
} hl_brick_bounds;

/* *bounds: owned by the caller. False: out of memory. */
bool hl_brick_bounds_create(hl_context *context, const size_t dimension[3], hl_storage storage,
                            hl_brick_bounds **bounds);
void hl_brick_bounds_release(hl_brick_bounds *bounds); /* null is allowed */

/* Adds slices k0 to k1 - 1, each once at most, several threads at once. values: [k1 - k0][dimension[1]]
 * [dimension[0]]; stored. Out of memory, adds nothing. */
void hl_brick_bounds_add(hl_brick_bounds *bounds, size_t k0, size_t k1, const void *values);

/* Whether all slices were added. */
bool hl_brick_bounds_whole(const hl_brick_bounds *bounds);

#endif
