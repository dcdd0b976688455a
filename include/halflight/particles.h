/* halflight/particles.h - volumes made of the particles of smoothed particle hydrodynamics and molecular
 * dynamics.
 *
 * Each particle is spread over the voxels of a volume by the cubic spline kernel, whose radius is twice the
 * particle's smoothing length. The total mass is kept: the sum of all voxels' densities, times the volume of
 * a voxel, is the mass of the particles. docs/particles.md describes the method. */
#ifndef HALFLIGHT_PARTICLES_H
#define HALFLIGHT_PARTICLES_H

#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What the voxels of the volume are. */
typedef enum hl_particles_quantity {
  HL_PARTICLES_LOG_DENSITY = 0, /* logarithm to base 10 of the density. No voxel gets less than a tenth of the
                                 * least density that any particle has at its own place */
  HL_PARTICLES_DENSITY = 1,     /* mass per cubed world unit; 0 where no particle reaches */
  HL_PARTICLES_MEAN =
      2 /* mean of `values`, weighted by mass and kernel; `outside` where no particle reaches */
} hl_particles_quantity;

/* All arrays are borrowed during the call. */
typedef struct hl_particles_description {
  size_t struct_size;          /* set by hl_particles_description_defaults() */
  size_t count;                /* number of particles, at least 1. Particles whose place is not finite are
                                * left out */
  const void *positions;       /* [count][3]; world x, y, z */
  hl_voxel_type position_type; /* HL_VOXEL_F64 (default) or HL_VOXEL_F32 */
  const float *masses;         /* [count]; finite, from 0 on; null (default): 1 each */
  const float *lengths; /* [count]; smoothing lengths in world units; a kernel's radius is twice the smoothing
                         * length; null (default): each is half of the distance of the particle's 48th
                         * neighbour */
  const float *values;  /* [count]; finite; for HL_PARTICLES_MEAN */
  float outside; /* for HL_PARTICLES_MEAN: the value where no particle reaches; NaN (default): no data */
  double period_low[3]; /* world: where the periodic box begins; default 0 */
  double period[3];     /* the length of the world's periodic box along x, y, z; 0 (default): not periodic
                         * along the axis */
  hl_particles_quantity quantity;
  double spacing; /* spacing of the voxels in world units; 0 (default): half of a smoothing length, chosen so
                   * that one particle in fifty has a smaller one; more where `side` or the memory limit
                   * requires it */
  size_t side;    /* most voxels along an axis where spacing is 0; default 512 */
  int threads;    /* 0 (default): one per processor */
} hl_particles_description;

HL_API void hl_particles_description_defaults(hl_particles_description *description);

/* Makes a volume of particles. Its voxels are floats, and its axes are the world's. Where most of the box is
 * empty or smooth, the field is kept in bricks; a brick has a spacing of 2^l voxels where no kernel is
 * narrow. Along a periodic axis the first and the last voxel stand at the ends of the period, and have the
 * same values. The bytes do not depend on the number of threads. *volume is owned by the caller.
 * HL_ERROR_INPUT for numbers that cannot be right; HL_ERROR_MEMORY where the memory limit leaves no room for
 * the wanted spacing. */
HL_API HL_WARN_UNUSED hl_status hl_volume_from_particles(hl_context *context,
                                                         const hl_particles_description *description,
                                                         hl_volume **volume, hl_error *error);

/* Whether a .vtp file is read as particles: PolyData without lines and surfaces whose points have an array of
 * masses ("mass", "masses", "m") or of smoothing lengths ("h", "hsml", "smoothing_length"). Other PolyData
 * are meshes (hl_mesh_load()). 0 for files of other formats, and for null. */
HL_API int hl_volume_reads_particles(hl_context *context, const char *path);

/* Finds the smoothing lengths that hl_volume_from_particles() would choose, so that several volumes can be
 * made of the same particles with them. lengths: [description->count]; filled; 0 for particles that are left
 * out. */
HL_API HL_WARN_UNUSED hl_status hl_particles_find_smoothing(hl_context *context,
                                                            const hl_particles_description *description,
                                                            float *lengths, hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
