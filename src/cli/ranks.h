/* cli/ranks.h - processes of an MPI launcher that make one picture together (halflight/ranks.h). */
#ifndef HL_CLI_RANKS_H
#define HL_CLI_RANKS_H

#include "host.h"

/* Joins the processes that Open MPI's launcher has started. option: for error lines. Returns the exit code;
 * release with ranks_end() in any case. */
int ranks_begin(cli_host *host, const char *option, hl_ranks **ranks);

/* Where the exit code is one of failure, ends the others too: nobody waits for a rank that has failed. Before
 * anything that the others use is released. ranks: may be null. */
void ranks_check(hl_ranks *ranks, int exit_code);

#endif
