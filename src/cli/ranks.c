/* cli/ranks.c - see ranks.h. */
#define _GNU_SOURCE
#include "ranks.h"

#include <stdlib.h>
#include <string.h>

#include "message.h"

/* The known launchers: that of Open MPI; that of MPICH, Intel MPI and MVAPICH; and Slurm's srun, which starts
 * processes of either kind. */
static const launcher launchers[] = {
    {.rank_name = "OMPI_COMM_WORLD_RANK", .size_name = "OMPI_COMM_WORLD_SIZE", .mpi = HL_MPI_OPEN_MPI},
    {.rank_name = "PMI_RANK", .size_name = "PMI_SIZE", .mpi = HL_MPI_MPICH},
    {.rank_name = "SLURM_PROCID", .size_name = "SLURM_NTASKS", .mpi = HL_MPI_AUTO}};

bool launcher_of_process(launcher *found) {
  for (size_t i = 0; i < sizeof launchers / sizeof *launchers; i++) {
    *found = launchers[i];
    found->rank = getenv(found->rank_name);
    found->size = getenv(found->size_name);
    if (found->rank != NULL && found->size != NULL) return true;
  }
  return false;
}

hl_mpi launcher_mpi(void) {
  launcher found;
  return launcher_of_process(&found) ? found.mpi : HL_MPI_AUTO;
}

int ranks_begin(cli_host *host, const char *option, hl_ranks **ranks) {
  hl_error error = {0};
  launcher found;
  if (!launcher_of_process(&found) || found.mpi == HL_MPI_AUTO)
    return fail(EXIT_CODE_USAGE, "--%s: mpirun has not started this process: start it so", option);
  if (hl_ranks_join(host->context, NULL, ranks, &error) != HL_OK)
    return fail(EXIT_CODE_FAILURE, "--%s: %s", option, error.message);
  if (atoi(found.size) != hl_ranks_size(*ranks))
    return fail(
        EXIT_CODE_FAILURE,
        "--%s: %s is %s, but MPI's processes are %d: the library and the launcher belong to different MPIs",
        option, found.size_name, found.size, hl_ranks_size(*ranks));
  host->quiet = host->quiet || hl_ranks_rank(*ranks) > 0;
  host->bar = host->bar && !host->quiet;
  return EXIT_CODE_OK;
}

void ranks_check(hl_ranks *ranks, int exit_code) {
  if (ranks == NULL || exit_code == EXIT_CODE_OK) return;
  if (exit_code != EXIT_CODE_INTERRUPTED)
    fail(exit_code, "rank %d of %d has failed and ends them all", hl_ranks_rank(ranks), hl_ranks_size(ranks));
  hl_ranks_abort(ranks, exit_code);
}
