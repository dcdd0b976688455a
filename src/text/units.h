/* text/units.h - units of length. */
#ifndef HL_TEXT_UNITS_H
#define HL_TEXT_UNITS_H

#include <stddef.h>

typedef struct hl_unit {
  const char *symbol;   /* as figures write the unit */
  const char *names[3]; /* as people and files write the unit; null after the last */
  double metres;
  int chosen; /* non-zero: hl_unit_for() may return this unit */
} hl_unit;

/* The unit with this name; null: no known unit has it. */
const hl_unit *hl_unit_find(const char *name);

/* The unit for a length: the one in which its number is from 1 to 1000. If there is no such unit, it is the
 * one whose number comes closest to that range. */
const hl_unit *hl_unit_for(double metres);

/* The greatest number of the form 1, 2 or 5 times a power of ten that is at most `most`. */
double hl_round_length(double most);

#endif
