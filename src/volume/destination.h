/* volume/destination.h - where a reader puts voxels: memory, the pages of a scratch file where memory has no
 * room, or, over ranks, this rank's share of the slices.
 *
 * In: stored values, in pieces of any size and order, from several threads at once. Out: the volume. */
#ifndef HL_VOLUME_DESTINATION_H
#define HL_VOLUME_DESTINATION_H

#include "volume/colors.h"
#include "volume/exact.h"
#include "volume/pages.h"

typedef struct hl_destination {
  hl_context *context;
  const char *path;      /* borrowed; starts the error lines */
  size_t voxel_bytes;    /* of a stored value, or of a voxel's colours */
  unsigned char *voxels; /* owned; [k][j][i]; null with pages */
  hl_pages *pages;       /* owned; null: in memory */
  hl_exact exact;        /* the file's own numbers, where stored values round them */
  hl_own_voxels *own;    /* owned; over ranks: this rank's slices, `voxels` is null; else null */
} hl_destination;

typedef enum hl_destination_kind {
  HL_DESTINATION_PIECES, /* in pages where memory has no room, or over ranks */
  HL_DESTINATION_VOXELS, /* in memory in any case: the reader comes back to voxels */
  HL_DESTINATION_COLORS  /* in memory in any case: colours (colors.h) */
} hl_destination_kind;

/* grid: checked. Close the destination in any case. */
hl_status hl_destination_open(hl_context *context, const hl_volume_description *grid,
                              hl_destination_kind kind, const char *path, hl_destination *destination,
                              hl_error *error);

/* A place for `count` voxels, those from number `first` on: their own, or a block that is released when it is
 * put. Put each place that was taken. */
hl_status hl_destination_take(hl_destination *destination, size_t first, size_t count, void **place,
                              hl_error *error);
void hl_destination_put(hl_destination *destination, size_t first, size_t count, void *place);

/* Whether any of these voxels is kept: the others of a volume over ranks need not be read. */
bool hl_destination_wants(const hl_destination *destination, size_t first, size_t count);

/* Whether there is no array of all voxels: hl_destination_store() copies voxels to where they belong. */
static inline bool hl_destination_is_apart(const hl_destination *destination) {
  return destination->voxels == NULL;
}
void hl_destination_store(hl_destination *destination, size_t first, size_t count, const void *values);

/* Notes voxels as the file has them, in its own type, before they are stored: hl_exact_note(). */
static inline void hl_destination_note(hl_destination *destination, bool swap, const void *source,
                                       size_t first, size_t count) {
  hl_exact_note(&destination->exact, swap, source, first, count);
}

/* Makes the volume, which takes over what the destination owns, also on failure. grid: as it was opened. */
hl_status hl_destination_adopt(hl_destination *destination, const hl_volume_description *grid,
                               hl_volume **volume, hl_error *error);

/* As hl_destination_adopt(), for voxels that are colours. */
hl_status hl_destination_adopt_colors(hl_destination *destination, const hl_color_source *source,
                                      hl_volume **volume, hl_error *error);

void hl_destination_close(hl_destination *destination);

#endif
