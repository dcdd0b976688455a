/* volume/formats/zarr/shard.c - reads the index of a shard, and finds the parts of a shard's file that hold
 * the wanted chunks. */
#include "volume/formats/zarr/shard.h"

#include <stdlib.h>

/* The number of bytes that arrive in the time of a further request, if a request takes 10 ms and the
 * connection has 50 Mbit/s. */
enum { BYTES_OF_A_REQUEST = 1 << 16 };

size_t hl_zarr_index_bytes(const hl_zarr_array *array) {
  return (size_t)array->shards.chunks * 16 + 4 * (size_t)array->shards.index_checks;
}

hl_fetch_range hl_zarr_index_range(const hl_zarr_array *array) {
  return (hl_fetch_range){array->shards.index_at_start ? 0 : UINT64_MAX, hl_zarr_index_bytes(array)};
}

static uint64_t little_u64(const unsigned char *bytes) {
  uint64_t value = 0;
  for (int n = 7; n >= 0; n--) value = value << 8 | bytes[n];
  return value;
}

bool hl_zarr_index_find(const hl_zarr_array *array, const unsigned char *index, const uint64_t *inner,
                        uint64_t size, uint64_t *offset, uint64_t *length) {
  uint64_t number = 0;
  for (int axis = 0; axis < array->rank; axis++) number = number * array->shards.size[axis] + inner[axis];
  *offset = little_u64(index + 16 * number);
  *length = little_u64(index + 16 * number + 8);
  if (*offset == UINT64_MAX && *length == UINT64_MAX) {
    *length = 0;
    return true;
  }
  return *length > 0 && *offset <= size && *length <= size - *offset;
}

/* ---- spans ---- */

static int by_begin(const void *a, const void *b) {
  const hl_fetch_range *first = a, *second = b;
  return first->begin < second->begin ? -1 : first->begin > second->begin;
}

static uint64_t gap_before(const hl_fetch_range *range) {
  return range[0].begin - range[-1].begin - range[-1].count;
}

/* Joins ranges that overlap or touch. ranges: sorted by their begins. */
static size_t join_touching(hl_fetch_range *ranges, size_t count) {
  size_t joined = 0;
  for (size_t n = 0; n < count; n++) {
    hl_fetch_range *last = joined > 0 ? &ranges[joined - 1] : NULL;
    uint64_t end = last != NULL ? last->begin + last->count : 0, own = ranges[n].begin + ranges[n].count;
    if (last == NULL || ranges[n].begin > end) ranges[joined++] = ranges[n];
    else if (own > end) last->count = own - last->begin;
  }
  return joined;
}

/* Joins ranges with at most `gap` bytes between them. The first `kept` gaps of exactly `gap` bytes are not
 * joined.
 */
static size_t join(hl_fetch_range *ranges, size_t count, uint64_t gap, size_t kept) {
  size_t joined = 1;
  for (size_t n = 1; n < count; n++) {
    hl_fetch_range *last = &ranges[joined - 1];
    uint64_t own = gap_before(&ranges[n]), end = ranges[n].begin + ranges[n].count;
    bool stays = own > gap || (own == gap && kept > 0);
    if (own == gap && kept > 0) kept--;
    if (stays) ranges[joined++] = ranges[n];
    else last->count = end - last->begin;
  }
  return joined;
}

static size_t count_wider(const hl_fetch_range *ranges, size_t count, uint64_t gap) {
  size_t wider = 0;
  for (size_t n = 1; n < count; n++) wider += gap_before(&ranges[n]) > gap;
  return wider;
}

size_t hl_zarr_spans_join(hl_fetch_range *ranges, size_t count) {
  enum { GAPS_MOST = HL_ZARR_SPANS_MOST - 1 };
  if (count == 0) return 0;
  qsort(ranges, count, sizeof *ranges, by_begin);
  count = join_touching(ranges, count);
  if (count_wider(ranges, count, BYTES_OF_A_REQUEST) <= GAPS_MOST)
    return join(ranges, count, BYTES_OF_A_REQUEST, 0);
  /* a bisection finds the least width that at most GAPS_MOST gaps exceed */
  uint64_t low = BYTES_OF_A_REQUEST, high = UINT64_MAX;
  while (high - low > 1) {
    uint64_t middle = low + (high - low) / 2;
    if (count_wider(ranges, count, middle) > GAPS_MOST) low = middle;
    else high = middle;
  }
  return join(ranges, count, high, GAPS_MOST - count_wider(ranges, count, high));
}
