/* grid/faces.h - where the faces of a volume's box cut through what the transfer function shows: the box's
 * own faces at the grid's border, or those of clip.
 *
 * What is seen through such a face is lit by the face's normal; what ends by itself close to a face is not.
 * So each face has a map of the density on it: as on sheets, less the empty value, at one point a voxel. */
#ifndef HL_GRID_FACES_H
#define HL_GRID_FACES_H

#include "core/memory.h"
#include "grid/classifier.h"

/* The axis along the rows of the maps of the faces across an axis, and the one along their columns. */
static inline int hl_face_row_axis(int axis) { return axis == 0 ? 1 : 0; }
static inline int hl_face_column_axis(int axis) { return axis == 2 ? 1 : 2; }

/* Takes the grid's face_maps. */
void hl_faces_lay_out(grid *grid, hl_layout *layout);

/* Finds the maps, after hl_grid_mark_relevant(). */
void hl_faces_find(hl_pool *pool, const kernel *kernel, const classifier *classifier, grid *grid);

#endif
