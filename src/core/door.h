/* core/door.h - a door of the library: within, floating-point arithmetic is that of C's default environment;
 * outside it is the host's.
 *
 * Hosts round upwards, flush small numbers to zero for speed, or have a signal sent where a number is divided
 * by zero. None of this may change a picture or end a call. A public function that computes begins with
 * HL_DOOR, and so does a thread of the library: the environment is the default one until it returns, and then
 * the host's again, flags included. What the compiler might move across the door are computations with
 * arguments that are numbers; whatever a pointer leads to is loaded and stored within, as the compiler does
 * not know what the door's functions touch. tests/checks/doors.py looks for doors. */
#ifndef HL_CORE_DOOR_H
#define HL_CORE_DOOR_H

#include <fenv.h>
#include <stdbool.h>

typedef struct hl_door {
  fenv_t host;         /* saved completely where `changed` is set */
  unsigned int vector; /* x86: the host's control and status register for vectors */
  bool changed;
} hl_door;

hl_door hl_door_enter(void);
void hl_door_leave(hl_door *door);

/* Stands as the first statement of a function. */
#define HL_DOOR hl_door hl_own_door __attribute__((cleanup(hl_door_leave), unused)) = hl_door_enter()

#endif
