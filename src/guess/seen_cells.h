/* guess/seen_cells.h - what of a volume is seen: a lattice of cells that tells which voxels count when a
 * picture is framed.
 *
 * A cell is seen where a ray along at least two of the grid's axes would lose light in its column, and where
 * it belongs to a body: specks, a few cells that are nothing beside the greatest body, do not count as long
 * as all of them together are little. What contributes nothing to a picture and the single voxels of a noisy
 * one then have no say in it. */
#ifndef HL_GUESS_SEEN_CELLS_H
#define HL_GUESS_SEEN_CELLS_H

#include <stdint.h>
#include "core/error.h"
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

/* ---- which marked places of a lattice hang together. */

/* Places are neighbours where they share a face. */
typedef struct hl_bodies {
  uint32_t *body;   /* owned; [size[2]][size[1]][size[0]]; 0: not marked; else 1 to count */
  uint32_t *places; /* owned; [count + 1]; how many places a body has */
  uint32_t count;
  uint32_t largest; /* the body with the most places, the first of equals; 0: there is none */
} hl_bodies;

/* marked: not 0 where a place is in some body. Fails for lack of memory alone; release in any case. */
hl_status hl_bodies_find(hl_context *context, const unsigned char *marked, const int size[3],
                         hl_bodies *bodies, hl_error *error);
void hl_bodies_release(hl_context *context, hl_bodies *bodies);

#endif
