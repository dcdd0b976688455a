/* cli/ranks.h - processes of an MPI launcher that make one picture together.
 *
 * MPI's library is loaded when it is asked for: the program is built without it and runs without it. */
#ifndef HL_CLI_RANKS_H
#define HL_CLI_RANKS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct ranks_functions ranks_functions;

/* All zeros: this process is alone. */
typedef struct ranks {
  int rank, size;             /* of how many; size 0: alone */
  ranks_functions *functions; /* owned; null: alone */
} ranks;

/* Joins the processes that Open MPI's launcher has started. Returns the exit code; release with ranks_end()
 * in any case. */
int ranks_begin(ranks *all);

/* Adds up everyone's values; rank 0 gets the sums, and the others keep their own. Returns the exit code. */
int ranks_sum(ranks *all, float *values, size_t count);

/* Leaves the others; where the exit code is one of failure, ends them too: nobody waits for a rank that has
 * failed. */
void ranks_end(ranks *all, int exit_code);

#endif
