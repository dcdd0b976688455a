/* render/picture.c - see picture.h. */
#include "render/picture.h"

#include <string.h>

enum { COLORS = 4 }; /* R G B A */

/* Adds the values that one of the frame's pixels has in all sweeps. */
static void add_pixel(const picture *picture, int column, int row, float sum[COLORS]) {
  const float *from = picture->tiles + hl_place_in_tiles(picture->tiles_x, COLORS, column, row);
  for (int c = 0; c < COLORS; c++) sum[c] += from[c * BLOCK_PIXELS];
  for (int s = 1; s < picture->sweeps; s++)
    for (int c = 0; c < 3; c++)
      sum[c] += from[(size_t)s * picture->tiles_of_sweep * TILE_PIXELS * COLORS + (size_t)(c * BLOCK_PIXELS)];
}

static void write_row(void *data, size_t row, int worker) {
  (void)worker;
  const picture *picture = data;
  int side = picture->oversampling;
  for (int column = 0; column < picture->width; column++) {
    float sum[COLORS] = {0, 0, 0, 0}, *to = picture->pixels + row * picture->row_stride + 4 * (size_t)column;
    for (int y = 0; y < side; y++)
      for (int x = 0; x < side; x++) add_pixel(picture, column * side + x, (int)row * side + y, sum);
    for (int c = 0; c < COLORS; c++) to[c] = sum[c] / (float)(side * side);
  }
}

void hl_picture_write(const picture *picture, hl_pool *pool) {
  hl_pool_run(pool, (size_t)picture->height, write_row, (void *)picture);
}

typedef struct reorder_job {
  const picture *picture;
  float *rows;
} reorder_job;

/* Reorders one row of tiles into sixteen rows of pixels. */
static void reorder_row(void *data, size_t index, int worker) {
  const reorder_job *job = data;
  const picture *picture = job->picture;
  size_t floats = picture->tiles_x * TILE_PIXELS * COLORS;
  float *to = picture->pixels + index * floats, *tiles = job->rows + (size_t)worker * floats;
  memcpy(tiles, to, floats * sizeof *tiles);
  for (int row = 0; row < TILE; row++)
    for (int column = 0; column < picture->width; column += BLOCK, to += COLORS * BLOCK) {
      const float *from = tiles + hl_place_in_tiles(picture->tiles_x, COLORS, column, row);
      for (int pixel = 0; pixel < BLOCK; pixel++)
        for (int c = 0; c < COLORS; c++)
          to[COLORS * pixel + c] = 0 + from[c * BLOCK_PIXELS + pixel]; /* the sum with 0 turns -0 into 0 */
    }
}

void hl_picture_reorder(const picture *picture, float *rows, hl_pool *pool) {
  reorder_job job = {picture, rows};
  hl_pool_run(pool, (size_t)picture->height / TILE, reorder_row, &job);
}
