/* grid/faces.h - finds which faces of a volume's box cut through visible matter. A face of the box is the
 * border of the grid, or a face of the scene's box `clip`. */
#ifndef HL_GRID_FACES_H
#define HL_GRID_FACES_H

#include "core/pool.h"
#include "grid/classifier.h"

/* Finds grid->face_shows: for each face of the box, whether something is visible on it. The function tests
 * one point for each voxel of a face, where relevant bricks reach the face. Call this function after
 * hl_grid_mark_relevant(). */
void hl_faces_find(hl_pool *pool, const kernel *kernel, const classifier *classifier, grid *grid);

#endif
