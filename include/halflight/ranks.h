/* halflight/ranks.h - processes of an MPI job that hold a volume together.
 *
 * A volume over ranks lies in the memory of all processes (ranks): each holds a block of it, and asks the
 * others for what it samples of theirs. Such a volume renders like any other, with the same bytes, on every
 * rank; what a rank keeps of the others' blocks counts towards its context's memory limit.
 *
 * Open MPI's library (version 4 or 5) or MPICH's (3.1 or later, or one with its binary interface, as Intel
 * MPI and MVAPICH) is loaded when hl_ranks_join() is called; neither headers nor a library are needed before.
 * The functions are collective where they say so: every rank calls them, in the same order. A rank whose
 * collective call, or whose call with a volume over ranks, fails should end the job (hl_ranks_abort() or
 * MPI_Abort()): the others may wait for it. MPI ends the job where a process dies. */
#ifndef HALFLIGHT_RANKS_H
#define HALFLIGHT_RANKS_H

#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hl_ranks hl_ranks;

/* Joins the processes of a communicator. Collective. communicator: an MPI_Comm of the library that the
 * process has loaded, as (void *)(intptr_t)comm: a pointer in Open MPI, a number in MPICH; the library
 * works on a duplicate of it. MPI must have been started with MPI_THREAD_MULTIPLE: a thread of the library
 * answers the other ranks while the caller does what it likes. Null: the whole job; MPI is started here, if
 * it is not yet, and ended by hl_ranks_leave(). Where the process has no library of MPI, `mpi` of
 * hl_context_options says which one is loaded. *ranks: owned by the caller; release it with
 * hl_ranks_leave() before the context. */
HL_API HL_WARN_UNUSED hl_status hl_ranks_join(hl_context *context, void *communicator, hl_ranks **ranks,
                                              hl_error *error);

/* Ends what hl_ranks_join() began. Collective; call it after all volumes over these ranks were released.
 * Null is allowed. */
HL_API void hl_ranks_leave(hl_ranks *ranks);

/* Ends the whole job at once, with this exit code. Null is allowed: does nothing. */
HL_API void hl_ranks_abort(hl_ranks *ranks, int exit_code);

HL_API int hl_ranks_rank(const hl_ranks *ranks); /* from 0 on; 0 for null */
HL_API int hl_ranks_size(const hl_ranks *ranks); /* 1 for null */

/* Adds up the values of all ranks: rank 0 gets the sums, the others keep theirs. Collective. After
 * hl_renderer_share(renderer, rank, size), the sum of all ranks' pictures is the whole picture. */
HL_API void hl_ranks_sum(hl_ranks *ranks, float *values, size_t count);

/* Tells how much this rank has received of other ranks' voxels so far: the bytes, the number of requests for
 * them, and the seconds that its threads have waited. Each pointer may be null. */
HL_API void hl_ranks_traffic(const hl_ranks *ranks, uint64_t *bytes, uint64_t *requests, double *seconds);

/* From now on volumes of 1 MiB or more that are loaded through the context of `ranks` lie over the ranks:
 * each rank reads its own slices alone where the file allows it (of compressed files it keeps its own slices
 * alone). Loading them is collective, and so is their last hl_volume_release(). The files are those that can
 * be larger than memory (hl_context_options.scratch_folder). Null is allowed: does nothing. */
HL_API void hl_ranks_hold_volumes(hl_ranks *ranks);

/* The block of a volume that a rank holds. */
typedef struct hl_block {
  size_t struct_size; /* set by the caller to sizeof(hl_block) */
  size_t offset[3];   /* place of the block's first voxel in the whole volume, along i, j, k */
  size_t size[3];     /* the block's voxels along i, j, k, without ghosts; one number may be 0: the rank
                       * holds none */
  size_t ghost[3];    /* layers of voxels around the block in memory, on either side, which are passed over */
  const void *voxels; /* borrowed, not copied: the first voxel in memory, which is a ghost where there are
                       * any; the voxels must stay as they are until the volume's last reference is
                       * released */
  ptrdiff_t stride_bytes[3]; /* bytes from one voxel to the next along i, j, k; all 0: packed, with ghosts */
} hl_block;

/* Makes a volume of the blocks of all ranks, which must fill it without overlap. Collective. The volume's
 * last hl_volume_release() is collective, too, and so is whatever reads all voxels:
 * hl_volume_percentiles(), the first frame of each renderer, and the first hl_labels_of_volume(), for which
 * each rank gets a copy of the whole label map. whole: size, type, placement and scale of the whole volume,
 * the same on all ranks; its voxels, strides and `borrow` are not read. Its voxels must be finite. The
 * volume's mean is summed up block by block, so that its last digits depend on the blocks; no other number
 * and no picture does. */
HL_API HL_WARN_UNUSED hl_status hl_volume_create_over_ranks(hl_ranks *ranks,
                                                            const hl_volume_description *whole,
                                                            const hl_block *block, hl_volume **volume,
                                                            hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
