/* particles/levels.h - describes one level of a lattice: where particles stand in it, which points their
 * kernels reach, and the pieces of boxes of points that lie in one block each. Only the files of particles/
 * include it. */
#ifndef HL_PARTICLES_LEVELS_H
#define HL_PARTICLES_LEVELS_H

#include <math.h>

#include "bricks/subdivide.h"
#include "particles/particles.h"

#define HL_PARTICLE_NARROWING 1.11 /* the factor of s^2 in splat.c, a little less than 10/9 */
/* The least length h' of a kernel, in spacings. Kernels that the level does not resolve get this length. Some
 * point is then always nearer to the particle than 2 h'. */
#define HL_PARTICLE_LEAST_LENGTH 0.7
/* The greatest smoothing length of kernels on a level, in units of the level's least spacing. Wider kernels
 * belong to the next coarser level. On the coarsest level, where there is none, they are narrowed to this
 * length. */
#define HL_PARTICLE_MOST_LENGTH 3.99

enum { HL_PARTICLE_ROW = 16 }; /* the most points that a kernel reaches along an axis */

typedef struct hl_particle_level {
  size_t points[3];
  bool periodic[3];
  int margin; /* along axes that are not periodic: the least distance, in points, of a kernel's points from a
               * face. Points nearer to the face would reach beyond it when they are subdivided to level 0 */
  double spacing[3];          /* world */
  double scale[3], offset[3]; /* lattice coordinate = scale * place + offset */
  double mean_square;         /* the mean of the squared spacings */
  double least_spacing;
} hl_particle_level;

static inline hl_particle_level hl_particle_level_of(const hl_particle_set *set,
                                                     const hl_particle_lattice *lattice, int level) {
  /* Derived: subdivision spreads the coefficient of point j of level l over points of level 0, of which the
   * first is 2^l j - 2 (2^l - 1). Points of level l have at least this margin from the grid's faces, so that
   * the points of level 0 lie inside the grid. */
  hl_particle_level grid = {.margin = level < 2 ? level : 2};
  for (int a = 0; a < 3; a++) {
    grid.points[a] = hl_particle_points(lattice, level, a);
    grid.periodic[a] = lattice->periodic[a];
    grid.spacing[a] = ldexp(lattice->spacing[a], level);
    grid.scale[a] = set->unit[a] / grid.spacing[a];
    grid.offset[a] = (set->low[a] - lattice->low[a]) / grid.spacing[a];
    grid.mean_square += grid.spacing[a] * grid.spacing[a] / 3;
  }
  grid.least_spacing = fmin(fmin(grid.spacing[0], grid.spacing[1]), grid.spacing[2]);
  return grid;
}

/* The points of a block. */
static inline hl_lattice_box hl_particle_block_box(const int32_t block[3]) {
  hl_lattice_box box;
  for (int a = 0; a < 3; a++) {
    box.first[a] = (ptrdiff_t)block[a] * HL_PARTICLE_BLOCK;
    box.count[a] = HL_PARTICLE_BLOCK;
  }
  return box;
}

/* The lattice coordinate of a particle along an axis. */
static inline double hl_particle_coordinate(const hl_particle_set *set, const hl_particle_level *grid,
                                            size_t n, int axis) {
  double at = grid->scale[axis] * set->place[n][axis] + grid->offset[axis];
  double last = (double)grid->points[axis] - (grid->periodic[axis] ? 0 : 1);
  return at < 0 ? 0 : at > last ? last : at;
}

/* The length h' to which a particle's kernel is narrowed (splat.c); world units. */
static inline double hl_particle_narrowed(const hl_particle_set *set, const hl_particle_level *grid,
                                          size_t n) {
  double length = fmin((double)set->length[n], HL_PARTICLE_MOST_LENGTH * grid->least_spacing),
         square = length * length - HL_PARTICLE_NARROWING * grid->mean_square;
  return sqrt(fmax(square, HL_PARTICLE_LEAST_LENGTH * HL_PARTICLE_LEAST_LENGTH * grid->mean_square));
}

/* The points along an axis that a kernel reaches: range[0] to range[1]. Along periodic axes some may lie
 * outside of the field. */
static inline void hl_particle_range(const hl_particle_level *grid, int axis, double at, double narrowed,
                                     int range[2]) {
  double reach = 2 * narrowed / grid->spacing[axis];
  int end = (int)grid->points[axis] - 1 - grid->margin;
  range[0] = (int)ceil(at - reach);
  range[1] = (int)floor(at + reach);
  if (!grid->periodic[axis]) {
    range[0] = range[0] < grid->margin ? grid->margin : range[0];
    range[1] = range[1] > end ? end : range[1];
  }
  if (range[1] - range[0] + 1 > HL_PARTICLE_ROW) range[1] = range[0] + HL_PARTICLE_ROW - 1;
}

/* A run of neighbouring points along an axis that lie both in a box and in one block. */
typedef struct hl_particle_run {
  int32_t block;
  size_t within; /* the index of the first point in the block */
  size_t count;
  size_t from; /* the index of the first point in the box */
} hl_particle_run;

/* Calls `visit` for each piece of a box of points of a level, in a fixed order. A box may reach beyond the
 * level's ends: along periodic axes it wraps to the other end, and along other axes points beyond a face are
 * replaced by the point at the face. */
void hl_particle_visit(const hl_particle_lattice *lattice, int level, const ptrdiff_t first[3],
                       const size_t count[3],
                       void (*visit)(void *data, const int32_t block[3], const hl_particle_run run[3]),
                       void *data);

/* Copies a box of points of a level. */
void hl_particle_field_read(const hl_particle_field *field, int level, const ptrdiff_t first[3],
                            const size_t count[3], float *out);

/* Adds a box of points to a level. Values of the box at points without a block must be 0. The box must not
 * reach beyond a face of an axis that is not periodic. */
void hl_particle_field_add(hl_particle_field *field, int level, const ptrdiff_t first[3],
                           const size_t count[3], const float *box);

/* Adds the particles of one level to the field. */
hl_status hl_particles_splat(hl_context *context, hl_pool *pool, const hl_particle_set *set,
                             const float *weights, hl_particle_field *field, int level, const char *subject,
                             hl_error *error);

#endif
