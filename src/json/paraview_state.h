/* json/paraview_state.h - the transfer function of a ParaView state. */
#ifndef HL_JSON_PARAVIEW_STATE_H
#define HL_JSON_PARAVIEW_STATE_H

#include "json/parts.h"

/* Reads the function of the one volume that the state FILE.pvsm shows: colours and opacities, or boxes
 * (vtkPVTransferFunction2D) as VTK shows them on this volume: it lays the function's range over the values'
 * range and over a quarter of it as lengths of gradients per mean voxel edge. volume null: the boxes' numbers
 * stay as they are in the file. What is made is owned by *function, after a failure too. */
hl_status hl_paraview_read_state(hl_context *context, const char *path, const hl_volume *volume,
                                 hl_transfer_function *function, hl_error *error);

#endif
