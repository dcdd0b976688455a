/* particles/plan.c - finds the blocks of points that particles need, and the bricks of their field.
 *
 * In: particles and a lattice. Out: an hl_particle_plan.
 *
 * A kernel marks the blocks of cells of its level on which its points have an influence: a coefficient i
 * reaches the cells i - 2 .. i + 1. Bricks are found by a descent from the coarsest blocks. A block in which
 * a finer block is marked is split. Any other block becomes a brick if it is marked, or lies in a marked
 * coarser block. Therefore each kernel lies completely in bricks of its own level or of finer levels. */
#include <string.h>

#include "bricks/subdivide.h"
#include "core/context.h"
#include "core/memory.h"
#include "particles/levels.h"

typedef struct planning {
  hl_context *context;
  hl_particle_plan *plan;
  const char *subject;
  hl_error *error;
  hl_status status;
  hl_block_table marked[HL_PARTICLE_LEVELS]; /* blocks of cells that kernels of the level reach */
  hl_block_table finer[HL_PARTICLE_LEVELS];  /* blocks of cells that contain a marked block of a finer
                                              * level */
  bool all;                                  /* whether all blocks are needed; then none is marked */
  int level;                                 /* level of the box of points that is being visited */
} planning;

/* ---- marks ---- */

/* The coarsest level whose spacing is at most half of the smoothing length. */
static void choose_levels(const hl_particle_set *set, const hl_particle_lattice *lattice, uint8_t *level_of) {
  double least = fmin(fmin(lattice->spacing[0], lattice->spacing[1]), lattice->spacing[2]);
  for (size_t n = 0; n < set->count; n++) {
    int level = 0;
    while (level + 1 < lattice->levels && (double)set->length[n] >= 2 * ldexp(least, level + 1)) level++;
    level_of[n] = (uint8_t)level;
  }
}

/* The blocks along one axis that a kernel marks. There may be two ranges, because along a periodic axis a
 * kernel can wrap around the end of the period. */
typedef struct marks_of_axis {
  int low[3], high[3]; /* first and last block of each range */
  int count;
} marks_of_axis;

/* The number of cells of a level along an axis that the directory of bricks holds. */
static int directory_cells(const hl_particle_lattice *lattice, int level, int axis) {
  return (int)(((lattice->cells[axis] >> (HL_PARTICLE_BLOCK_SHIFT + level)) + 1) << HL_PARTICLE_BLOCK_SHIFT);
}

static marks_of_axis marks_along(const hl_particle_lattice *lattice, const hl_particle_level *grid, int level,
                                 int axis, const int range[2]) {
  const int end = directory_cells(lattice, level, axis), n = (int)grid->points[axis];
  marks_of_axis marks = {.count = 0};
  for (int image = -1; image <= 1; image++) {
    int low = range[0] - 2 + image * n, high = range[1] + 1 + image * n;
    if (image != 0 && !grid->periodic[axis]) continue;
    /* Beyond the face, the values at the face are repeated. */
    if (!grid->periodic[axis] && range[1] == n - 1) high = end - 1;
    if (high < 0 || low >= end) continue;
    marks.low[marks.count] = (low < 0 ? 0 : low) >> HL_PARTICLE_BLOCK_SHIFT;
    marks.high[marks.count++] = (high < end ? high : end - 1) >> HL_PARTICLE_BLOCK_SHIFT;
  }
  return marks;
}

static void add_block(planning *p, hl_block_table *table, const int32_t place[3]) {
  if (p->status == HL_OK) p->status = hl_block_add(p->context, table, place, p->subject, NULL, p->error);
}

static void mark_blocks(planning *p, int level, const marks_of_axis axis[3]) {
  int32_t at[3];
  for (int z = 0; z < axis[2].count; z++)
    for (int y = 0; y < axis[1].count; y++)
      for (int x = 0; x < axis[0].count; x++)
        for (at[2] = axis[2].low[z]; at[2] <= axis[2].high[z]; at[2]++)
          for (at[1] = axis[1].low[y]; at[1] <= axis[1].high[y]; at[1]++)
            for (at[0] = axis[0].low[x]; at[0] <= axis[0].high[x]; at[0]++)
              add_block(p, &p->marked[level], at);
}

/* Marks the blocks of all particles. Particles that follow each other in the set mostly mark the same blocks.
 * The last marks of each level are therefore remembered, and equal ones are not made again. */
static void mark_particles(planning *p, const hl_particle_set *set) {
  const hl_particle_lattice *lattice = &p->plan->lattice;
  hl_particle_level grid[HL_PARTICLE_LEVELS];
  marks_of_axis last[HL_PARTICLE_LEVELS][3];
  memset(last, 0, sizeof last);
  for (int level = 0; level < lattice->levels; level++)
    grid[level] = hl_particle_level_of(set, lattice, level);
  for (size_t n = 0; n < set->count && p->status == HL_OK; n++) {
    int level = p->plan->level_of[n];
    double narrowed = hl_particle_narrowed(set, &grid[level], n);
    marks_of_axis marks[3];
    memset(marks, 0, sizeof marks);
    for (int a = 0; a < 3; a++) {
      int range[2];
      hl_particle_range(&grid[level], a, hl_particle_coordinate(set, &grid[level], n, a), narrowed, range);
      marks[a] = marks_along(lattice, &grid[level], level, a, range);
    }
    if (memcmp(marks, last[level], sizeof marks) == 0) continue;
    memcpy(last[level], marks, sizeof marks);
    mark_blocks(p, level, marks);
  }
}

static void mark_coarser(planning *p) {
  for (int level = 0; level + 1 < p->plan->lattice.levels; level++)
    for (int from = 0; from < 2; from++) {
      const hl_block_table *table = from == 0 ? &p->marked[level] : &p->finer[level];
      for (size_t n = 0; n < table->count; n++) {
        const int32_t *at = table->place[n];
        add_block(p, &p->finer[level + 1], (const int32_t[3]){at[0] / 2, at[1] / 2, at[2] / 2});
      }
    }
}

/* Returns whether a kernel of this level or of a coarser level reaches a block. */
static bool is_reached(const planning *p, int level, const int32_t block[3]) {
  if (p->all) return true;
  for (int coarser = level; coarser < p->plan->lattice.levels; coarser++) {
    const int by = coarser - level;
    if (hl_block_number(&p->marked[coarser],
                        (const int32_t[3]){block[0] >> by, block[1] >> by, block[2] >> by}) >= 0)
      return true;
  }
  return false;
}

/* ---- blocks of points ---- */

/* Adds the blocks of a box of points. */
static void need_piece(void *data, const int32_t block[3], const hl_particle_run run[3]) {
  planning *p = data;
  (void)run;
  if (is_reached(p, p->level, block)) add_block(p, &p->plan->blocks[p->level], block);
}

static void need_points(planning *p, int level, const ptrdiff_t first[3], const size_t count[3]) {
  p->level = level;
  hl_particle_visit(&p->plan->lattice, level, first, count, need_piece, p);
}

/* Adds the blocks from which others are subdivided: for each block of a level, the blocks of the next coarser
 * level on which it depends. */
static void need_coarser(planning *p) {
  for (int level = 0; level + 1 < p->plan->lattice.levels; level++)
    for (size_t n = 0; n < p->plan->blocks[level].count && p->status == HL_OK; n++) {
      const hl_lattice_box box = hl_particle_block_box(p->plan->blocks[level].place[n]),
                           coarse = hl_subdivision_source(&box);
      need_points(p, level + 1, coarse.first, coarse.count);
    }
}

static void need_all_points(planning *p) {
  const ptrdiff_t first[3] = {0, 0, 0};
  size_t count[3];
  for (int a = 0; a < 3; a++) count[a] = hl_particle_points(&p->plan->lattice, 0, a);
  need_points(p, 0, first, count);
}

/* ---- bricks ---- */

static hl_bricks_choice choose(void *data, int level, const size_t brick[3]) {
  planning *p = data;
  const int32_t at[3] = {(int32_t)brick[0], (int32_t)brick[1], (int32_t)brick[2]};
  bool split = hl_block_number(&p->finer[level], at) >= 0;
  ptrdiff_t first[3];
  size_t count[3];
  if (!split && !is_reached(p, level, at)) return HL_BRICKS_NOTHING;
  for (int a = 0; a < 3; a++) {
    const hl_particle_lattice *lattice = &p->plan->lattice;
    /* At an end of a period, a brick's coefficients beyond the directory are not subdivided: their points are
     * needed, too. */
    bool begins = lattice->periodic[a] && at[a] == 0,
         ends = lattice->periodic[a] && (at[a] + 1) * HL_PARTICLE_BLOCK == directory_cells(lattice, level, a);
    first[a] = (ptrdiff_t)at[a] * HL_PARTICLE_BLOCK - (begins ? 1 : 0);
    count[a] = HL_PARTICLE_BLOCK + (begins ? 1 : 0) + (ends ? BRICK_MARGIN - 1 : 0);
  }
  need_points(p, level, first, count);
  return split ? HL_BRICKS_SPLIT : HL_BRICKS_LEAF;
}

static hl_status choose_leaves(planning *p) {
  hl_particle_plan *plan = p->plan;
  hl_bricks_source source = {.shift = HL_PARTICLE_BLOCK_SHIFT, .levels = plan->lattice.levels};
  for (int a = 0; a < 3; a++) source.dimension[a] = plan->lattice.cells[a] + 1;
  mark_coarser(p);
  if (p->status != HL_OK) return p->status;
  hl_status status = hl_bricks_choose(p->context, &source, choose, p, p->subject, &plan->leaves,
                                      &plan->leaf_count, p->error);
  return status == HL_OK ? p->status : status;
}

hl_status hl_particles_plan(hl_context *context, const hl_particle_set *set,
                            const hl_particle_lattice *lattice, bool in_bricks, const char *subject,
                            hl_particle_plan *plan, hl_error *error) {
  planning p = {.context = context, .plan = plan, .subject = subject, .error = error, .all = !in_bricks};
  *plan = (hl_particle_plan){.lattice = *lattice};
  plan->level_of = hl_allocate(context, set->count, sizeof *plan->level_of);
  if (plan->level_of == NULL) return hl_fail_memory(error, set->count, subject);
  choose_levels(set, lattice, plan->level_of);
  if (in_bricks) {
    mark_particles(&p, set);
    if (p.status == HL_OK) p.status = choose_leaves(&p);
  } else {
    need_all_points(&p);
  }
  if (p.status == HL_OK) need_coarser(&p);
  for (int level = 0; level < HL_PARTICLE_LEVELS; level++) {
    hl_block_table_release(context, &p.marked[level]);
    hl_block_table_release(context, &p.finer[level]);
  }
  return p.status;
}

void hl_particle_plan_release(hl_context *context, hl_particle_plan *plan) {
  for (int level = 0; level < HL_PARTICLE_LEVELS; level++)
    hl_block_table_release(context, &plan->blocks[level]);
  hl_release(context, plan->leaves);
  hl_release(context, plan->level_of);
  *plan = (hl_particle_plan){.leaves = NULL};
}

double hl_particle_plan_brick_bytes(const hl_particle_plan *plan) {
  const double side = HL_PARTICLE_BLOCK + BRICK_MARGIN;
  double entries = 1;
  for (int a = 0; a < 3; a++) entries *= (double)((plan->lattice.cells[a] >> HL_PARTICLE_BLOCK_SHIFT) + 1);
  return (double)plan->leaf_count * side * side * side * sizeof(float) + entries * sizeof(hl_brick_entry);
}

double hl_particle_plan_field_bytes(const hl_particle_plan *plan) {
  double blocks = 0;
  for (int level = 0; level < plan->lattice.levels; level++) blocks += (double)plan->blocks[level].count;
  return blocks * HL_PARTICLE_BLOCK_POINTS * sizeof(float);
}
