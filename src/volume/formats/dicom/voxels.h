/* volume/formats/dicom/voxels.h - reads the voxels of a stack of slices. */
#ifndef HL_VOLUME_DICOM_VOXELS_H
#define HL_VOLUME_DICOM_VOXELS_H

#include "volume/formats/dicom/stack.h"
#include "volume/formats/format.h"

/* Decodes all slices of the wanted component or time step, in parallel. */
hl_status hl_dicom_voxels_read(hl_dicom_set *set, hl_dicom_stack *stack, hl_load_request *request,
                               hl_volume **volume, hl_error *error);

#endif
