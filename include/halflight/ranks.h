/* halflight/ranks.h - lets the processes of an MPI job hold a volume together.
 *
 * A volume over ranks is a volume that lies in the memory of all processes, which MPI calls ranks. Each rank
 * holds a block of the volume, and asks the other ranks for voxels of their blocks when it samples them. Such
 * a volume renders like any other, with the same bytes, on every rank. The voxels that a rank keeps of other
 * ranks' blocks count towards its context's memory limit.
 *
 * hl_ranks_join() loads the library of Open MPI (version 4 or 5), of MPICH (3.1 or later), or one with
 * MPICH's binary interface, as Intel MPI and MVAPICH have. Builds need neither headers nor a library of MPI.
 * Functions are called collective below if every rank must call them, in the same order. If a collective call
 * or a call with a volume over ranks fails, its rank should end the job (hl_ranks_abort() or MPI_Abort()),
 * because other ranks may wait for it. MPI ends the job where a process dies. */
#ifndef HALFLIGHT_RANKS_H
#define HALFLIGHT_RANKS_H

#include "volume.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct hl_ranks hl_ranks;

/* Joins the processes of a communicator. This call is collective. communicator: an MPI_Comm of the library
 * that the process has loaded, as (void *)(intptr_t)comm: a pointer in Open MPI, a number in MPICH; Halflight
 * works on a duplicate of the communicator. MPI must have been started with MPI_THREAD_MULTIPLE, because a
 * thread of Halflight answers the other ranks while the caller does other work. If communicator is null, all
 * processes of the job are joined; this function starts MPI if it was not started, and hl_ranks_leave() then
 * ends it. Where the process has no library of MPI, `mpi` of hl_context_options says which one is loaded.
 * *ranks is owned by the caller, who releases it with hl_ranks_leave() before the context. */
HL_API HL_WARN_UNUSED hl_status hl_ranks_join(hl_context *context, void *communicator, hl_ranks **ranks,
                                              hl_error *error);

/* Leaves the job that hl_ranks_join() joined. This call is collective. Call it after all volumes over these
 * ranks were released. Null is allowed. */
HL_API void hl_ranks_leave(hl_ranks *ranks);

/* Ends the whole job at once, with this exit code. For null, the function does nothing. */
HL_API void hl_ranks_abort(hl_ranks *ranks, int exit_code);

HL_API int hl_ranks_rank(const hl_ranks *ranks); /* the rank's number, from 0 on; 0 if `ranks` is null */
HL_API int hl_ranks_size(const hl_ranks *ranks); /* 1 for null */

/* Adds up the arrays of all ranks, value by value. Rank 0 gets the sums; the other ranks' values stay. This
 * call is collective. values: [count]. After hl_renderer_share(renderer, rank, size), the sum of all ranks'
 * pictures is the whole picture. */
HL_API void hl_ranks_sum(hl_ranks *ranks, float *values, size_t count);

/* Compares a number over all ranks, as the hash of what a rank is about to do. This call is collective.
 * Returns the first rank whose number is not the number of rank 0, or 0 if all numbers are equal or `ranks`
 * is null. */
HL_API int hl_ranks_compare(hl_ranks *ranks, uint64_t number);

/* Tells how much this rank has received of other ranks' voxels so far: the number of bytes, the number of
 * requests, and the seconds that this rank's threads have waited for the answers. Each pointer may be
 * null. */
HL_API void hl_ranks_traffic(const hl_ranks *ranks, uint64_t *bytes, uint64_t *requests, double *seconds);

/* From now on, volumes of 1 MiB or more that are loaded through the context of `ranks` lie over the ranks.
 * Each rank reads only its own slices; of a compressed file it reads everything and keeps only its own
 * slices. Loading such a volume is collective, and so is its last hl_volume_release(). This holds for files
 * of the formats that can be larger than memory (hl_context_options.scratch_folder). For null, the function
 * does nothing. */
HL_API void hl_ranks_hold_volumes(hl_ranks *ranks);

/* The block of a volume that a rank holds. */
typedef struct hl_block {
  size_t struct_size; /* set by the caller to sizeof(hl_block) */
  size_t offset[3];   /* the index of the block's first voxel in the whole volume, along i, j, k */
  size_t size[3];     /* the number of the block's voxels along i, j, k, without ghosts; if one of the numbers
                       * is 0, the rank holds no voxels */
  size_t ghost[3];    /* the number of layers of further voxels (ghosts) that lie around the block in memory,
                       * on either side along i, j, k; the library does not use these voxels */
  const void *voxels; /* borrowed, not copied: the first voxel in memory, which is a ghost if there are
                       * ghosts. The voxels must not change or be freed until the volume's last reference is
                       * released */
  ptrdiff_t stride_bytes[3]; /* the number of bytes from one voxel to the next along i, j, k; all 0: the
                              * voxels and their ghosts are packed */
} hl_block;

/* Makes a volume of the blocks of all ranks, which must fill the volume without overlap. This call is
 * collective. The volume's last hl_volume_release() is collective, too, and so are the functions that read
 * all voxels: hl_volume_percentiles(), the first frame of each renderer, and the first hl_labels_of_volume(),
 * for which each rank gets a copy of the whole label map. whole: size, type, placement and scale of the whole
 * volume, the same on all ranks; its voxels, strides and `borrow` are not read. All voxels of the volume must
 * be finite. The volume's mean is summed up block by block, so that its last digits depend on how the volume
 * is divided into blocks. No other number and no picture depends on this. */
HL_API HL_WARN_UNUSED hl_status hl_volume_create_over_ranks(hl_ranks *ranks,
                                                            const hl_volume_description *whole,
                                                            const hl_block *block, hl_volume **volume,
                                                            hl_error *error);

#ifdef __cplusplus
}
#endif
#endif
