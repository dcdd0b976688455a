/* field/open_light.c - see open_light.h. */
#include "field/open_light.h"

#include "core/sheet_constants.h"

/* The cells of a field that is not stored yet. */
typedef struct open_cells {
  float *field;   /* the first float of the first cell */
  size_t step[3]; /* numbers of floats from one cell to the next along x, y and z */
  int32_t count[3];
  size_t harmonics; /* number of a cell's floats that are light; the cell's transmittance follows them */
} open_cells;

/* Returns whether a cell holds no matter: its stored transmittance is 1. */
static bool is_open(float passing) { return passing * SKY_MOST + 0.5f >= SKY_MOST; }

/* Adds up the light of the open cells among the 26 cells around a cell. Returns their number. */
static int add_open_neighbours(const open_cells *cells, const int32_t at[3], float *sum) {
  int count = 0;
  for (int n = 0; n < 27; n++) {
    const int by[3] = {n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
    const float *neighbour = cells->field;
    bool within = true;
    for (int a = 0; a < 3; a++) {
      const int32_t place = at[a] + by[a];
      within = within && place >= 0 && place < cells->count[a];
      neighbour += (ptrdiff_t)place * (ptrdiff_t)cells->step[a];
    }
    if (!within || !is_open(neighbour[cells->harmonics])) continue;
    for (size_t i = 0; i < cells->harmonics; i++) sum[i] += neighbour[i];
    count++;
  }
  return count;
}

static void light_row(void *data, size_t row, int worker) {
  const open_cells *cells = data;
  int32_t at[3] = {0, (int32_t)(row % (size_t)cells->count[1]), (int32_t)(row / (size_t)cells->count[1])};
  float *cell = cells->field + (size_t)at[1] * cells->step[1] + (size_t)at[2] * cells->step[2];
  (void)worker;
  for (; at[0] < cells->count[0]; at[0]++, cell += cells->step[0]) {
    const float passing = cell[cells->harmonics];
    float sum[3 * FIELD_HARMONICS] = {0};
    if (is_open(passing)) continue;
    const int count = add_open_neighbours(cells, at, sum);
    if (count == 0) continue;
    const float own = passing * passing;
    for (size_t i = 0; i < cells->harmonics; i++) cell[i] = own * cell[i] + (1 - own) / (float)count * sum[i];
  }
}

void hl_open_light_spread(const field_lattice *lattice, int channels, float *field, const size_t step[3],
                          hl_pool *pool) {
  open_cells cells = {.field = field, .harmonics = FIELD_HARMONICS * (size_t)channels};
  for (int a = 0; a < 3; a++) cells.count[a] = lattice->count[a], cells.step[a] = step[a];
  hl_pool_run(pool, (size_t)cells.count[1] * (size_t)cells.count[2], light_row, &cells);
}
