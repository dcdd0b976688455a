/* surface/cluster_order.c - orders the primitives of a mesh (cluster_order.h) by Morton codes (Morton 1966),
 * which follow a space-filling curve. The codes are made from the first corners of triangles and from the
 * centres of spheres. Primitives with the same code keep their order. */
#include "surface/cluster_order.h"

#include <string.h>

#include "surface/primitive.h"

enum { A_TASK = 1 << 15, CODE_BITS = 10, DIGITS = 3, DIGIT = 1 << CODE_BITS };

/* Primitives that are being ordered. */
typedef struct ordering {
  surfaces *all;
  uint32_t first, count;
  uint32_t *codes; /* [count]; the Morton codes of the primitives */
  float low[3], scale;
} ordering;

static const float *place_of(const surfaces *all, uint32_t primitive) {
  return hl_primitive_kind(all, primitive)->point(all, primitive);
}

/* Spreads the lowest ten bits of a number: after each bit two zeros are inserted. */
static uint32_t spread(uint32_t bits) {
  bits = (bits | bits << 16) & 0x030000ffu;
  bits = (bits | bits << 8) & 0x0300f00fu;
  bits = (bits | bits << 4) & 0x030c30c3u;
  return (bits | bits << 2) & 0x09249249u;
}

static uint32_t code_of(const ordering *ordering, const float *place) {
  uint32_t code = 0;
  for (int axis = 0; axis < 3; axis++) {
    /* a coordinate that is NaN counts as 0 */
    float at = (place[axis] - ordering->low[axis]) * ordering->scale;
    uint32_t cell = at > 0 ? at < DIGIT - 1 ? (uint32_t)at : DIGIT - 1 : 0;
    code |= spread(cell) << axis;
  }
  return code;
}

static void code_task(void *data, size_t task, int worker) {
  (void)worker;
  const ordering *ordering = data;
  size_t end = (task + 1) * A_TASK < ordering->count ? (task + 1) * A_TASK : ordering->count;
  for (size_t i = task * A_TASK; i < end; i++)
    ordering->codes[i] = code_of(ordering, place_of(ordering->all, ordering->first + (uint32_t)i));
}

/* Finds a cube around the points from which the primitives' Morton codes are made. */
static void find_cube(ordering *ordering) {
  float high[3], size = 0;
  for (int axis = 0; axis < 3; axis++) ordering->low[axis] = INFINITY, high[axis] = -INFINITY;
  for (uint32_t p = ordering->first; p < ordering->first + ordering->count; p++) {
    const float *place = place_of(ordering->all, p);
    for (int axis = 0; axis < 3; axis++) {
      ordering->low[axis] = place[axis] < ordering->low[axis] ? place[axis] : ordering->low[axis];
      high[axis] = place[axis] > high[axis] ? place[axis] : high[axis];
    }
  }
  for (int axis = 0; axis < 3; axis++) size = fmaxf(size, high[axis] - ordering->low[axis]);
  ordering->scale = size > 0 && size < INFINITY ? DIGIT / size : 0;
}

/* Sorts the indices of primitives by one digit of their Morton codes. */
static void sort_by_digit(const uint32_t *codes, const uint32_t *from, size_t count, int digit,
                          uint32_t *to) {
  uint32_t places[DIGIT + 1] = {0};
  const int shift = digit * CODE_BITS;
  for (size_t i = 0; i < count; i++) places[(codes[i] >> shift & (DIGIT - 1)) + 1]++;
  for (int d = 0; d < DIGIT; d++) places[d + 1] += places[d];
  for (size_t i = 0; i < count; i++) to[places[codes[from[i]] >> shift & (DIGIT - 1)]++] = from[i];
}

void hl_cluster_order_fill(hl_pool *pool, surfaces *all, uint32_t first, uint32_t count, uint32_t *spare) {
  ordering ordering = {.all = all, .first = first, .count = count, .codes = spare};
  uint32_t *a = spare + count, *b = a + count;
  find_cube(&ordering);
  hl_pool_run(pool, ((size_t)count + A_TASK - 1) / A_TASK, code_task, &ordering);
  for (uint32_t i = 0; i < count; i++) a[i] = i;
  for (int digit = 0; digit < DIGITS; digit++) {
    sort_by_digit(ordering.codes, a, count, digit, b);
    uint32_t *swapped = a;
    a = b;
    b = swapped;
  }
  for (uint32_t i = 0; i < count; i++) all->order[first + i] = first + a[i];
}
