/* guess/seen_cells.h - finds the voxels of a volume that count when a picture is framed, by a lattice of
 * cells.
 *
 * A cell counts as seen if its columns along at least two of the grid's axes absorb light. Cells that share
 * faces form bodies. Specks, which are bodies much smaller than the largest one, do not count, unless all
 * specks together have many cells. Holders of a patient in a CT scan do not count, either. By these rules,
 * faint matter and single voxels of noise do not widen the picture. */
#ifndef HL_GUESS_SEEN_CELLS_H
#define HL_GUESS_SEEN_CELLS_H

#include <stdint.h>
#include "core/error.h"
#include "core/vector.h"
#include "scene/geometry/cut.h"
#include "scene/scene.h"

enum { HL_SEEN_NOTHING = 0, HL_SEEN_BESIDE = 1, HL_SEEN = 2 }; /* BESIDE: the cell is next to a seen cell */

typedef struct hl_seen {
  const hl_volume *volume;
  cut_shape *cuts; /* owned; [cut_count]; matter that the cuts remove is not seen */
  size_t cut_count;
  const hl_mask *mask;        /* borrowed; matter that the mask hides is not seen; null if the volume has no
                               * mask */
  affine3 index_to_mask;      /* maps the volume's index space to the index space of the mask's label map */
  ptrdiff_t first[3], end[3]; /* voxels inside the volume's box */
  size_t step;                /* number of voxels along each edge of a cell */
  size_t stride;              /* along y and z, every stride-th row is examined */
  int size[3];                /* number of cells */
  float *depth; /* owned; optical depth per world length; for whole numbers, one element for each stored
                 * number; for floats, one for the low end of each bin */
  struct {
    const hl_transfer_function *function; /* in bins in which the function bends, it is evaluated for the
                                           * voxel's own value; in other bins, `depth` is interpolated */
    double low, scale;                    /* bin = (value - low) * scale */
    unsigned char *bends;                 /* owned; [bins]; whether the function bends in the bin */
  } bins;                                 /* for floats */
  unsigned char *kind;                    /* owned; [size[2]][size[1]][size[0]]; HL_SEEN_... */
  float *mean;                            /* owned; [size[2]][size[1]][size[0]]; mean depth per length of a
                                           * cell's voxels */
  void *row;   /* owned; room for the stored values of a row of voxels; null if the volume is in memory, where
                * no copy is needed */
  float faint; /* least depth per length with which voxels beside seen cells count */
} hl_seen;

/* Finds the cells of a volume. *any: set to whether anything of the volume can be seen. Fails only for lack
 * of memory; release the result in any case. */
hl_status hl_seen_find(const hl_scene_volume *volume, hl_seen *seen, bool *any, hl_error *error);
void hl_seen_release(hl_seen *seen);

/* The first and the last voxel that counts in the row (j, k). Returns false if no voxel of the row counts. */
bool hl_seen_row(const hl_seen *seen, ptrdiff_t j, ptrdiff_t k, ptrdiff_t *first, ptrdiff_t *last);

/* ---- bodies: marked places of a lattice that are connected by their faces ---- */

typedef struct hl_bodies {
  uint32_t *body;   /* owned; [size[2]][size[1]][size[0]]; number of the place's body, from 1 to count; 0 if
                     * the place is not marked */
  uint32_t *places; /* owned; [count + 1]; each body's number of places */
  uint32_t count;
  uint32_t largest; /* number of the body with the most places; of equally large bodies, the first; 0 if there
                     * are no bodies */
} hl_bodies;

/* Finds the bodies. marked: not 0 where a place belongs to a body. Fails only for lack of memory; release the
 * result in any case. */
hl_status hl_bodies_find(hl_context *context, const unsigned char *marked, const int size[3],
                         hl_bodies *bodies, hl_error *error);
void hl_bodies_release(hl_context *context, hl_bodies *bodies);

#endif
