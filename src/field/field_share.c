/* field/field_share.c - see field_share.h. */
#include "field/field_share.h"

#include <string.h>

/* GATHERED: the number of bytes, approximately, that a process gets from all others in one exchange.
 * LEAST_PIECE: the least number of bytes from one process. */
enum { GATHERED = 4 << 20, LEAST_PIECE = 1 << 14 };

void hl_field_share_lay_out(const light_exchange *with, size_t slabs, field_share *share, hl_layout *layout) {
  *share = (field_share){.with = with != NULL && with->parts > 1 ? with : NULL};
  if (share->with == NULL) return;
  size_t parts = (size_t)with->parts, piece = GATHERED / parts;
  share->piece = piece > LEAST_PIECE ? piece : LEAST_PIECE;
  share->own = hl_layout_take(layout, share->piece, 1);
  share->all = hl_layout_take(layout, parts, share->piece);
  share->first = hl_layout_take(layout, parts + 1, sizeof *share->first);
  share->weights = hl_layout_take(layout, slabs, sizeof *share->weights);
}

void hl_field_share_ranges(field_share *share, int32_t slabs) {
  uint64_t all = 0, before = 0, parts = (uint64_t)share->with->parts, part = 0;
  for (int32_t z = 0; z < slabs; z++) all += share->weights[z];
  for (int32_t z = 0; z < slabs; z++) { /* a slab belongs to the range that holds its middle */
    uint64_t middle = 2 * before + share->weights[z];
    while (part < parts && part * 2 * all <= middle * parts) share->first[part++] = z;
    before += share->weights[z];
  }
  while (part <= parts) share->first[part++] = slabs;
}

/* The n-th of the slabs that a process finds, where a slab is all cells of one z; -1: the process has fewer
 * slabs. */
static int32_t slab_of(const field_share *share, bool ranges, int part, int32_t n, int32_t slabs) {
  int32_t slab = ranges ? share->first[part] + n : part + n * share->with->parts,
          end = ranges ? share->first[part + 1] : slabs;
  return slab < end ? slab : -1;
}

/* The greatest number of slabs, layers of cells of one z, that any process finds. */
static int32_t most_slabs(const field_share *share, bool ranges, int32_t slabs) {
  int32_t most = 0;
  for (int part = 0; part < share->with->parts; part++)
    while (slab_of(share, ranges, part, most, slabs) >= 0) most++;
  return most;
}

void hl_field_share_complete(const field_share *share, bool ranges, void *array, int32_t slabs,
                             size_t slab_bytes) {
  const light_exchange *with = share->with;
  unsigned char *slab = array;
  const int32_t rounds = most_slabs(share, ranges, slabs);
  for (int32_t n = 0; n < rounds; n++)
    for (size_t from = 0; from < slab_bytes; from += share->piece) {
      size_t bytes = slab_bytes - from < share->piece ? slab_bytes - from : share->piece;
      int32_t own = slab_of(share, ranges, with->part, n, slabs);
      if (own >= 0) memcpy(share->own, slab + (size_t)own * slab_bytes + from, bytes);
      with->gather(with->data, share->own, bytes, share->all);
      for (int part = 0; part < with->parts; part++) {
        int32_t other = slab_of(share, ranges, part, n, slabs);
        if (part != with->part && other >= 0)
          memcpy(slab + (size_t)other * slab_bytes + from, share->all + (size_t)part * bytes, bytes);
      }
    }
}
