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

/* The quantity that the voxels of the volume hold. */
typedef enum hl_particles_quantity {
  HL_PARTICLES_LOG_DENSITY = 0, /* the logarithm to base 10 of the density. A voxel's density counts as at
                                 * least a tenth of the least density that any particle has at its own
                                 * position */
  HL_PARTICLES_DENSITY = 1,     /* the density: mass per cubed world unit; 0 where no particle reaches */
  HL_PARTICLES_MEAN = 2 /* the mean of the particles' `values`, weighted by mass and kernel; `outside` where
                         * no particle reaches */
} hl_particles_quantity;

/* Particles, and the volume that is made of them. All arrays are borrowed during the call. */
typedef struct hl_particles_description {
  size_t struct_size;          /* set by hl_particles_description_defaults() */
  size_t count;                /* number of particles, at least 1. Particles with a position that is not
                                * finite are left out */
  const void *positions;       /* [count][3]; world x, y, z */
  hl_voxel_type position_type; /* the type of the positions' numbers: HL_VOXEL_F64 (default) or
                                * HL_VOXEL_F32 */
  const float *masses;         /* [count]; masses, finite and not negative; null (default): each mass is 1 */
  const float *lengths; /* [count]; smoothing lengths in world units; a kernel's radius is twice the smoothing
                         * length; null (default): a particle's smoothing length is half of the distance to
                         * its 48th neighbour */
  const float *values;  /* [count]; finite; the quantity of each particle for HL_PARTICLES_MEAN */
  float outside; /* for HL_PARTICLES_MEAN: the voxels' value where no particle reaches; NaN (default): there
                  * is no data */
  double period_low[3]; /* the least coordinates of the world's periodic box; default 0 */
  double period[3];     /* the lengths of the world's periodic box along x, y, z; 0 (default): the world is
                         * not periodic along this axis */
  hl_particles_quantity quantity;
  double spacing; /* the distance between voxels in world units; 0 (default): half of a smoothing length,
                   * chosen so that one particle in fifty has a smaller smoothing length. It is made greater
                   * if `side` or the memory limit requires this */
  size_t side;    /* if spacing is 0: the greatest number of voxels along an axis; default 512 */
  int threads;    /* 0 (default): one per processor */
} hl_particles_description;

HL_API void hl_particles_description_defaults(hl_particles_description *description);

/* Makes a volume of particles. Its voxels are floats, and its axes are the world's. If most of the box is
 * empty or smooth, the field is kept in bricks. A brick in which all kernels are wide has its values 2, 4, 8,
 * ... voxels apart. Along a periodic axis the first and the last voxel stand at the ends of the period, and
 * have the same values. The voxels' bytes do not depend on the number of threads. *volume is owned by the
 * caller, who releases it. HL_ERROR_INPUT: a number of the description is impossible. HL_ERROR_MEMORY: the
 * memory limit leaves no room for the wanted spacing. */
HL_API HL_WARN_UNUSED hl_status hl_volume_from_particles(hl_context *context,
                                                         const hl_particles_description *description,
                                                         hl_volume **volume, hl_error *error);

/* Returns 1 if hl_volume_load() reads a .vtp file as particles: if it is PolyData without lines and surfaces,
 * and its points have an array of masses ("mass", "masses", "m") or of smoothing lengths ("h", "hsml",
 * "smoothing_length"). Other PolyData are meshes (hl_mesh_load()). Returns 0 for these, for files of other
 * formats, and for null. */
HL_API int hl_volume_reads_particles(hl_context *context, const char *path);

/* Finds the smoothing lengths that hl_volume_from_particles() would choose. A caller can then make several
 * volumes of the same particles with the same lengths. lengths: [description->count]; receives the lengths; 0
 * for particles that are left out. */
HL_API HL_WARN_UNUSED hl_status hl_particles_find_smoothing(hl_context *context,
                                                            const hl_particles_description *description,
                                                            float *lengths, hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
