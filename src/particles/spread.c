/* particles/spread.c - spreads particles over all levels of a lattice, and adds the levels up.
 *
 * In: particles, weights and a plan. Out: coefficients of all levels: c[l] = S c[l + 1] + p[l]. */
#include <string.h>

#include "bricks/subdivide.h"
#include "core/context.h"
#include "core/memory.h"
#include "particles/levels.h"

enum {
  COARSE_MOST = (HL_PARTICLE_BLOCK / 2 + 2) * (HL_PARTICLE_BLOCK / 2 + 2) * (HL_PARTICLE_BLOCK / 2 + 2)
};

typedef struct subdividing {
  hl_particle_field *field;
  int level;      /* the level that is filled */
  float *scratch; /* owned; [threads][scratch_floats] */
  size_t scratch_floats;
} subdividing;

/* Fills a block by subdividing the coefficients of the next coarser level. */
static void subdivide_block(void *data, size_t index, int worker) {
  const subdividing *s = data;
  const hl_lattice_box box = hl_particle_block_box(s->field->plan->blocks[s->level].place[index]),
                       coarse = hl_subdivision_source(&box);
  float *block = s->field->points[s->level] + index * HL_PARTICLE_BLOCK_POINTS,
        *from = s->scratch + (size_t)worker * s->scratch_floats;
  hl_particle_field_read(s->field, s->level + 1, coarse.first, coarse.count, from);
  hl_subdivide(&box, from, from + COARSE_MOST, block);
}

static hl_status begin_level(hl_context *context, hl_pool *pool, hl_particle_field *field, int level,
                             const char *subject, hl_error *error) {
  size_t floats = hl_particle_field_floats(field, level);
  field->points[level] = hl_allocate(context, floats, sizeof(float));
  if (field->points[level] == NULL) return hl_fail_memory(error, floats * sizeof(float), subject);
  if (level + 1 == field->plan->lattice.levels) {
    hl_pool_clear(pool, field->points[level], floats * sizeof(float));
    return HL_OK;
  }
  subdividing s = {.field = field, .level = level};
  const hl_lattice_box box = hl_particle_block_box((const int32_t[3]){0, 0, 0});
  s.scratch_floats = COARSE_MOST + hl_subdivision_scratch(&box);
  size_t scratch = (size_t)hl_pool_threads(pool) * s.scratch_floats;
  s.scratch = hl_allocate(context, scratch, sizeof(float));
  if (s.scratch == NULL) return hl_fail_memory(error, scratch * sizeof(float), subject);
  hl_pool_run(pool, field->plan->blocks[level].count, subdivide_block, &s);
  hl_release(context, s.scratch);
  return hl_pool_cancelled(pool) ? hl_fail(error, HL_ERROR_CANCELLED, "%s: stopped", subject) : HL_OK;
}

hl_status hl_particles_spread(hl_context *context, hl_pool *pool, const hl_particle_set *set,
                              const float *weights, const hl_particle_plan *plan, const char *subject,
                              hl_particle_field *field, hl_error *error) {
  hl_status status = HL_OK;
  *field = (hl_particle_field){.plan = plan};
  for (int level = plan->lattice.levels - 1; level >= 0 && status == HL_OK; level--) {
    status = begin_level(context, pool, field, level, subject, error);
    if (status == HL_OK)
      status = hl_particles_splat(context, pool, set, weights, field, level, subject, error);
    hl_progress(context, "load", 1.0 / (1 + level));
  }
  return status;
}
