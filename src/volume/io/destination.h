/* volume/io/destination.h - stores the voxels that a reader gives: in memory, in the pages of a scratch file
 * if memory is short, or, if the work is divided among ranks, in this rank's share of the slices.
 *
 * In: stored values, in pieces of any size and order, from several threads at once. Out: the volume. */
#ifndef HL_VOLUME_DESTINATION_H
#define HL_VOLUME_DESTINATION_H

#include "volume/colors.h"
#include "volume/exact.h"
#include "volume/store/pages.h"

typedef struct hl_destination {
  hl_context *context;
  const char *path;      /* borrowed; starts the error lines */
  size_t voxel_bytes;    /* bytes of a stored value, or of a voxel's colours */
  unsigned char *voxels; /* owned; [k][j][i]; null if the voxels are in pages */
  hl_pages *pages;       /* owned; null if the voxels are in one array in memory */
  hl_exact exact;        /* the file's own numbers, if stored values round any of them */
  hl_own_voxels *own;    /* owned; this rank's slices of a volume over ranks, for which `voxels` is null; null
                          * for other volumes */
} hl_destination;

typedef enum hl_destination_kind {
  HL_DESTINATION_PIECES, /* voxels are stored in memory; in pages if memory is short, or if several ranks
                          * share the volume */
  HL_DESTINATION_VOXELS, /* voxels are always stored in memory, for readers that access voxels more than
                          * once */
  HL_DESTINATION_COLORS  /* voxels are colours (colors.h), and are always stored in memory */
} hl_destination_kind;

/* Opens a destination. grid: the volume's grid, which the caller has checked. The caller must close the
 * destination also after a failure. */
hl_status hl_destination_open(hl_context *context, const hl_volume_description *grid,
                              hl_destination_kind kind, const char *path, hl_destination *destination,
                              hl_error *error);

/* Opens a destination of HL_DESTINATION_PIECES whose voxels have one value until they are stored, if sparse
 * pages can hold the voxels. value: the stored value. If sparse pages cannot hold the voxels, the function
 * does what hl_destination_open() does, and the caller must store every voxel. */
hl_status hl_destination_open_sparse(hl_context *context, const hl_volume_description *grid,
                                     const void *value, const char *path, hl_destination *destination,
                                     hl_error *error);
static inline bool hl_destination_is_sparse(const hl_destination *destination) {
  return destination->pages != NULL && hl_pages_are_sparse(destination->pages);
}
/* Returns whether the sparse pages hold too many voxels, so that one array should hold the volume instead. */
bool hl_destination_is_crowded(const hl_destination *destination);
/* Moves the voxels of sparse pages into one array, which also holds the value of voxels that are not stored.
 * No other thread may use the destination during the call of hl_destination_spread(). */
hl_status hl_destination_spread(hl_destination *destination, hl_error *error);

/* Gives memory into which the caller writes `count` voxels, of which the first is number `first`. The memory
 * is either the volume's own memory for these voxels, or a separate block. Afterwards the caller must call
 * hl_destination_put(), which stores the voxels of a separate block and releases the block. */
hl_status hl_destination_take(hl_destination *destination, size_t first, size_t count, void **place,
                              hl_error *error);
void hl_destination_put(hl_destination *destination, size_t first, size_t count, void *place);

/* Returns whether the destination keeps any of `count` voxels, of which the first is number `first`. If the
 * work is divided among ranks, the voxels of other ranks are not kept, and need not be read. */
bool hl_destination_wants(const hl_destination *destination, size_t first, size_t count);

/* Returns whether the destination's voxels are not in one array in memory, so that hl_destination_store()
 * must copy voxels into the destination. */
static inline bool hl_destination_is_apart(const hl_destination *destination) {
  return destination->voxels == NULL;
}
void hl_destination_store(hl_destination *destination, size_t first, size_t count, const void *values);

/* Records the numbers of voxels in the file's own type, before the voxels are stored; see hl_exact_note(). */
static inline void hl_destination_note(hl_destination *destination, bool swap, const void *source,
                                       size_t first, size_t count) {
  hl_exact_note(&destination->exact, swap, source, first, count);
}

/* Makes the volume. The destination's memory passes to the volume, and is released if the function fails.
 * grid: the grid with which the destination was opened. */
hl_status hl_destination_adopt(hl_destination *destination, const hl_volume_description *grid,
                               hl_volume **volume, hl_error *error);

/* Does what hl_destination_adopt() does, for a volume of colours. */
hl_status hl_destination_adopt_colors(hl_destination *destination, const hl_color_source *source,
                                      hl_volume **volume, hl_error *error);

void hl_destination_close(hl_destination *destination);

#endif
