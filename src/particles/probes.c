/* particles/probes.c - finds which particles reach a place, by cells of the lattice's levels.
 *
 * A particle of a level reaches about eight points of this level at most. Each level has cells of at least
 * four points a side, and each cell lists the places in it. A particle looks into the cells of its own level
 * that its kernel touches. Larger cells would be fewer, but most of their places would lie out of reach: with
 * sixteen points a side the sums took four times as long. The sums of parts of the particles are kept apart
 * and added in one order, so that they do not depend on threads. */
#include "particles/probes.h"

#include <math.h>

#include "core/memory.h"
#include "core/vector.h"
#include "particles/kernel.h"
#include "particles/levels.h"

enum { CELL = 4, PARTS = 64 };

/* The places of one level, cell by cell. */
typedef struct probe_cells {
  hl_particle_level grid;
  size_t cells[3];       /* the number of cells along each axis */
  hl_block_table filled; /* the cells in which places lie */
  uint32_t *begin;       /* owned; [filled.count + 1]; where the places of a cell begin in `listed` */
  uint32_t *listed;      /* owned; [count] */
} probe_cells;

typedef struct summing {
  const hl_particle_set *set;
  const float *weights;
  const hl_particle_plan *plan;
  const hl_particle_probes *probes;
  hl_pool *pool;
  probe_cells level[HL_PARTICLE_LEVELS];
  double *parts; /* owned; [PARTS][count] */
} summing;

hl_status hl_particle_probes_choose(hl_context *context, const hl_particle_set *set,
                                    const hl_particle_lattice *lattice, const char *subject,
                                    hl_particle_probes *probes, hl_error *error) {
  const hl_particle_level grid = hl_particle_level_of(set, lattice, 0);
  probes->count = set->count < HL_PARTICLE_PROBES ? set->count : HL_PARTICLE_PROBES;
  probes->place = hl_allocate(context, probes->count, sizeof *probes->place);
  probes->point = hl_allocate(context, probes->count, sizeof *probes->point);
  if (probes->place == NULL || probes->point == NULL)
    return hl_fail_memory(error, probes->count * sizeof *probes->point, subject);
  for (size_t q = 0; q < probes->count; q++) {
    const size_t n = (size_t)((double)set->count * ((double)q + 0.5) / (double)probes->count);
    for (int a = 0; a < 3; a++) {
      probes->place[q][a] = set->place[n][a];
      probes->point[q][a] = hl_particle_coordinate(set, &grid, n, a);
    }
  }
  return HL_OK;
}

void hl_particle_probes_release(hl_context *context, hl_particle_probes *probes) {
  hl_release(context, probes->place);
  hl_release(context, probes->point);
  *probes = (hl_particle_probes){.count = 0};
}

/* ---- cells ---- */

static int32_t cell_at(const probe_cells *cells, int axis, double coordinate) {
  const double side = (double)cells->grid.points[axis] / (double)cells->cells[axis];
  return (int32_t)floor(coordinate / side);
}

/* A cell along an axis, of the numbers 0 to cells - 1: along periodic axes, a cell beyond one end is the cell
 * at the other end. */
static int32_t wrapped(const probe_cells *cells, int axis, int32_t cell) {
  const int32_t count = (int32_t)cells->cells[axis];
  if (cells->grid.periodic[axis]) return (cell % count + count) % count;
  return cell < 0 ? 0 : cell >= count ? count - 1 : cell;
}

static hl_status list_places(hl_context *context, const summing *s, int level, probe_cells *cells,
                             const char *subject, hl_error *error) {
  const size_t count = s->probes->count;
  size_t number = 0;
  cells->grid = hl_particle_level_of(s->set, &s->plan->lattice, level);
  for (int a = 0; a < 3; a++)
    cells->cells[a] = cells->grid.points[a] > CELL ? cells->grid.points[a] / CELL : 1;
  uint32_t *cell_of = hl_allocate(context, count, sizeof *cell_of);
  cells->listed = hl_allocate(context, count, sizeof *cells->listed);
  hl_status status = cell_of != NULL && cells->listed != NULL
                         ? HL_OK
                         : hl_fail_memory(error, count * sizeof *cell_of, subject);
  for (size_t q = 0; status == HL_OK && q < count; q++) {
    int32_t cell[3];
    for (int a = 0; a < 3; a++)
      cell[a] = wrapped(cells, a, cell_at(cells, a, ldexp(s->probes->point[q][a], -level)));
    status = hl_block_add(context, &cells->filled, cell, subject, &number, error);
    cell_of[q] = (uint32_t)number;
  }
  cells->begin = hl_allocate_zeroed(context, cells->filled.count + 2, sizeof *cells->begin);
  if (status == HL_OK && cells->begin == NULL)
    status = hl_fail_memory(error, (cells->filled.count + 2) * sizeof *cells->begin, subject);
  if (status == HL_OK) {
    for (size_t q = 0; q < count; q++) cells->begin[cell_of[q] + 2]++;
    for (size_t c = 1; c < cells->filled.count + 2; c++) cells->begin[c] += cells->begin[c - 1];
    for (size_t q = 0; q < count; q++) cells->listed[cells->begin[cell_of[q] + 1]++] = (uint32_t)q;
  }
  hl_release(context, cell_of);
  return status;
}

static void release_cells(hl_context *context, probe_cells *cells) {
  hl_block_table_release(context, &cells->filled);
  hl_release(context, cells->begin);
  hl_release(context, cells->listed);
}

/* ---- sums ---- */

/* The squared distance of a particle and a place. Numbers of 32 bits wrap round as periods do. */
static double squared_distance(const hl_particle_set *set, size_t n, const uint32_t place[3]) {
  double sum = 0;
  for (int a = 0; a < 3; a++) {
    const double away = (int32_t)(set->place[n][a] - place[a]) * set->unit[a];
    sum += away * away;
  }
  return sum;
}

static void add_in_cell(const summing *s, const probe_cells *cells, ptrdiff_t cell, size_t n, double *sums) {
  const double h = (double)s->set->length[n], weight = s->weights != NULL ? (double)s->weights[n] : 1;
  for (uint32_t at = cells->begin[cell]; at < cells->begin[cell + 1]; at++) {
    const uint32_t q = cells->listed[at];
    const double squared = squared_distance(s->set, n, s->probes->place[q]);
    if (squared < 4 * h * h)
      sums[q] += weight * (double)hl_sph_kernel((float)(sqrt(squared) / h)) / (HL_PI * h * h * h);
  }
}

static void add_particle(const summing *s, size_t n, double *sums) {
  const probe_cells *cells = &s->level[s->plan->level_of[n]];
  const double reach = 2 * (double)s->set->length[n];
  int32_t first[3], count[3], cell[3];
  for (int a = 0; a < 3; a++) {
    const double at = hl_particle_coordinate(s->set, &cells->grid, n, a),
                 points = reach / cells->grid.spacing[a], most = (double)cells->cells[a];
    const double low = fmax(at - points, -2 * (double)cells->grid.points[a]),
                 high = fmin(at + points, 3 * (double)cells->grid.points[a]);
    first[a] = cell_at(cells, a, low);
    count[a] = (int32_t)fmin(cell_at(cells, a, high) - first[a] + 1, most);
    if (!cells->grid.periodic[a]) {
      const int32_t last = wrapped(cells, a, cell_at(cells, a, high));
      first[a] = wrapped(cells, a, first[a]);
      count[a] = last - first[a] + 1;
    }
  }
  for (int32_t k = 0; k < count[2]; k++)
    for (int32_t j = 0; j < count[1]; j++)
      for (int32_t i = 0; i < count[0]; i++) {
        const int32_t step[3] = {i, j, k};
        for (int a = 0; a < 3; a++) cell[a] = wrapped(cells, a, first[a] + step[a]);
        const ptrdiff_t number = hl_block_number(&cells->filled, cell);
        if (number >= 0) add_in_cell(s, cells, number, n, sums);
      }
}

static void add_part(void *data, size_t index, int worker) {
  const summing *s = data;
  const size_t begin = s->set->count * index / PARTS, end = s->set->count * (index + 1) / PARTS;
  for (size_t n = begin; n < end; n++) {
    if (n % 1024 == 0 && hl_pool_stops(s->pool, worker)) return;
    add_particle(s, n, s->parts + index * s->probes->count);
  }
}

hl_status hl_particle_probes_sum(hl_context *context, hl_pool *pool, const hl_particle_set *set,
                                 const float *weights, const hl_particle_plan *plan,
                                 const hl_particle_probes *probes, const char *subject, double *sums,
                                 hl_error *error) {
  summing s = {.set = set, .weights = weights, .plan = plan, .probes = probes, .pool = pool};
  const size_t count = probes->count;
  s.parts = hl_allocate_zeroed(context, PARTS * count, sizeof *s.parts);
  hl_status status = s.parts != NULL ? HL_OK
                                     : hl_fail_memory(error, PARTS * count * sizeof *s.parts, subject);
  for (int level = 0; status == HL_OK && level < plan->lattice.levels; level++)
    status = list_places(context, &s, level, &s.level[level], subject, error);
  if (status == HL_OK) {
    hl_pool_run(pool, PARTS, add_part, &s);
    for (size_t q = 0; q < count; q++) {
      sums[q] = 0;
      for (size_t part = 0; part < PARTS; part++) sums[q] += s.parts[part * count + q];
    }
    if (hl_pool_cancelled(pool)) status = hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", subject);
  }
  for (int level = 0; level < plan->lattice.levels; level++) release_cells(context, &s.level[level]);
  hl_release(context, s.parts);
  return status;
}
