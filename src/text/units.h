/* text/units.h - units of length. */
#ifndef HL_TEXT_UNITS_H
#define HL_TEXT_UNITS_H

#include <stddef.h>

typedef struct hl_unit {
  const char *symbol;   /* the unit's symbol in figures */
  const char *names[3]; /* the unit's names in files and in options; null after the last name */
  double metres;
  int chosen; /* whether hl_unit_for() may choose this unit */
} hl_unit;

/* The unit of length that has a given name; null if no known unit has this name. */
const hl_unit *hl_unit_find(const char *name);

/* metres / other_metres, where both are above 0. A whole number, or 1 over a whole number, is exact. */
double hl_length_ratio(double metres, double other_metres);

/* The factor by which lengths in one unit are multiplied to be lengths in another. It is 1 if the name of one
 * of the units is null or not known. */
double hl_unit_ratio(const char *from, const char *to);

/* Chooses the unit for a length: the unit in which the length is a number from 1 to 1000. If there is no such
 * unit, the result is the unit in which the number comes closest to that range. */
const hl_unit *hl_unit_for(double metres);

/* The greatest number of the form 1, 2 or 5 times a power of ten that is at most `most`. */
double hl_round_length(double most);

#endif
