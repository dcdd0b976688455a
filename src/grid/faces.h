/* grid/faces.h - finds which faces of a volume's box cut through visible matter. The faces are the box's own
 * at the grid's border, or the faces of `clip`. */
#ifndef HL_GRID_FACES_H
#define HL_GRID_FACES_H

#include "core/pool.h"
#include "grid/classifier.h"

/* The distance behind a face, in voxels, from which on matter is lit as if there were no face. Matter nearer
 * to the face is partly lit as a surface at the face. */
#define FACE_VOXELS 2.0f

/* Finds grid->face_shows; called after hl_grid_mark_relevant(). Looks at one point for each voxel of the
 * faces that relevant bricks reach. */
void hl_faces_find(hl_pool *pool, const kernel *kernel, const classifier *classifier, grid *grid);

#endif
