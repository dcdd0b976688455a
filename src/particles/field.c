/* particles/field.c - copies boxes of points out of a level's blocks, and adds boxes to them. Makes an array
 * of all points, or bricks, from a finished field.
 *
 * In: coefficients of all levels. Out: voxels or hl_bricks. */
#include "core/memory.h"
#include "particles/levels.h"

/* ---- pieces of boxes ---- */

static hl_particle_run run_at(size_t points, bool periodic, ptrdiff_t at, ptrdiff_t end) {
  ptrdiff_t n = (ptrdiff_t)points, point = periodic ? (at % n + n) % n : at < 0 ? 0 : at >= n ? n - 1 : at;
  ptrdiff_t within = point & (HL_PARTICLE_BLOCK - 1), count = HL_PARTICLE_BLOCK - within;
  bool beyond = !periodic && point != at;
  count = count < n - point ? count : n - point;
  count = count < end - at ? count : end - at;
  return (hl_particle_run){.block = (int32_t)(point >> HL_PARTICLE_BLOCK_SHIFT),
                           .within = (size_t)within,
                           .count = beyond ? 1 : (size_t)count};
}

void hl_particle_visit(const hl_particle_lattice *lattice, int level, const ptrdiff_t first[3],
                       const size_t count[3],
                       void (*visit)(void *data, const int32_t block[3], const hl_particle_run run[3]),
                       void *data) {
  hl_particle_run run[3];
  size_t points[3];
  for (int a = 0; a < 3; a++) points[a] = hl_particle_points(lattice, level, a);
  for (size_t z = 0; z < count[2]; z += run[2].count) {
    run[2] = run_at(points[2], lattice->periodic[2], first[2] + (ptrdiff_t)z, first[2] + (ptrdiff_t)count[2]);
    run[2].from = z;
    for (size_t y = 0; y < count[1]; y += run[1].count) {
      run[1] = run_at(points[1], lattice->periodic[1], first[1] + (ptrdiff_t)y,
                      first[1] + (ptrdiff_t)count[1]);
      run[1].from = y;
      for (size_t x = 0; x < count[0]; x += run[0].count) {
        run[0] = run_at(points[0], lattice->periodic[0], first[0] + (ptrdiff_t)x,
                        first[0] + (ptrdiff_t)count[0]);
        run[0].from = x;
        visit(data, (const int32_t[3]){run[0].block, run[1].block, run[2].block}, run);
      }
    }
  }
}

/* A box that is read or added. */
typedef struct box_job {
  const hl_particle_field *field;
  int level;
  const size_t *count;
  float *out;       /* read: the box */
  const float *box; /* added: the box */
} box_job;

static size_t row_in_block(const hl_particle_run run[3], size_t y, size_t z) {
  return ((run[2].within + z) * HL_PARTICLE_BLOCK + run[1].within + y) * HL_PARTICLE_BLOCK + run[0].within;
}

static size_t row_in_box(const box_job *job, const hl_particle_run run[3], size_t y, size_t z) {
  return ((run[2].from + z) * job->count[1] + run[1].from + y) * job->count[0] + run[0].from;
}

static void read_piece(void *data, const int32_t block[3], const hl_particle_run run[3]) {
  const box_job *job = data;
  ptrdiff_t number = hl_block_number(&job->field->plan->blocks[job->level], block);
  for (size_t z = 0; z < run[2].count; z++)
    for (size_t y = 0; y < run[1].count; y++) {
      float *row = job->out + row_in_box(job, run, y, z);
      const float *from = number < 0
                              ? NULL
                              : job->field->points[job->level] + (size_t)number * HL_PARTICLE_BLOCK_POINTS +
                                    row_in_block(run, y, z);
      for (size_t x = 0; x < run[0].count; x++) row[x] = from != NULL ? from[x] : job->field->outside;
    }
}

void hl_particle_field_read(const hl_particle_field *field, int level, const ptrdiff_t first[3],
                            const size_t count[3], float *out) {
  box_job job = {.field = field, .level = level, .count = count, .out = out};
  hl_particle_visit(&field->plan->lattice, level, first, count, read_piece, &job);
}

static void add_piece(void *data, const int32_t block[3], const hl_particle_run run[3]) {
  const box_job *job = data;
  ptrdiff_t number = hl_block_number(&job->field->plan->blocks[job->level], block);
  if (number < 0) return;
  float *points = job->field->points[job->level] + (size_t)number * HL_PARTICLE_BLOCK_POINTS;
  for (size_t z = 0; z < run[2].count; z++)
    for (size_t y = 0; y < run[1].count; y++) {
      float *row = points + row_in_block(run, y, z);
      const float *from = job->box + row_in_box(job, run, y, z);
      for (size_t x = 0; x < run[0].count; x++) row[x] += from[x];
    }
}

void hl_particle_field_add(hl_particle_field *field, int level, const ptrdiff_t first[3],
                           const size_t count[3], const float *box) {
  box_job job = {.field = field, .level = level, .count = count, .box = box};
  hl_particle_visit(&field->plan->lattice, level, first, count, add_piece, &job);
}

void hl_particle_field_release(hl_context *context, hl_particle_field *field) {
  for (int level = 0; level < HL_PARTICLE_LEVELS; level++) hl_release(context, field->points[level]);
  *field = (hl_particle_field){.plan = NULL};
}

/* ---- an array of all points ---- */

typedef struct copying {
  const hl_particle_field *field;
  float *voxels;
} copying;

static void copy_slices(void *data, size_t index, int worker) {
  const copying *c = data;
  const size_t *cells = c->field->plan->lattice.cells, slice = (cells[0] + 1) * (cells[1] + 1);
  size_t z = index * HL_PARTICLE_BLOCK, left = cells[2] + 1 - z;
  const ptrdiff_t first[3] = {0, 0, (ptrdiff_t)z};
  const size_t count[3] = {cells[0] + 1, cells[1] + 1, left < HL_PARTICLE_BLOCK ? left : HL_PARTICLE_BLOCK};
  (void)worker;
  hl_particle_field_read(c->field, 0, first, count, c->voxels + z * slice);
}

void hl_particle_field_copy(const hl_particle_field *field, hl_pool *pool, float *voxels) {
  copying c = {field, voxels};
  hl_pool_run(pool, field->plan->lattice.cells[2] / HL_PARTICLE_BLOCK + 1, copy_slices, &c);
}

/* ---- bricks ---- */

static void fill(void *data, int level, const ptrdiff_t first[3], const size_t count[3], float *out) {
  hl_particle_field_read(data, level, first, count, out);
}

hl_status hl_particle_field_bricks(hl_context *context, hl_pool *pool, const hl_particle_field *field,
                                   const char *subject, hl_bricks *bricks, hl_error *error) {
  const hl_particle_plan *plan = field->plan;
  hl_particle_field borrowed = *field;
  const hl_bricks_source source = {
      .shift = HL_PARTICLE_BLOCK_SHIFT,
      .levels = plan->lattice.levels,
      .dimension = {plan->lattice.cells[0] + 1, plan->lattice.cells[1] + 1, plan->lattice.cells[2] + 1},
      .outside = field->outside,
      .fill = fill,
      .data = &borrowed};
  return hl_bricks_build(context, pool, &source, plan->leaves, plan->leaf_count, subject, bricks, error);
}
