/* splat/cell_marks.c - which cells show something and what is near them, once a transfer function. */
#include <string.h>

#include "splat/cell_bounds.h"

/* ---- which cells show something ---- */

typedef struct mark_job {
  grid *grid;
  uint16_t least_high[256]; /* of a lower bound: the least upper bound that shows something; 256: none */
} mark_job;

static void find_least_high(const classifier *classifier, const grid *grid, uint16_t least_high[256]) {
  for (int low = 255; low >= 0; low--) {
    int high = low;
    while (high < 256 &&
           !hl_classifier_span_visible(classifier, grid, grid->cell_base + (float)low * grid->cell_step,
                                       grid->cell_base + (float)high * grid->cell_step))
      high++;
    least_high[low] = (uint16_t)high;
  }
}

/* The bytes of a row of bricks. */
static size_t packed_row_bytes(const grid *grid, const unsigned char *even) {
  size_t count = (size_t)grid->brick_count[0], alike = 0;
  for (size_t i = 0; i < hl_even_row_bytes(grid); i++) alike += (size_t)__builtin_popcount(even[i]);
  return alike * EVEN_BYTES + (count - alike) * UNEVEN_BYTES;
}

/* Writes 1 where one of a brick's cells shows something; returns whether any does. */
static unsigned char mark_brick(const mark_job *job, const int32_t brick[3], const unsigned char *bounds,
                                bool even) {
  const cell_level *level = &job->grid->level[0];
  unsigned char any = 0;
  if (even && bounds[1] < job->least_high[bounds[0]]) return 0;
  for (int32_t cell = 0; cell < BRICK_CELLS; cell++) {
    int32_t x = 2 * brick[0] + cell % 2, y = 2 * brick[1] + cell / 2 % 2, z = 2 * brick[2] + cell / 4;
    bool shows = even || bounds[BRICK_CELLS + cell] >= job->least_high[bounds[cell]];
    if (!shows || x >= level->count[0] || y >= level->count[1] || z >= level->count[2]) continue;
    level->near[((size_t)z * (size_t)level->count[1] + (size_t)y) * (size_t)level->count[0] + (size_t)x] =
        any = 1;
  }
  return any;
}

static void mark_layer(void *data, size_t layer, int worker) {
  (void)worker;
  const mark_job *job = data;
  const grid *grid = job->grid;
  const cell_level *fine = &grid->level[0], *coarse = &grid->level[1];
  size_t plane = (size_t)fine->count[0] * (size_t)fine->count[1], width = (size_t)grid->brick_count[0];
  int32_t slices = fine->count[2] - 2 * (int32_t)layer < 2 ? 1 : 2;
  memset(fine->near + 2 * layer * plane, 0, (size_t)slices * plane);
  memset(coarse->near + layer * width * (size_t)grid->brick_count[1], 0,
         width * (size_t)grid->brick_count[1]);
  const unsigned char *even = grid->cell_bounds[layer];
  const unsigned char *bounds = even + hl_even_row_bytes(grid) * (size_t)grid->brick_count[1];
  for (int32_t y = 0; y < grid->brick_count[1]; y++, even += hl_even_row_bytes(grid)) {
    size_t row = (layer * (size_t)grid->brick_count[1] + (size_t)y) * width;
    if (memchr(grid->relevant + row, 1, width) == NULL) {
      bounds += packed_row_bytes(grid, even);
      continue;
    }
    for (int32_t x = 0; x < grid->brick_count[0]; x++) {
      bool same = hl_brick_is_even(even, x);
      if (grid->relevant[row + (size_t)x])
        coarse->near[row + (size_t)x] = mark_brick(job, (int32_t[3]){x, y, (int32_t)layer}, bounds, same);
      bounds += same ? EVEN_BYTES : UNEVEN_BYTES;
    }
  }
}

void hl_cells_mark_visible(grid *grid, const classifier *classifier, hl_pool *pool) {
  if (grid->level[0].near == NULL) return;
  mark_job job = {.grid = grid};
  find_least_high(classifier, grid, job.least_high);
  hl_pool_run(pool, (size_t)grid->brick_count[2], mark_layer, &job);
}

/* ---- which cells are near those ---- */

/* The bits of boxes three cells long along x, y, z (cell_level). */
enum { THREE_ALONG_X = 0xaa, THREE_ALONG_Y = 0xcc, THREE_ALONG_Z = 0xf0 };

/* A row's look-ups along x, in place of what is visible in it. */
static void mark_row(unsigned char *cells, size_t width) {
  for (size_t x = 0; x + 2 < width; x++)
    cells[x] = (unsigned char)(-(cells[x] | cells[x + 1]) | (-cells[x + 2] & THREE_ALONG_X));
  for (size_t x = width < 2 ? 0 : width - 2; x < width; x++)
    cells[x] = (unsigned char)-(cells[x] | cells[width - 1]);
}

/* The look-ups along y or z, in place, from the first cell on. step: from a cell to the next along the axis;
 * there are `width` cells side by side. three: the bits of boxes three cells long along it. */
static void join_axis(unsigned char *cells, size_t step, int32_t count, size_t width, unsigned char three) {
  for (int32_t i = 0; i + 2 < count; i++) {
    unsigned char *cell = cells + (size_t)i * step;
    for (size_t x = 0; x < width; x++)
      cell[x] |= (unsigned char)(cell[x + step] | (cell[x + 2 * step] & three));
  }
  if (count < 2) return;
  unsigned char *cell = cells + (size_t)(count - 2) * step;
  for (size_t x = 0; x < width; x++) cell[x] |= cell[x + step];
}

/* A slice's look-ups along x and y. */
static void mark_slice(void *data, size_t index, int worker) {
  (void)worker;
  const cell_level *level = data;
  size_t width = (size_t)level->count[0];
  unsigned char *near = level->near + index * width * (size_t)level->count[1];
  for (int32_t y = 0; y < level->count[1]; y++) mark_row(near + (size_t)y * width, width);
  join_axis(near, width, level->count[1], width, THREE_ALONG_Y);
}

/* A row's look-ups along z, in all slices. */
static void mark_across(void *data, size_t index, int worker) {
  (void)worker;
  const cell_level *level = data;
  size_t width = (size_t)level->count[0];
  join_axis(level->near + index * width, width * (size_t)level->count[1], level->count[2], width,
            THREE_ALONG_Z);
}

void hl_cells_mark_near(grid *grid, hl_pool *pool) {
  if (grid->level[0].near == NULL) return;
  for (int i = 0; i < CELL_LEVELS; i++) {
    hl_pool_run(pool, (size_t)grid->level[i].count[2], mark_slice, &grid->level[i]);
    hl_pool_run(pool, (size_t)grid->level[i].count[1], mark_across, &grid->level[i]);
  }
}
