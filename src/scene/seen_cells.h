/* scene/seen_cells.h - what of a volume is seen: a lattice of cells that tells which voxels count when a
 * picture is framed.
 *
 * A cell is seen where a ray along at least two of the grid's axes would lose light in its column, and where
 * it belongs to a body: specks, a few cells that are nothing beside the greatest body, do not count as long
 * as all of them together are little. What contributes nothing to a picture and the single voxels of a noisy
 * one then have no say in it. */
#ifndef HL_SCENE_SEEN_CELLS_H
#define HL_SCENE_SEEN_CELLS_H

#include "scene/scene.h"

enum { HL_SEEN_NOTHING = 0, HL_SEEN_BESIDE = 1, HL_SEEN = 2 };

typedef struct hl_seen {
  const hl_volume *volume;
  ptrdiff_t first[3], end[3]; /* voxels inside the volume's box */
  size_t step;                /* voxels along each edge of a cell */
  size_t stride;              /* every so many rows along y and z are looked at */
  int size[3];                /* cells */
  float *depth; /* owned; optical depth per length of the world: of each stored whole number, else of each
                   bin's low end */
  const hl_transfer_function *function; /* for bins in which it bends */
  double low, scale;                    /* bin = (value - low) * scale; of floats */
  unsigned char *bends;                 /* owned; [bins]; of floats */
  unsigned char *kind;                  /* owned; [size[2]][size[1]][size[0]] */
  float *mean;                          /* owned; likewise: depth per length, mean of a cell's voxels */
  float faint;                          /* depth per length of voxels that count beside what is seen */
} hl_seen;

/* *any: false where nothing of the volume can be seen (then nothing is left to release, but may be). Fails
 * for lack of memory alone; release in any case. */
hl_status hl_seen_find(const hl_scene_volume *volume, hl_seen *seen, bool *any, hl_error *error);
void hl_seen_release(hl_seen *seen);

/* The first voxel that counts in the row (j, k), and the last; false: there is none. */
bool hl_seen_row(const hl_seen *seen, ptrdiff_t j, ptrdiff_t k, ptrdiff_t *first, ptrdiff_t *last);

#endif
