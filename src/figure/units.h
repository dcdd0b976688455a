/* figure/units.h - units of length. */
#ifndef HL_FIGURE_UNITS_H
#define HL_FIGURE_UNITS_H

#include <stddef.h>

typedef struct hl_unit {
  const char *symbol;   /* as a figure writes it */
  const char *names[3]; /* as people and files write it; null after the last */
  double metres;
  int chosen; /* non-zero: lengths without a stated unit may be given in it */
} hl_unit;

/* The unit with this name; null: it is no unit that is known. */
const hl_unit *hl_unit_find(const char *name);

/* The unit in which a length is a number from 1 to 1000, where there is one. */
const hl_unit *hl_unit_for(double metres);

/* The greatest of 1, 2 and 5 times powers of ten that is at most `most`. */
double hl_round_length(double most);

#endif
