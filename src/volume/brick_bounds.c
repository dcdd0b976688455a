/* volume/brick_bounds.c - see brick_bounds.h. Bounds are separable: those of a slice's voxels are found along
 * y, then along x, then they widen the bounds of the bricks that depend on the slice. */
#include "volume/brick_bounds.h"

#include <math.h>
#include <string.h>

#include "core/memory.h"

static size_t bricks_of(const hl_brick_bounds *b) { return b->count[0] * b->count[1] * b->count[2]; }

/* The voxels of an axis that a brick depends on. */
static void range_of(size_t brick, size_t dimension, size_t *first, size_t *last) {
  *first = brick * BRICK_SIDE < BRICK_BEFORE ? 0 : brick * BRICK_SIDE - BRICK_BEFORE;
  *last = brick * BRICK_SIDE + BRICK_AFTER;
  if (*last >= dimension) *last = dimension - 1;
}

/* The functions for a type of stored values.
 *
 * bound_slice: bounds of one slice along y and x. padded: scratch, [2][PADDED(width)]. low, high: [bricks y]
 * [bricks x]. A row of nine neighbours' bounds is found from those of two, four and eight, and each is spread
 * over bricks by BRICK_SIDE.
 * widen: the bounds of a layer of bricks by those of a slice.
 * A comparison with a value that is not a number is false: it widens nothing. */
#define LESS(a, b)    ((a) < (b) ? (a) : (b))
#define MORE(a, b)    ((a) > (b) ? (a) : (b))
#define PADDED(width) ((width) + BRICK_BEFORE + 3 * BRICK_AFTER)

#define DEFINE_BOUNDS(type, name)                                                                      \
  static void reduce_##name(type *restrict row, size_t bricks, size_t padded, bool greatest,           \
                            type *restrict out) {                                                      \
    for (size_t shift = 1; shift <= 4; shift *= 2)                                                     \
      for (size_t i = 0; i + shift < padded; i++)                                                      \
        row[i] = greatest ? MORE(row[i + shift], row[i]) : LESS(row[i + shift], row[i]);               \
    for (size_t b = 0; b < bricks; b++) {                                                              \
      type first = row[BRICK_SIDE * b], second = row[BRICK_SIDE * b + 1];                              \
      out[b] = greatest ? MORE(second, first) : LESS(second, first);                                   \
    }                                                                                                  \
  }                                                                                                    \
  static void bound_slice_##name(const hl_brick_bounds *b, const type *slice, type least, type most,   \
                                 type *padded, type *low, type *high) {                                \
    const size_t width = b->dimension[0], room = PADDED(width);                                        \
    type *restrict rows = padded + BRICK_BEFORE, *restrict tops = padded + room + BRICK_BEFORE;        \
    for (size_t y = 0; y < b->count[1]; y++) {                                                         \
      size_t first, last;                                                                              \
      range_of(y, b->dimension[1], &first, &last);                                                     \
      for (size_t i = 0; i < room; i++) padded[i] = most, padded[room + i] = least;                    \
      for (size_t j = first; j <= last; j++) {                                                         \
        const type *restrict row = slice + j * width;                                                  \
        for (size_t i = 0; i < width; i++) {                                                           \
          rows[i] = LESS(row[i], rows[i]);                                                             \
          tops[i] = MORE(row[i], tops[i]);                                                             \
        }                                                                                              \
      }                                                                                                \
      reduce_##name(padded, b->count[0], room, false, low + y * b->count[0]);                          \
      reduce_##name(padded + room, b->count[0], room, true, high + y * b->count[0]);                   \
    }                                                                                                  \
  }                                                                                                    \
  static void widen_##name(type *restrict bounds, const type *restrict low, const type *restrict high, \
                           size_t bricks) {                                                            \
    for (size_t n = 0; n < bricks; n++) {                                                              \
      bounds[2 * n] = LESS(low[n], bounds[2 * n]);                                                     \
      bounds[2 * n + 1] = MORE(high[n], bounds[2 * n + 1]);                                            \
    }                                                                                                  \
  }                                                                                                    \
  static void begin_##name(const hl_brick_bounds *b, type least, type most) {                          \
    type *bounds = b->bounds;                                                                          \
    for (size_t n = 0; n < bricks_of(b); n++) bounds[2 * n] = most, bounds[2 * n + 1] = least;         \
  }                                                                                                    \
  static void add_slice_##name(hl_brick_bounds *b, size_t k, const type *slice, type least, type most, \
                               type *scratch) {                                                        \
    const size_t plane = b->count[0] * b->count[1];                                                    \
    type *low = scratch + 2 * PADDED(b->dimension[0]), *high = low + plane;                            \
    bound_slice_##name(b, slice, least, most, scratch, low, high);                                     \
    pthread_mutex_lock(&b->lock);                                                                      \
    for (size_t z = k / BRICK_SIDE < 1 ? 0 : k / BRICK_SIDE - 1; z < b->count[2]; z++) {               \
      size_t first, last;                                                                              \
      range_of(z, b->dimension[2], &first, &last);                                                     \
      if (first > k) break;                                                                            \
      if (last >= k) widen_##name((type *)b->bounds + 2 * z * plane, low, high, plane);                \
    }                                                                                                  \
    b->slices++;                                                                                       \
    pthread_mutex_unlock(&b->lock);                                                                    \
  }

DEFINE_BOUNDS(uint8_t, u8)
DEFINE_BOUNDS(uint16_t, u16)
DEFINE_BOUNDS(float, f32)

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
  pthread_mutex_init(&made->lock, NULL); /* cannot fail: it has no attributes */
  made->bounds = hl_allocate(context, bricks_of(made), 2 * hl_storage_bytes(storage));
  if (made->bounds == NULL) {
    hl_brick_bounds_release(made);
    *bounds = NULL;
    return false;
  }
  switch (storage) {
    case HL_STORAGE_U8: begin_u8(made, 0, UINT8_MAX); break;
    case HL_STORAGE_U16: begin_u16(made, 0, UINT16_MAX); break;
    case HL_STORAGE_F32: begin_f32(made, -INFINITY, INFINITY); break;
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
  if (scratch == NULL) return; /* hl_brick_bounds_whole() tells */
  for (size_t k = k0; k < k1; k++) {
    size_t first = (k - k0) * voxels;
    switch (b->storage) {
      case HL_STORAGE_U8: add_slice_u8(b, k, (const uint8_t *)values + first, 0, UINT8_MAX, scratch); break;
      case HL_STORAGE_U16:
        add_slice_u16(b, k, (const uint16_t *)values + first, 0, UINT16_MAX, scratch);
        break;
      case HL_STORAGE_F32:
        add_slice_f32(b, k, (const float *)values + first, -INFINITY, INFINITY, scratch);
        break;
    }
  }
  hl_release(b->context, scratch);
}

bool hl_brick_bounds_whole(const hl_brick_bounds *bounds) { return bounds->slices == bounds->dimension[2]; }
