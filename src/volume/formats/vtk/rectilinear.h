/* volume/formats/vtk/rectilinear.h - makes volumes whose voxels lie on lines that are not evenly spaced, as
 * in VTK's rectilinear grids. */
#ifndef HL_VOLUME_RECTILINEAR_H
#define HL_VOLUME_RECTILINEAR_H

#include "volume/volume.h"

/* Places a volume by the coordinates of its points along x, y and z. counts: the number of coordinates along
 * each axis. The volume must have been read with steps of 1. of_cells: whether the volume's values belong to
 * the cells between the points. If the points are evenly spaced, to a thousandth of a step, only the volume's
 * origin and axes change. If the points are not evenly spaced, the volume's values are resampled on an even
 * grid: values at points are interpolated linearly, and for values of cells a new voxel gets the value of the
 * cell in which it lies. *volume is replaced by the placed volume, and is released on failure. */
hl_status hl_rectilinear_place(hl_volume **volume, double *const coordinates[3], const size_t counts[3],
                               bool of_cells, const char *path, hl_error *error);

#endif
