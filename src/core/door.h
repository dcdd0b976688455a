/* core/door.h - sets the floating-point environment of public functions: such functions compute in C's
 * default environment, and restore the host's environment when they return. A door is the entry to a public
 * function that sets C's default floating-point environment.
 *
 * A host may round upwards, flush small numbers to zero for speed, or let a division by zero send a signal.
 * The host's floating-point settings must not change a picture or end a call. Each public function that
 * computes, and each thread of the library, begins with HL_DOOR. The default environment holds until the
 * function returns; then the host's environment is restored, including the exception flags. The compiler
 * might move computations that use only arguments passed as numbers across the door. The compiler does not
 * move loads and stores through pointers across the door, because it does not know which memory the door's
 * functions access. tests/checks/doors.py looks for missing doors. */
#ifndef HL_CORE_DOOR_H
#define HL_CORE_DOOR_H

#include <fenv.h>
#include <stdbool.h>

typedef struct hl_door {
  fenv_t host;         /* the host's floating-point environment; the whole environment is saved only if
                        * `changed` is set */
  unsigned int vector; /* on x86: the host's value of MXCSR, the control and status register for vectors */
  bool changed;
} hl_door;

hl_door hl_door_enter(void);
void hl_door_leave(hl_door *door);

/* The first statement of a public function that computes: it enters the default floating-point
 * environment. */
#define HL_DOOR hl_door hl_own_door __attribute__((cleanup(hl_door_leave), unused)) = hl_door_enter()

#endif
