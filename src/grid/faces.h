/* grid/faces.h - finds which faces of a volume's box cut through visible matter. The faces are the box's own
 * at the grid's border, or the faces of `clip`. */
#ifndef HL_GRID_FACES_H
#define HL_GRID_FACES_H

#include "core/pool.h"
#include "grid/classifier.h"

/* Finds grid->face_shows. Call it after hl_grid_mark_relevant(). It looks at one point for each voxel of the
 * faces, where relevant bricks reach the faces. */
void hl_faces_find(hl_pool *pool, const kernel *kernel, const classifier *classifier, grid *grid);

#endif
