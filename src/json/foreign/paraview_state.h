/* json/foreign/paraview_state.h - reads the transfer function of a ParaView state. */
#ifndef HL_JSON_FOREIGN_PARAVIEW_STATE_H
#define HL_JSON_FOREIGN_PARAVIEW_STATE_H

#include "json/parts.h"

/* Reads the transfer function of the only volume that the state FILE.pvsm shows: colours and opacities, or
 * boxes (vtkPVTransferFunction2D). Boxes are fitted to `volume` as VTK does it: their range along values
 * becomes the range of the volume's values; their range along gradients becomes lengths from 0 to a quarter
 * of the values' range per mean voxel edge. If volume is null, the boxes keep the file's numbers. The content
 * is owned by *function, also after a failure. */
hl_status hl_paraview_read_state(hl_context *context, const char *path, const hl_volume *volume,
                                 hl_transfer_function *function, hl_error *error);

#endif
