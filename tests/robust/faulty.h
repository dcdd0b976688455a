/* tests/robust/faulty.h - a context whose n-th allocation fails, or whose caller says stop at the n-th
 * question. */
#ifndef HL_TESTS_FAULTY_H
#define HL_TESTS_FAULTY_H

#include <stdatomic.h>
#include <stdbool.h>

#include <halflight/halflight.h>

typedef struct faulty {
  hl_context *context;
  atomic_long allocations_left; /* before one fails; negative: none does */
  atomic_bool for_good;         /* all later ones fail too */
  atomic_long questions_left; /* before one is answered with "stop", which it is only once; negative: never */
  atomic_bool fills;          /* new memory is filled with bytes that are no right index or float */
  atomic_bool struck;         /* something failed, or was stopped */
  bool may_recover;    /* work may do without one failing allocation; it then checks its result itself */
  bool may_do_without; /* the same where all later ones fail, too */
} faulty;

/* True where the system's allocator is to fail: faulty_system.c asks. Its failures count like the context's,
 * but work may do without (a thread less, no buffer for a file), and the error may have another name. */
bool faulty_system_strikes(void);

bool faulty_system_at_work(void); /* between the start and the end of the work that is to meet failures */

void faulty_open(faulty *f);
void faulty_close(faulty *f); /* asserts that nothing is held */

/* Does some work and gives back everything that it made. */
typedef hl_status faulty_work(faulty *f, void *data, hl_error *error);

/* Runs the work with each of its allocations failing in turn, once alone and once with all that follow, until
 * the work is done: each time it must end with HL_ERROR_MEMORY and a line, and hold no more than before.
 * Returns how many there are, about. after: called after each failure, with memory; may be null. */
long faulty_fail_each(faulty *f, faulty_work *work, faulty_work *after, void *data);

/* The same with the questions whether to stop. New memory is filled, so that work that reads what the stop
 * has left unwritten fails. */
long faulty_stop_each(faulty *f, faulty_work *work, faulty_work *after, void *data);

#endif
