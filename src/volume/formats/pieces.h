/* volume/formats/pieces.h - makes a volume of the pieces in which a file holds it. Each piece is read as a
 * volume of its own, and is then copied into the whole volume.
 *
 * Only the whole volume and one piece are in memory at a time. Voxels that are in no piece are 0. */
#ifndef HL_VOLUME_PIECES_H
#define HL_VOLUME_PIECES_H

#include "volume/io/destination.h"

typedef struct hl_pieces {
  hl_volume_description grid; /* grid of the whole volume */
  hl_destination to;
} hl_pieces;

/* Begins a volume without any pieces. grid: the whole volume's grid, which the caller has checked. The caller
 * must close the pieces also after a failure. */
hl_status hl_pieces_begin(hl_context *context, const hl_volume_description *grid, const char *path,
                          hl_pieces *pieces, hl_error *error);
/* Copies a piece to the voxels from `first` on. Refuses a piece that does not fit into the volume. */
hl_status hl_pieces_put(hl_pieces *pieces, const hl_volume *piece, const size_t first[3], hl_error *error);
hl_status hl_pieces_adopt(hl_pieces *pieces, hl_volume **volume, hl_error *error);
void hl_pieces_close(hl_pieces *pieces);

#endif
