/* volume/brick_bounds.c - see brick_bounds.h. */
#include "volume/brick_bounds.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"

static size_t bricks_of(const hl_brick_bounds *b) { return b->count[0] * b->count[1] * b->count[2]; }

/* The range of voxels along an axis on which a brick depends. */
static void range_of(size_t brick, size_t dimension, size_t *first, size_t *last) {
  *first = brick * BRICK_SIDE < BRICK_BEFORE ? 0 : brick * BRICK_SIDE - BRICK_BEFORE;
  *last = brick * BRICK_SIDE + BRICK_AFTER;
  if (*last >= dimension) *last = dimension - 1;
}

/* ---- for each type of stored values ---- */

#define LESS(a, b)    ((a) < (b) ? (a) : (b))
#define MORE(a, b)    ((a) > (b) ? (a) : (b))
#define PADDED(width) ((width) + BRICK_BEFORE + 3 * BRICK_AFTER)

#define BOUNDS_TYPE       uint8_t
#define BOUNDS_NAME(name) name##_u8
#define BOUNDS_LEAST      0
#define BOUNDS_MOST       UINT8_MAX
#include "volume/brick_bounds_of.h"

#define BOUNDS_TYPE       uint16_t
#define BOUNDS_NAME(name) name##_u16
#define BOUNDS_LEAST      0
#define BOUNDS_MOST       UINT16_MAX
#include "volume/brick_bounds_of.h"

#define BOUNDS_TYPE       float
#define BOUNDS_NAME(name) name##_f32
#define BOUNDS_LEAST      (-INFINITY)
#define BOUNDS_MOST       INFINITY
#include "volume/brick_bounds_of.h"

/* ---- the bounds of all bricks ---- */

bool hl_brick_bounds_create(hl_context *context, const size_t dimension[3], hl_storage storage,
                            hl_brick_bounds **bounds) {
  hl_brick_bounds *made = *bounds = hl_allocate_zeroed(context, 1, sizeof *made);
  if (made == NULL) return false;
  made->context = context;
  made->storage = storage;
  for (int a = 0; a < 3; a++) {
    made->dimension[a] = dimension[a];
    made->count[a] = dimension[a] / BRICK_SIDE + 1;
  }
  pthread_mutex_init(&made->lock, NULL); /* making a mutex without attributes cannot fail */
  made->bounds = hl_allocate(context, bricks_of(made), 2 * hl_storage_bytes(storage));
  if (made->bounds == NULL) {
    hl_brick_bounds_release(made);
    *bounds = NULL;
    return false;
  }
  switch (storage) {
    case HL_STORAGE_U8: begin_u8(made); break;
    case HL_STORAGE_U16: begin_u16(made); break;
    case HL_STORAGE_F32: begin_f32(made); break;
  }
  return true;
}

void hl_brick_bounds_release(hl_brick_bounds *bounds) {
  if (bounds == NULL) return;
  pthread_mutex_destroy(&bounds->lock);
  hl_release(bounds->context, bounds->bounds);
  hl_release(bounds->context, bounds);
}

void hl_brick_bounds_add(hl_brick_bounds *b, size_t k0, size_t k1, const void *values) {
  size_t voxels = b->dimension[0] * b->dimension[1];
  size_t scratch_values = 2 * (PADDED(b->dimension[0]) + b->count[0] * b->count[1]);
  void *scratch = hl_allocate(b->context, scratch_values, hl_storage_bytes(b->storage));
  if (scratch == NULL)
    return; /* without scratch memory the slices are not added to the bounds, and hl_brick_bounds_whole()
             * returns false */
  for (size_t k = k0; k < k1; k++) {
    size_t first = (k - k0) * voxels;
    switch (b->storage) {
      case HL_STORAGE_U8: add_slice_u8(b, k, (const uint8_t *)values + first, scratch); break;
      case HL_STORAGE_U16: add_slice_u16(b, k, (const uint16_t *)values + first, scratch); break;
      case HL_STORAGE_F32: add_slice_f32(b, k, (const float *)values + first, scratch); break;
    }
  }
  hl_release(b->context, scratch);
}

bool hl_brick_bounds_whole(const hl_brick_bounds *bounds) { return bounds->slices == bounds->dimension[2]; }
