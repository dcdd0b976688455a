/* particles/spread.c - spreads particles over all levels of a lattice, and adds the levels up.
 *
 * In: particles, weights and a lattice. Out: coefficients of the finest level. */
#include "particles/particles.h"

#include <math.h>
#include <string.h>

#include "core/context.h"
#include "core/memory.h"

/* The coarsest level whose spacing is at most half of the smoothing length. */
static void choose_levels(const hl_particle_set *set, const hl_particle_lattice *lattice, uint8_t *level_of) {
  double least = fmin(fmin(lattice->spacing[0], lattice->spacing[1]), lattice->spacing[2]);
  for (size_t n = 0; n < set->count; n++) {
    int level = 0;
    while (level + 1 < lattice->levels && (double)set->length[n] >= 2 * ldexp(least, level + 1)) level++;
    level_of[n] = (uint8_t)level;
  }
}

static hl_status begin_level(hl_context *context, hl_pool *pool, const hl_particle_lattice *lattice,
                             int level, const char *subject, hl_particle_level *grid, hl_error *error) {
  size_t count = 1;
  for (int a = 0; a < 3; a++) {
    grid->points[a] = hl_lattice_points(lattice, level, a);
    grid->periodic[a] = lattice->periodic[a];
    grid->spacing[a] = ldexp(lattice->spacing[a], level);
    grid->low[a] = lattice->low[a];
    count *= grid->points[a];
  }
  grid->field = hl_allocate(context, count, sizeof *grid->field);
  if (grid->field == NULL) return hl_fail_memory(error, count * sizeof *grid->field, subject);
  hl_pool_clear(pool, grid->field, count * sizeof *grid->field);
  return HL_OK;
}

hl_status hl_particles_spread(hl_context *context, hl_pool *pool, const hl_particle_set *set,
                              const float *weights, const hl_particle_lattice *lattice, const char *subject,
                              float **field, hl_error *error) {
  hl_particle_level coarse = {.field = NULL}, grid = {.field = NULL};
  *field = NULL;
  uint8_t *level_of = hl_allocate(context, set->count, sizeof *level_of);
  if (level_of == NULL) return hl_fail_memory(error, set->count, subject);
  choose_levels(set, lattice, level_of);
  hl_status status = HL_OK;
  for (int level = lattice->levels - 1; level >= 0 && status == HL_OK; level--) {
    status = begin_level(context, pool, lattice, level, subject, &grid, error);
    if (status == HL_OK && coarse.field != NULL)
      status = hl_particles_subdivide(context, pool, &coarse, &grid, subject, error);
    hl_release(context, coarse.field);
    coarse = (hl_particle_level){.field = NULL};
    if (status == HL_OK)
      status = hl_particles_splat(context, pool, set, weights, level_of, level, &grid, subject, error);
    hl_progress(context, "load", 1.0 / (1 + level));
    coarse = grid;
    grid.field = NULL;
  }
  hl_release(context, level_of);
  if (status == HL_OK) *field = coarse.field;
  else hl_release(context, coarse.field);
  return status;
}
