/* volume/formats/pieces.c - makes a volume of the pieces in which a file holds it, as pieces.h describes. */
#include "volume/formats/pieces.h"

#include <string.h>

#include "volume/convert.h"

hl_status hl_pieces_begin(hl_context *context, const hl_volume_description *grid, const char *path,
                          hl_pieces *pieces, hl_error *error) {
  pieces->grid = *grid;
  hl_status status = hl_destination_open(context, grid, HL_DESTINATION_VOXELS, path, &pieces->to, error);
  const size_t *n = grid->dimensions;
  if (status == HL_OK) memset(pieces->to.voxels, 0, n[0] * n[1] * n[2] * pieces->to.voxel_bytes);
  return status;
}

hl_status hl_pieces_put(hl_pieces *pieces, const hl_volume *piece, const size_t first[3], hl_error *error) {
  const size_t *whole = pieces->grid.dimensions, *size = piece->dimension;
  size_t bytes = pieces->to.voxel_bytes;
  bool fits = piece->pages == NULL && piece->colors == NULL && piece->type == pieces->grid.type;
  for (int axis = 0; axis < 3; axis++)
    fits = fits && first[axis] < whole[axis] && size[axis] <= whole[axis] - first[axis];
  if (!fits)
    return hl_fail(error, HL_ERROR_INPUT,
                   "%s: a piece of %zu x %zu x %zu %s lies beyond the whole, or has another type",
                   pieces->to.path, size[0], size[1], size[2], hl_voxel_type_name(piece->type));
  for (size_t k = 0; k < size[2]; k++)
    for (size_t j = 0; j < size[1]; j++) {
      size_t to = ((first[2] + k) * whole[1] + first[1] + j) * whole[0] + first[0];
      memcpy(pieces->to.voxels + to * bytes, hl_volume_row(piece, j, k), size[0] * bytes);
      if (piece->exact != NULL)
        hl_destination_note(&pieces->to, false, hl_volume_numbers(piece, j, k, NULL).numbers, to, size[0]);
    }
  return HL_OK;
}

hl_status hl_pieces_adopt(hl_pieces *pieces, hl_volume **volume, hl_error *error) {
  return hl_destination_adopt(&pieces->to, &pieces->grid, volume, error);
}

void hl_pieces_close(hl_pieces *pieces) { hl_destination_close(&pieces->to); }
