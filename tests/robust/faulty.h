/* tests/robust/faulty.h - a context whose n-th allocation fails, or whose caller answers "stop" to the n-th
 * question. */
#ifndef HL_TESTS_FAULTY_H
#define HL_TESTS_FAULTY_H

#include <stdatomic.h>
#include <stdbool.h>

#include <halflight/halflight.h>

typedef struct faulty {
  hl_context *context;
  /* the number of allocations before the one that fails; negative: none fails */
  atomic_long allocations_left;
  atomic_bool for_good; /* whether all later allocations fail, too */
  /* the number of questions before the one that is answered with "stop", once; negative: none is */
  atomic_long questions_left;
  atomic_bool fills;  /* whether new memory is filled with bytes that are no valid index or float */
  atomic_bool struck; /* whether an allocation has failed or the work was stopped */
  /* whether the work may do without one failing allocation; it then checks its result itself */
  bool may_recover;
  bool may_do_without; /* the same if all later allocations fail, too */
} faulty;

/* Whether the system's allocator is to fail, for faulty_system.c. Its failures count as the context's do. But
 * the work may do without the memory (one thread less, no buffer for a file), and the error may have another
 * name. */
bool faulty_system_strikes(void);

/* whether work that is to meet failures has begun and not ended */
bool faulty_system_at_work(void);

void faulty_open(faulty *f);
void faulty_close(faulty *f); /* Closes the context. Fails if memory is held. */

/* Does some work and gives back everything that it made. */
typedef hl_status faulty_work(faulty *f, void *data, hl_error *error);

/* Runs the work with each of its allocations failing in turn, alone and with all later ones, until the work
 * is done without a failure. Each time it must end with HL_ERROR_MEMORY and a message of one line, and hold
 * no more memory than before. Returns the approximate number of allocations. after: called after each
 * failure, when there is memory again; may be null. */
long faulty_fail_each(faulty *f, faulty_work *work, faulty_work *after, void *data);

/* The same with the questions whether to stop. New memory is filled, so that work fails if it reads memory
 * that was not written because of the stop. */
long faulty_stop_each(faulty *f, faulty_work *work, faulty_work *after, void *data);

#endif
