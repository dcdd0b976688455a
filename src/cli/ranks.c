/* cli/ranks.c - see ranks.h.
 *
 * Open MPI's handles are the addresses of objects in its library, and its functions have the types that the
 * MPI standard says (MPI 3.1, chapters 5 and 8; the header of Open MPI 4.1). */
#define _GNU_SOURCE
#include "ranks.h"

#include <dlfcn.h>
#include <stdlib.h>
#include <string.h>

#include "message.h"

/* The library that Debian's libopenmpi3 has; versions 4 and 5 of Open MPI share its interface. */
static const char library_name[] = "libmpi.so.40";

enum { THREAD_FUNNELED = 1, SUCCESS = 0 }; /* MPI_THREAD_FUNNELED, MPI_SUCCESS */

/* Values of a call: their count is an int. */
enum { MOST_VALUES = 1 << 28 };

struct ranks_functions {
  void *library, *world, *real, *sum; /* MPI_COMM_WORLD, MPI_FLOAT, MPI_SUM */
  int (*init)(int *count, char ***arguments, int wanted, int *given);
  int (*rank)(void *communicator, int *rank);
  int (*size)(void *communicator, int *size);
  int (*reduce)(const void *from, void *to, int count, void *type, void *operation, int root,
                void *communicator);
  int (*finalize)(void);
  int (*abort)(void *communicator, int code);
};

/* Copies the address of a symbol to a pointer to an object or to a function. */
static bool find(void *library, const char *name, void *pointer) {
  void *address = dlsym(library, name);
  memcpy(pointer, &address, sizeof address);
  return address != NULL;
}

static bool find_all(ranks_functions *f) {
  return find(f->library, "ompi_mpi_comm_world", &f->world) && find(f->library, "ompi_mpi_float", &f->real) &&
         find(f->library, "ompi_mpi_op_sum", &f->sum) && find(f->library, "MPI_Init_thread", &f->init) &&
         find(f->library, "MPI_Comm_rank", &f->rank) && find(f->library, "MPI_Comm_size", &f->size) &&
         find(f->library, "MPI_Reduce", &f->reduce) && find(f->library, "MPI_Finalize", &f->finalize) &&
         find(f->library, "MPI_Abort", &f->abort);
}

int ranks_begin(ranks *all) {
  int given;
  if (getenv("OMPI_COMM_WORLD_SIZE") == NULL)
    return fail(EXIT_CODE_USAGE,
                "--strips-over-ranks: Open MPI's mpirun has not started this process: start it so");
  ranks_functions *f = calloc(1, sizeof *f);
  if (f == NULL) return fail(EXIT_CODE_FAILURE, "out of memory");
  f->library = dlopen(library_name, RTLD_NOW | RTLD_GLOBAL); /* its own modules look for its symbols */
  if (f->library == NULL || !find_all(f) || f->init(NULL, NULL, THREAD_FUNNELED, &given) != SUCCESS) {
    const char *reason = f->library == NULL ? dlerror() : "it is not Open MPI's, or does not start";
    int exit_code = fail(EXIT_CODE_FAILURE, "--strips-over-ranks: %s: %s", library_name, reason);
    if (f->library != NULL) dlclose(f->library);
    free(f);
    return exit_code;
  }
  all->functions = f;
  if (f->rank(f->world, &all->rank) == SUCCESS && f->size(f->world, &all->size) == SUCCESS)
    return EXIT_CODE_OK;
  return fail(EXIT_CODE_FAILURE, "--strips-over-ranks: Open MPI does not tell this process's rank");
}

int ranks_sum(ranks *all, float *values, size_t count) {
  ranks_functions *f = all->functions;
  void *const in_place = (void *)1; /* MPI_IN_PLACE */
  for (size_t done = 0; f != NULL && done < count; done += MOST_VALUES) {
    size_t left = count - done;
    int some = left < MOST_VALUES ? (int)left : MOST_VALUES;
    const void *from = all->rank == 0 ? in_place : values + done;
    if (f->reduce(from, all->rank == 0 ? values + done : NULL, some, f->real, f->sum, 0, f->world) != SUCCESS)
      return fail(EXIT_CODE_FAILURE,
                  "--strips-over-ranks: the processes cannot send each other their strips");
  }
  return EXIT_CODE_OK;
}

void ranks_end(ranks *all, int exit_code) {
  ranks_functions *f = all->functions;
  if (f == NULL) return;
  if (exit_code != EXIT_CODE_OK) f->abort(f->world, exit_code);
  f->finalize();
  free(f); /* the library stays: it may have threads of its own */
  *all = (ranks){0};
}
