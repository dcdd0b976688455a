/* light/cascade_reads.h - where a cascade's buffer is read before it is found anew, and so what its passes must find. */
#ifndef HL_LIGHT_CASCADE_READS_H
#define HL_LIGHT_CASCADE_READS_H

#include "light/cascade_field.h"
#include "splat/occupancy.h"

/* Sums over rectangles of tiles are four of these (a summed-area table). */
typedef struct cascade_reads {
  int tiles_x, tiles_y;
  uint32_t *before; /* owned; [tiles_y + 1][tiles_x + 1]; of the tiles above and to the left, those that are read */
} cascade_reads;

/* Of a pass that must find everything, as its results are kept. */
enum { READ_EVERYWHERE = -1 };

/* Tiles that sheets of the light's occupancy touch: there their slabs are looked up. */
void hl_cascade_reads_find(cascade_reads *reads, const occupancy *occupancy, int first_sheet, int last_sheet);

/* A row of tiles of a level with pixels `scale` wide, and what is read within `reach` pixels of the buffer of it. */
typedef struct read_row {
  const cascade_reads *reads;
  int scale, y, reach;
  int around;                   /* reach in tiles */
  const uint32_t *upper, *lower; /* of before: at the first row of tiles within reach, and after the last */
} read_row;

read_row hl_cascade_read_row(const cascade_reads *reads, int scale, int y, int reach);

/* The rows of a tile that is read, in steps of four. */
tile_rows hl_cascade_rows_of_tile(const read_row *row, int x);

/* The rows of the x-th tile that lie within reach of what is read; ends at 0 where none does. */
static inline tile_rows hl_cascade_rows_read(const read_row *row, int x) {
  if (row->reach == READ_EVERYWHERE) return ALL_ROWS;
  int x0 = x * row->scale - row->around, x1 = (x + 1) * row->scale + row->around;
  if (x0 < 0) x0 = 0;
  if (x1 > row->reads->tiles_x) x1 = row->reads->tiles_x;
  if (row->lower[x1] - row->lower[x0] == row->upper[x1] - row->upper[x0]) return (tile_rows){0, 0};
  return hl_cascade_rows_of_tile(row, x);
}

#endif
