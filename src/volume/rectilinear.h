/* volume/rectilinear.h - volumes whose voxels lie on lines that are not evenly spaced: VTK's rectilinear
 * grids. */
#ifndef HL_VOLUME_RECTILINEAR_H
#define HL_VOLUME_RECTILINEAR_H

#include "volume/volume.h"

/* Places a volume, which was read as if its steps were 1, by the coordinates of its points along x, y and z,
 * of which there are counts[axis]. of_cells: its values are those of the cells between the points. Where the
 * points are evenly spaced, to a thousandth of a step, nothing but its place changes; else its values are
 * resampled: linearly between points, or as those of the cell at the place. *volume is replaced, and released
 * on failure. */
hl_status hl_rectilinear_place(hl_volume **volume, double *const coordinates[3], const size_t counts[3],
                               bool of_cells, const char *path, hl_error *error);

#endif
