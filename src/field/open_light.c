/* field/open_light.c - see open_light.h. */
#include "field/open_light.h"

#include "core/sheet_constants.h"

enum { NEIGHBOURS = 26 };

/* The cells of a field that is not stored yet. */
typedef struct open_cells {
  float *field;   /* the first float of the first cell */
  size_t step[3]; /* numbers of floats from one cell to the next along x, y and z */
  int32_t count[3];
  size_t harmonics; /* number of a cell's floats that are light; the cell's transmittance follows them */
  ptrdiff_t to_neighbour[NEIGHBOURS]; /* numbers of floats from a cell to the cells around it */
} open_cells;

/* Returns whether a cell holds no matter: its stored transmittance is 1. */
static bool is_open(float passing) { return passing * SKY_MOST + 0.5f >= SKY_MOST; }

/* Returns whether light crosses no part of a cell: its stored transmittance is 0. */
static bool is_full(float passing) { return passing * SKY_MOST + 0.5f < 1; }

/* Adds up the light of the open cells among the 26 cells around a cell. Returns their number. */
static int add_open_neighbours(const open_cells *cells, const float *cell, float *sum) {
  int count = 0;
  for (int n = 0; n < NEIGHBOURS; n++) {
    const float *neighbour = cell + cells->to_neighbour[n];
    if (!is_open(neighbour[cells->harmonics])) continue;
    for (size_t i = 0; i < cells->harmonics; i++) sum[i] += neighbour[i];
    count++;
  }
  return count;
}

/* Lights the cells of a row along x that are neither open nor full. Look-ups hardly count full cells. */
static void light_row(void *data, size_t row, int worker) {
  const open_cells *cells = data;
  const size_t y = 1 + row % (size_t)(cells->count[1] - 2), z = 1 + row / (size_t)(cells->count[1] - 2);
  float *cell = cells->field + y * cells->step[1] + z * cells->step[2];
  (void)worker;
  for (int32_t x = 1; x < cells->count[0] - 1; x++) {
    cell += cells->step[0];
    const float passing = cell[cells->harmonics];
    if (is_open(passing) || is_full(passing)) continue;
    float sum[3 * FIELD_HARMONICS] = {0};
    const int count = add_open_neighbours(cells, cell, sum);
    if (count == 0) continue;
    const float own = passing * passing, others = (1 - own) / (float)count;
    for (size_t i = 0; i < cells->harmonics; i++) cell[i] = own * cell[i] + others * sum[i];
  }
}

void hl_open_light_spread(const field_lattice *lattice, int channels, float *field, const size_t step[3],
                          hl_pool *pool) {
  open_cells cells = {.field = field, .harmonics = FIELD_HARMONICS * (size_t)channels};
  for (int a = 0; a < 3; a++) cells.count[a] = lattice->count[a], cells.step[a] = step[a];
  for (int n = 0, at = 0; at < 27; at++) {
    const ptrdiff_t by[3] = {at % 3 - 1, at / 3 % 3 - 1, at / 9 - 1};
    if (at == 13) continue; /* the cell itself */
    cells.to_neighbour[n++] = by[0] * (ptrdiff_t)step[0] + by[1] * (ptrdiff_t)step[1] +
                              by[2] * (ptrdiff_t)step[2];
  }
  /* a lattice's margin is wider than a cell, so that its outermost cells hold no matter */
  hl_pool_run(pool, (size_t)(cells.count[1] - 2) * (size_t)(cells.count[2] - 2), light_row, &cells);
}
