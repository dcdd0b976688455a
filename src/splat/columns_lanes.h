/* splat/columns_lanes.h - eight voxels of a row after another into their columns, less 128. */
#ifndef HL_SPLAT_COLUMNS_LANES_H
#define HL_SPLAT_COLUMNS_LANES_H

#include <string.h>

#include "splat/columns.h"

/* Rows that are no multiple of eight long are filled up with what nothing reads into a sum. */
static __attribute__((unused)) void column_slice(const unsigned char *rows, int32_t count_x, int32_t count_y,
                                                 unsigned char *columns, size_t column_bytes) {
  for (int32_t x = 0; x < count_x; x += GRID_COLUMN, columns += column_bytes) {
    int32_t width = count_x - x < GRID_COLUMN ? count_x - x : GRID_COLUMN;
    for (int32_t y = 0; y < count_y; y++) {
      const unsigned char *from = rows + (size_t)y * (size_t)count_x + (size_t)x;
      uint64_t voxels = 0;
      if (width == GRID_COLUMN) memcpy(&voxels, from, GRID_COLUMN);
      else memcpy(&voxels, from, (size_t)width);
      voxels ^= 0x8080808080808080u;
      memcpy(columns + (size_t)y * GRID_COLUMN, &voxels, GRID_COLUMN);
    }
  }
}

#endif
