/* field/field_share.h - lets the processes that share a picture find a field together: each process finds
 * some of its slabs, and gets the other slabs from the processes that have found them.
 *
 * A slab is all cells of one z. */
#ifndef HL_FIELD_FIELD_SHARE_H
#define HL_FIELD_FIELD_SHARE_H

#include "core/light_exchange.h"
#include "core/memory.h"

typedef struct field_share {
  const light_exchange *with; /* the exchange with the other processes; borrowed; if null, this process finds
                               * all slabs */
  size_t piece;               /* the greatest number of bytes that each process gives in one exchange */
  unsigned char *own, *all;   /* own: [piece], bytes of this process; all: [parts][piece], bytes of all
                               * processes */
  int32_t *first;             /* [parts + 1]; the first slab of each process's range, see
                               * hl_field_share_ranges() */
  uint64_t *weights;          /* [slabs]; the estimated work for each slab, the input of
                               * hl_field_share_ranges() */
} field_share;

/* Takes the share's arrays from a layout. with: the exchange with the other processes; null if no arrays are
 * needed. */
void hl_field_share_lay_out(const light_exchange *with, size_t slabs, field_share *share, hl_layout *layout);

/* Divides the slabs, which are layers of cells of one z, into one range for each process. The sums of
 * share->weights in the ranges are about equal. A process has the slabs first[part] to first[part + 1] - 1.
 * All processes must have the same weights. */
void hl_field_share_ranges(field_share *share, int32_t slabs);

/* Returns whether this process finds a given slab (all cells of one z), if the processes take slabs in
 * turn. */
static inline bool hl_field_share_turn(const field_share *share, int32_t slab) {
  return share->with == NULL || slab % share->with->parts == share->with->part;
}

/* Completes an array of which each process has found its own slabs: afterwards all processes have all slabs.
 * array: [slabs][slab_bytes]. ranges: whether a process's own slabs are its range; if not, the processes take
 * slabs in turn. */
void hl_field_share_complete(const field_share *share, bool ranges, void *array, int32_t slabs,
                             size_t slab_bytes);

#endif
