/* particles/particles.h - converts particles to a field: the density of a quantity that particles carry, such
 * as mass, as B-spline coefficients on a lattice.
 *
 * A particle is spread by the cubic spline kernel of smoothed particle hydrodynamics (kernel.h), which
 * reaches to twice the particle's smoothing length h. The lattice has levels: level l has the spacing 2^l
 * times the finest one. A particle goes to the coarsest level whose spacing is at most h / 2 (or to level 0
 * if there is no such level). Therefore a wide kernel touches no more points than a narrow one. The levels
 * are added up from coarse to fine: c[l] = S c[l + 1] + p[l], where p[l] is the sum of the kernels spread on
 * level l, and S subdivides a spline's coefficients exactly.
 *
 * Each level keeps only the blocks of its points where the sum may differ from 0. The sum becomes an array of
 * all points of level 0, or bricks at levels (bricks/bricks.h). In bricks, a place has the level of the
 * narrowest kernel that reaches it. The array and the bricks give the same field. Derived: a brick of a level
 * begins two points before the first kernel of this level, so no kernel is spread on the points whose
 * coefficients the bricks' builder subdivides.
 *
 * In: places, the quantity that each particle carries, and smoothing lengths or none
 * (volume/formats/particles/particles.c). Out: coefficients on the points of level 0, or bricks. The result
 * has the same bytes with any number of threads. */
#ifndef HL_PARTICLES_PARTICLES_H
#define HL_PARTICLES_PARTICLES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "bricks/build.h"
#include "core/error.h"
#include "core/pool.h"
#include "particles/block_table.h"

/* The particles of a caller; all arrays are borrowed. */
typedef struct hl_particle_input {
  size_t count;
  const void *positions; /* [count][3]; world; doubles or floats */
  bool is_double;
  const float *lengths;            /* [count]; smoothing lengths, world units; null if they are to be found */
  double period_low[3], period[3]; /* world: the beginning and the length of the period along each axis; a
                                    * length of 0 means that the axis is not periodic */
} hl_particle_input;

/* Particles sorted along a Morton curve, so that neighbours in the arrays are mostly neighbours in space. */
typedef struct hl_particle_set {
  size_t count;         /* number of particles with a finite place */
  uint32_t (*place)[3]; /* owned; [count]; fixed point: world = low + unit * place. Along a periodic axis 2^32
                         * units are a period; along other axes places are below 2^31 */
  uint32_t *order;      /* owned; [count]; index of each particle in the input */
  float *length;        /* owned; [count]; smoothing lengths, world units, above 0 */
  double low[3], unit[3]; /* world */
  bool periodic[3];
} hl_particle_set;

enum { HL_PARTICLE_LEVELS = 12 }; /* the most levels of a lattice */

/* Levels of a lattice. Level l has cells[a] >> l cells along axis a, and one point more where the axis is not
 * periodic. */
typedef struct hl_particle_lattice {
  int levels;
  size_t cells[3]; /* cells of level 0; multiples of 2^(levels - 1) */
  bool periodic[3];
  double low[3];     /* world: point (0,0,0) */
  double spacing[3]; /* world; spacing of level 0; equal along all axes that are not periodic */
} hl_particle_lattice;

/* Brings particles into order, and finds smoothing lengths where the input has none. Particles whose place is
 * not finite are left out. Fails if no particle is left, if a given length is not a finite number above 0, or
 * if lengths cannot be found because all particles are at one place. subject: starts the error lines. *set
 * must be released also after a failure. */
hl_status hl_particles_order(hl_context *context, hl_pool *pool, const hl_particle_input *input,
                             const char *subject, hl_particle_set *set, hl_error *error);
void hl_particles_release(hl_context *context, hl_particle_set *set);

/* Sets the smoothing length of each particle to half the distance to its HL_PARTICLES_NEIGHBOURS-th
 * neighbour, so that its kernel reaches to this neighbour. If there are fewer particles, the farthest one
 * counts. */
enum { HL_PARTICLES_NEIGHBOURS = 48 };
hl_status hl_particles_find_lengths(hl_context *context, hl_pool *pool, const char *subject,
                                    hl_particle_set *set, hl_error *error);

/* Limits of a lattice. */
typedef struct hl_particle_limits {
  double spacing; /* world units; the wanted spacing of the finest level. 0 stands for half of a smoothing
                   * length. This length is chosen so that one particle in fifty has a shorter one */
  size_t points;  /* the most points of level 0 */
  size_t side;    /* the greatest number of cells of level 0 along an axis; 0 if there is no limit */
} hl_particle_limits;

/* Chooses a lattice around the particles and their kernels. A wanted spacing is kept; along a periodic axis
 * it is changed so that the period has a whole number of cells. If a wanted spacing needs more points than
 * the limits allow, the function fails. */
hl_status hl_particles_lattice(const hl_particle_set *set, const hl_particle_limits *limits,
                               const char *subject, hl_particle_lattice *lattice, hl_error *error);

/* The number of points of one level along an axis. */
static inline size_t hl_particle_points(const hl_particle_lattice *lattice, int level, int axis) {
  return (lattice->cells[axis] >> level) + (lattice->periodic[axis] ? 0 : 1);
}

/* The blocks of each level that the field needs. A block has HL_PARTICLE_BLOCK points along each axis. Block
 * b of a level holds the points b HL_PARTICLE_BLOCK to (b + 1) HL_PARTICLE_BLOCK - 1 of this level. */
enum { HL_PARTICLE_BLOCK_SHIFT = 4, HL_PARTICLE_BLOCK = 1 << HL_PARTICLE_BLOCK_SHIFT };
#define HL_PARTICLE_BLOCK_POINTS ((size_t)HL_PARTICLE_BLOCK * HL_PARTICLE_BLOCK * HL_PARTICLE_BLOCK)
typedef struct hl_particle_plan {
  hl_particle_lattice lattice;
  uint8_t *level_of; /* owned; [set->count]; the level on which each particle is spread */
  hl_block_table blocks[HL_PARTICLE_LEVELS];
  hl_bricks_leaf *leaves; /* owned; if null, the field becomes an array of all points */
  size_t leaf_count;
} hl_particle_plan;

/* Chooses each particle's level, and finds the blocks that are needed. in_bricks: whether bricks will be made
 * of the field. *plan must be released also after a failure. */
hl_status hl_particles_plan(hl_context *context, const hl_particle_set *set,
                            const hl_particle_lattice *lattice, bool in_bricks, const char *subject,
                            hl_particle_plan *plan, hl_error *error);
void hl_particle_plan_release(hl_context *context, hl_particle_plan *plan);

/* hl_particle_plan_brick_bytes() gives the number of bytes of the plan's bricks.
 * hl_particle_plan_field_bytes() gives the number of bytes of one field while it is spread. */
double hl_particle_plan_brick_bytes(const hl_particle_plan *plan);
double hl_particle_plan_field_bytes(const hl_particle_plan *plan);

/* The field's coefficients at all levels. Points without a block have the coefficient `outside`. */
typedef struct hl_particle_field {
  const hl_particle_plan *plan;
  float *points[HL_PARTICLE_LEVELS]; /* owned; [blocks][z][y][x], HL_PARTICLE_BLOCK points an axis */
  float outside;
} hl_particle_field;

/* Makes the field of the particles' weights: weight per volume, in world units. weights: [set->count], in the
 * set's order; if null, each weight is 1. The sum of all coefficients of level 0, times the volume of a cell,
 * is the sum of the weights, except for the rounding of floats. The field borrows the plan. *field must be
 * released also after a failure. */
hl_status hl_particles_spread(hl_context *context, hl_pool *pool, const hl_particle_set *set,
                              const float *weights, const hl_particle_plan *plan, const char *subject,
                              hl_particle_field *field, hl_error *error);
void hl_particle_field_release(hl_context *context, hl_particle_field *field);

/* The number of floats of points[level]. */
static inline size_t hl_particle_field_floats(const hl_particle_field *field, int level) {
  return field->plan->blocks[level].count * HL_PARTICLE_BLOCK_POINTS;
}

/* Copies the points of level 0. Along periodic axes the first point is repeated at the end. voxels:
 * [z][y][x], lattice.cells + 1 points along each axis. */
void hl_particle_field_copy(const hl_particle_field *field, hl_pool *pool, float *voxels);

/* Makes bricks of a field whose plan has leaves. Along periodic axes the bricks reach from one end of the
 * period to the other. *bricks is empty on failure. */
hl_status hl_particle_field_bricks(hl_context *context, hl_pool *pool, const hl_particle_field *field,
                                   const char *subject, hl_bricks *bricks, hl_error *error);

#endif
