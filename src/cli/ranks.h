/* cli/ranks.h - joins the processes of an MPI launcher, which make one picture together
 * (halflight/ranks.h). */
#ifndef HL_CLI_RANKS_H
#define HL_CLI_RANKS_H

#include "host.h"

/* The number of this process and the number of all processes, which their launcher (mpirun, srun) gives in
 * variables of the environment. */
typedef struct launcher {
  const char *rank_name, *size_name; /* names of the variables */
  const char *rank, *size;           /* the values of these variables as text, not checked yet */
  hl_mpi mpi;                        /* the MPI library to which the launcher belongs */
} launcher;

/* Finds the launcher that started this process. Returns false if no launcher did. */
bool launcher_of_process(launcher *found);

/* The MPI library for a context's options, which is the library of the process's launcher. */
hl_mpi launcher_mpi(void);

/* Joins the processes that mpirun has started. option: for error lines. Returns the exit code;
 * call hl_ranks_leave() in any case. */
int ranks_begin(cli_host *host, const char *option, hl_ranks **ranks);

/* Compares the scenes and volumes of all ranks, which must be equal, because each rank makes a part of the
 * picture and waits for the data of the others. The call is collective. Returns the exit code. ranks: may be
 * null. */
int ranks_compare(cli_host *host, hl_ranks *ranks, const hl_scene *scene);

/* If the exit code stands for a failure, ends the other ranks, too, so that no rank waits for this one. Call
 * it before anything that the other ranks use is released. ranks: may be null. */
void ranks_check(hl_ranks *ranks, int exit_code);

/* Ends the other processes of the launcher if this process has failed. If ranks_begin() has not joined the
 * processes yet, joins them first, because only joined processes can be ended. Without this, they would wait
 * for this process: MPICH's launcher does not end a job if a process exits before it has joined. */
void ranks_end_others(int exit_code);

#endif
