/* cli/ranks.h - processes of an MPI launcher that make one picture together (halflight/ranks.h). */
#ifndef HL_CLI_RANKS_H
#define HL_CLI_RANKS_H

#include "host.h"

/* The number of this process and the number of all processes, as their launcher (mpirun, srun) tells them in
 * variables of the environment. */
typedef struct launcher {
  const char *rank_name, *size_name; /* names of the variables */
  const char *rank, *size;           /* the values of these variables as text, not checked yet */
  hl_mpi mpi;                        /* the MPI library that the launcher belongs to */
} launcher;

/* Finds the launcher that started this process. False: no launcher did. */
bool launcher_of_process(launcher *found);

/* The MPI library for a context's options: that of the process's launcher. */
hl_mpi launcher_mpi(void);

/* Joins the processes that mpirun has started. option: for error lines. Returns the exit code;
 * call hl_ranks_leave() in any case. */
int ranks_begin(cli_host *host, const char *option, hl_ranks **ranks);

/* Collective: compares the scenes and volumes of all ranks, which must be equal, since each rank makes a part
 * of the picture and waits for what the others send. Returns the exit code. ranks: may be null. */
int ranks_compare(cli_host *host, hl_ranks *ranks, const hl_scene *scene);

/* If the exit code stands for a failure, ends the other ranks, too, so that no rank waits for this one. Call
 * it before anything that the other ranks use is released. ranks: may be null. */
void ranks_check(hl_ranks *ranks, int exit_code);

/* For a process that has failed: if ranks_begin() has not joined the processes of its launcher, joins them
 * now, so that it can end them. Otherwise they would wait for this process: MPICH's launcher does not end a
 * job one of whose processes exits before it has joined. */
void ranks_end_others(int exit_code);

#endif
