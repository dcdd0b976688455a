/* shadow_cascade/cascade_reads.h - finds where a cascade's buffer is read before the next refill, because the
 * cascade's passes need to compute only these tiles. */
#ifndef HL_SHADOW_CASCADE_CASCADE_READS_H
#define HL_SHADOW_CASCADE_CASCADE_READS_H

#include "shadow_cascade/cascade_field.h"
#include "view/occupancy.h"

/* A summed-area table of the tiles that are read. The sum over a rectangle takes four entries of the
 * table. */
typedef struct cascade_reads {
  int tiles_x, tiles_y;
  uint32_t *before; /* owned; [tiles_y + 1][tiles_x + 1]; for each entry, the number of read tiles above the
                     * entry and to its left */
} cascade_reads;

/* READ_EVERYWHERE: the reach of a pass that must compute all tiles, because its results are kept. */
enum { READ_EVERYWHERE = -1 };

/* Marks the tiles that the next sheets touch in the light's view, because the picture's slabs look up the
 * buffer in these tiles. needed_until: [tiles]; if the picture is shared, only tiles that this part needs at
 * the slab of the first sheet are marked; null if all tiles may be marked. */
void hl_cascade_reads_find(cascade_reads *reads, const occupancy *occupancy, const int32_t *needed_until,
                           int first_sheet, int last_sheet);

/* The two rows of the summed-area table that enclose a band of rows of tiles: one row above the band, and one
 * row below the band. */
typedef struct read_band {
  const uint32_t *upper, *lower;
} read_band;

/* The reads around a row of tiles of a level, within a given number of pixels of the buffer. scale: the edge
 * of the level's pixels, in pixels of the buffer. */
typedef struct read_row {
  int scale, reach, tiles_x;
  int around;                     /* the number of tiles to either side in which reads count */
  bool any;                       /* whether any tile is read; `blocks` is set only if so */
  read_band all;                  /* the band around the whole row of tiles */
  read_band blocks[TILE / BLOCK]; /* a band for each four rows of pixels of the row of tiles */
} read_row;

read_row hl_cascade_read_row(const cascade_reads *reads, int scale, int y, int reach);

/* Returns whether anything is read within the reach of the tile x. Along rows the reach is rounded up to
 * whole tiles. */
static inline bool hl_cascade_is_read(const read_row *row, const read_band *band, int x) {
  if (row->reach == READ_EVERYWHERE) return true;
  int x0 = x * row->scale - row->around, x1 = (x + 1) * row->scale + row->around;
  if (x0 < 0) x0 = 0;
  if (x1 > row->tiles_x) x1 = row->tiles_x;
  return band->lower[x1] - band->lower[x0] != band->upper[x1] - band->upper[x0];
}

/* Finds the rows of pixels of the tile x that must be computed, in steps of four rows. At least a part of the
 * tile must be read. */
static inline tile_rows hl_cascade_rows_read(const read_row *row, int x) {
  tile_rows rows = ALL_ROWS;
  if (row->reach == READ_EVERYWHERE) return rows;
  while (!hl_cascade_is_read(row, &row->blocks[rows.first / BLOCK], x)) rows.first += BLOCK;
  while (!hl_cascade_is_read(row, &row->blocks[rows.end / BLOCK - 1], x)) rows.end -= BLOCK;
  return rows;
}

#endif
