/* cli/ranks.c - see ranks.h. */
#define _GNU_SOURCE
#include "ranks.h"

#include <stdlib.h>
#include <string.h>

#include "message.h"

int ranks_begin(cli_host *host, const char *option, hl_ranks **ranks) {
  hl_error error = {0};
  if (getenv("OMPI_COMM_WORLD_SIZE") == NULL)
    return fail(EXIT_CODE_USAGE, "--%s: Open MPI's mpirun has not started this process: start it so", option);
  if (hl_ranks_join(host->context, NULL, ranks, &error) != HL_OK)
    return fail(EXIT_CODE_FAILURE, "--%s: %s", option, error.message);
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
