/* grid/faces.h - which faces of a volume's box cut through what the transfer function shows: the box's own
 * faces at the grid's border, or those of clip. */
#ifndef HL_GRID_FACES_H
#define HL_GRID_FACES_H

#include "core/pool.h"
#include "grid/classifier.h"

/* Finds grid->face_shows, after hl_grid_mark_relevant(): looks at one point a voxel of the faces that
 * relevant bricks reach. */
void hl_faces_find(hl_pool *pool, const kernel *kernel, const classifier *classifier, grid *grid);

#endif
