/* core/door.h - sets the floating-point environment of public functions: they compute in C's default
 * environment, and restore the host's environment when they return. The entry to such a function is called a
 * door.
 *
 * A host may round upwards, flush small numbers to zero for speed, or let a division by zero send a signal.
 * None of this may change a picture or end a call. A public function that computes begins with HL_DOOR, and
 * so does a thread of the library. The default environment holds until the function returns; then the host's
 * environment is restored, flags included. The compiler might move computations with arguments that are
 * numbers across the door. It does not move loads and stores through pointers, because it does not know which
 * memory the door's functions access. tests/checks/doors.py looks for missing doors. */
#ifndef HL_CORE_DOOR_H
#define HL_CORE_DOOR_H

#include <fenv.h>
#include <stdbool.h>

typedef struct hl_door {
  fenv_t host;         /* the host's floating-point environment; it is saved completely only if `changed` is
                        * set */
  unsigned int vector; /* on x86: the host's value of MXCSR, the control and status register for vectors */
  bool changed;
} hl_door;

hl_door hl_door_enter(void);
void hl_door_leave(hl_door *door);

/* The first statement of a public function that computes: it enters the default floating-point
 * environment. */
#define HL_DOOR hl_door hl_own_door __attribute__((cleanup(hl_door_leave), unused)) = hl_door_enter()

#endif
