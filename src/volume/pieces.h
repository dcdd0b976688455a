/* volume/pieces.h - a volume that files hold in pieces: each is read as a volume, and copied to its place.
 *
 * The whole is in memory, and one piece beside it. Voxels that no piece has are 0. */
#ifndef HL_VOLUME_PIECES_H
#define HL_VOLUME_PIECES_H

#include "volume/destination.h"

typedef struct hl_pieces {
  hl_volume_description grid; /* of the whole */
  hl_destination to;
} hl_pieces;

/* grid: checked. Close the pieces in any case. */
hl_status hl_pieces_begin(hl_context *context, const hl_volume_description *grid, const char *path,
                          hl_pieces *pieces, hl_error *error);
/* Copies a piece to the voxels from `first` on; refuses one that does not fit. */
hl_status hl_pieces_put(hl_pieces *pieces, const hl_volume *piece, const size_t first[3], hl_error *error);
hl_status hl_pieces_adopt(hl_pieces *pieces, hl_volume **volume, hl_error *error);
void hl_pieces_close(hl_pieces *pieces);

#endif
