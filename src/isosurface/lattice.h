/* isosurface/lattice.h - describes a lattice of points that tells for each point whether it lies inside the
 * surface.
 *
 * The points stand at the voxels, and on the faces of the grid: along an axis of n voxels, point 0 lies at
 * -0.5, point i at i - 1, point n + 1 at n - 0.5. A cell lies between 2x2x2 points, and has the number of its
 * lowest point. A lattice keeps the bricks of 4x4x4 points around which the field crosses the surface's
 * value. */
#ifndef HL_ISOSURFACE_LATTICE_H
#define HL_ISOSURFACE_LATTICE_H

#include "core/pool.h"
#include "grid/field.h"

/* The points and edges of a brick. Point (x, y, z) of the brick has bit x + 4 y + 16 z. */
typedef struct lattice_brick {
  int32_t at[3];     /* coordinates of the brick in the lattice, counted in bricks */
  uint8_t crossed;   /* whether the surface may run through the brick's cells */
  uint64_t inside;   /* the points of the brick that lie inside the surface, one bit each */
  uint64_t cross[3]; /* for each axis, the points from which an edge along this axis begins that crosses the
                      * surface; one bit each */
  uint32_t vertex;   /* number of the brick's first vertex; its other vertices follow, sorted by axis and
                      * then by point */
  uint32_t triangle; /* number of the brick's first triangle */
} lattice_brick;

enum { LATTICE_NONE = UINT32_MAX };

typedef struct lattice {
  hl_context *context;
  const grid *grid;
  const kernel *kernel;
  double value;      /* the surface's value; stored units */
  double sign;       /* 1: the side of greater values is the inside; -1: the side of lesser values is */
  double outside[3]; /* the distance of the outermost points from the outermost voxels */
  int32_t points[3]; /* number of points along each axis: number of voxels + 2 */
  int32_t brick_count[3];
  uint32_t *slot;        /* owned; [bricks z][y][x]; the index of each brick in `bricks`; LATTICE_NONE: the
                          * brick is not kept */
  lattice_brick *bricks; /* owned; [count]; the kept bricks, in rising order */
  size_t count;
} lattice;

/* Makes the lattice of a surface. value: the field's value on the surface, as a data value. grid, kernel:
 * borrowed. Release the lattice after a failure, too. */
hl_status hl_lattice_create(hl_context *context, hl_pool *pool, const grid *grid, const kernel *kernel,
                            double value, lattice *made, hl_error *error);
void hl_lattice_release(lattice *made);

/* Runs function(data, index, worker) for each index below `count`. Fails if the run was cancelled; the
 * results are then incomplete, and must not be read. */
hl_status hl_lattice_run(hl_pool *pool, size_t count, void (*function)(void *, size_t, int), void *data,
                         hl_error *error);

/* The position of point i along an axis. */
static inline double hl_lattice_position(const lattice *lattice, int axis, int32_t i) {
  return i == 0                           ? -lattice->outside[axis]
         : i == lattice->points[axis] - 1 ? i - 2 + lattice->outside[axis]
                                          : i - 1.0;
}

/* The brick of the lattice that has given coordinates; null if this brick is not kept. */
const lattice_brick *hl_lattice_brick(const lattice *lattice, const int32_t at[3]);

#endif
