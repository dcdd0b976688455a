/* shadow_cascade/cascade_reads.h - where a cascade's buffer is read before it is found anew, and so what its
 * passes must find. */
#ifndef HL_SHADOW_CASCADE_CASCADE_READS_H
#define HL_SHADOW_CASCADE_CASCADE_READS_H

#include "shadow_cascade/cascade_field.h"
#include "view/occupancy.h"

/* Sums over rectangles of tiles are four of these (a summed-area table). */
typedef struct cascade_reads {
  int tiles_x, tiles_y;
  uint32_t *
      before; /* owned; [tiles_y + 1][tiles_x + 1]; of the tiles above and to the left, those that are read */
} cascade_reads;

/* Of a pass that must find everything, as its results are kept. */
enum { READ_EVERYWHERE = -1 };

/* Tiles that sheets of the light's occupancy touch: there their slabs are looked up. */
void hl_cascade_reads_find(cascade_reads *reads, const occupancy *occupancy, int first_sheet, int last_sheet);

/* Rows of the table around some rows of tiles: at the first of them, and after the last. */
typedef struct read_band {
  const uint32_t *upper, *lower;
} read_band;

/* A row of tiles of a level with pixels `scale` wide, and what is read within `reach` pixels of the buffer of
 * it. */
typedef struct read_row {
  int scale, reach, tiles_x;
  int around;                     /* reach in tiles */
  bool any;                       /* of the whole row; if not, the bands of blocks are not set */
  read_band all;                  /* of the whole row */
  read_band blocks[TILE / BLOCK]; /* of each four of its pixels' rows */
} read_row;

read_row hl_cascade_read_row(const cascade_reads *reads, int scale, int y, int reach);

/* Whether anything is read within reach of the x-th tile. Sideways whole tiles count. */
static inline bool hl_cascade_is_read(const read_row *row, const read_band *band, int x) {
  if (row->reach == READ_EVERYWHERE) return true;
  int x0 = x * row->scale - row->around, x1 = (x + 1) * row->scale + row->around;
  if (x0 < 0) x0 = 0;
  if (x1 > row->tiles_x) x1 = row->tiles_x;
  return band->lower[x1] - band->lower[x0] != band->upper[x1] - band->upper[x0];
}

/* The rows, in steps of four, of a tile that is read. */
static inline tile_rows hl_cascade_rows_read(const read_row *row, int x) {
  tile_rows rows = ALL_ROWS;
  if (row->reach == READ_EVERYWHERE) return rows;
  while (!hl_cascade_is_read(row, &row->blocks[rows.first / BLOCK], x)) rows.first += BLOCK;
  while (!hl_cascade_is_read(row, &row->blocks[rows.end / BLOCK - 1], x)) rows.end -= BLOCK;
  return rows;
}

#endif
