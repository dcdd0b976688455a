/* isosurface/lattice.h - the points of a grid at which a surface tells inside from outside.
 *
 * The points stand at the voxels, and on the faces of the grid: along an axis of n voxels, point 0 lies at
 * -0.5, point i at i - 1, point n + 1 at n - 0.5. A cell lies between 2x2x2 points; its number is that of its
 * lowest point. A lattice keeps the bricks of 4x4x4 points around which the field crosses the surface's
 * value. */
#ifndef HL_ISOSURFACE_LATTICE_H
#define HL_ISOSURFACE_LATTICE_H

#include "core/pool.h"
#include "grid/field.h"

/* A brick's points and edges; bit x + 4 y + 16 z. */
typedef struct lattice_brick {
  int32_t at[3];     /* coordinates, in bricks */
  uint8_t crossed;   /* the surface may run through its cells */
  uint64_t inside;   /* points beyond the value */
  uint64_t cross[3]; /* edges that begin at the point, along x, y and z, and cross the surface */
  uint32_t vertex;   /* number of its first vertex, then of the others: by axis, then by point */
  uint32_t triangle; /* number of its first triangle */
} lattice_brick;

enum { LATTICE_NONE = UINT32_MAX };

typedef struct lattice {
  hl_context *context;
  const grid *grid;
  const kernel *kernel;
  double value;      /* of the surface; stored units */
  double sign;       /* 1: inside are greater values; -1: lesser */
  double outside[3]; /* the distance of the outermost points from the outermost voxels */
  int32_t points[3]; /* n + 2 */
  int32_t brick_count[3];
  uint32_t *slot;        /* owned; [bricks z][y][x]; index of `bricks`; LATTICE_NONE: not kept */
  lattice_brick *bricks; /* owned; [count]; in rising order */
  size_t count;
} lattice;

/* value: of the data. grid, kernel: borrowed. Release in any case. */
hl_status hl_lattice_create(hl_context *context, hl_pool *pool, const grid *grid, const kernel *kernel,
                            double value, lattice *made, hl_error *error);
void hl_lattice_release(lattice *made);

/* Runs function(data, index, worker) for each index below `count`. An error where the run was cancelled: the
 * numbers that it was to write are then missing, and must not be read. */
hl_status hl_lattice_run(hl_pool *pool, size_t count, void (*function)(void *, size_t, int), void *data,
                         hl_error *error);

/* The position of point i along an axis. */
static inline double hl_lattice_position(const lattice *lattice, int axis, int32_t i) {
  return i == 0                           ? -lattice->outside[axis]
         : i == lattice->points[axis] - 1 ? i - 2 + lattice->outside[axis]
                                          : i - 1.0;
}

/* The kept brick at these coordinates; null: none. */
const lattice_brick *hl_lattice_brick(const lattice *lattice, const int32_t at[3]);

#endif
