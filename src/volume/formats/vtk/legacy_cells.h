/* volume/formats/vtk/legacy_cells.h - reads legacy .vtk files with UNSTRUCTURED_GRID or STRUCTURED_GRID. */
#ifndef HL_VOLUME_LEGACY_CELLS_H
#define HL_VOLUME_LEGACY_CELLS_H

#include "core/error.h"
#include "volume/formats/format.h"
#include "volume/io/stream.h"

/* Returns whether a DATASET of this kind is a grid of cells. */
bool hl_legacy_is_of_cells(const char *kind);

/* Reads the file from its start as a volume of sampled cells (cell_mesh.h). The parameters are the same as
 * for hl_format.load. A pipe, which cannot be read twice, is refused. */
hl_status hl_legacy_cells_load(hl_stream **stream, hl_load_request *request, hl_volume **volume,
                               hl_error *error);

#endif
