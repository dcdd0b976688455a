/* shadow_cascade/cascade_reads.c - finds the tiles of a cascade's buffer that the next sheets read. */
#include "shadow_cascade/cascade_reads.h"

#include <string.h>

/* Writes 1 for each tile that is read. The entry of a tile lies one row and one column farther than the tile,
 * because a summed-area table begins with a row and a column of zeros. */
static void mark_tiles(cascade_reads *reads, const occupancy *occupancy, const int32_t *needed_until,
                       int first_sheet, int last_sheet) {
  size_t width = (size_t)reads->tiles_x, words = (size_t)occupancy->tile_words;
  memset(reads->before, 0, (width + 1) * ((size_t)reads->tiles_y + 1) * sizeof *reads->before);
  for (size_t word = 0; word < words; word++) {
    uint64_t bits = 0;
    for (int sheet = first_sheet; sheet <= last_sheet; sheet++)
      bits |= occupancy->by_sheet[(size_t)sheet * words + word];
    for (; bits != 0; bits &= bits - 1) {
      size_t tile = word * 64 + (size_t)__builtin_ctzll(bits);
      bool needed = needed_until == NULL || needed_until[tile] >= first_sheet;
      reads->before[(tile / width + 1) * (width + 1) + tile % width + 1] = needed;
    }
  }
}

void hl_cascade_reads_find(cascade_reads *reads, const occupancy *occupancy, const int32_t *needed_until,
                           int first_sheet, int last_sheet) {
  mark_tiles(reads, occupancy, needed_until, first_sheet, last_sheet);
  size_t stride = (size_t)reads->tiles_x + 1;
  for (int y = 1; y <= reads->tiles_y; y++) {
    uint32_t *row = reads->before + (size_t)y * stride, sum = 0;
    const uint32_t *above = row - stride;
    for (size_t x = 1; x < stride; x++) {
      sum += row[x];
      row[x] = above[x] + sum;
    }
  }
}

/* Finds the rows of tiles that contain any row of the buffer's pixels from `top` to `bottom`, both
 * included. */
static read_band band_of(const cascade_reads *reads, int top, int bottom) {
  int y0 = top < 0 ? 0 : top / TILE, y1 = bottom < reads->tiles_y * TILE ? bottom / TILE + 1 : reads->tiles_y;
  if (y0 > y1) y0 = y1;
  size_t stride = (size_t)reads->tiles_x + 1;
  return (read_band){reads->before + (size_t)y0 * stride, reads->before + (size_t)y1 * stride};
}

read_row hl_cascade_read_row(const cascade_reads *reads, int scale, int y, int reach) {
  read_row row = {.scale = scale, .reach = reach, .tiles_x = reads->tiles_x, .any = true};
  if (reach == READ_EVERYWHERE) return row;
  int top = y * TILE * scale - reach, step = BLOCK * scale;
  row.around = (reach + TILE - 1) / TILE;
  row.all = band_of(reads, top, top + TILE * scale - 1 + 2 * reach);
  row.any = row.all.lower[reads->tiles_x] != row.all.upper[reads->tiles_x];
  if (!row.any) return row;
  for (int i = 0; i < TILE / BLOCK; i++)
    row.blocks[i] = band_of(reads, top + i * step, top + (i + 1) * step - 1 + 2 * reach);
  return row;
}
